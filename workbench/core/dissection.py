"""One step of any solver taken apart: its direction, the bound on it, the trials of its line search, the energy along it."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields, replace

import numpy as np

from workbench.core.arrays import Booleans, Floats, frozen
from workbench.core.energy import Evaluation
from workbench.core.guarded_step import guarded_step
from workbench.core.line_search import largest_step
from workbench.core.problem import Problem, Workspace
from workbench.core.solver import Interrupt, Solver, never
from workbench.core.state import State
from workbench.core.status import Status

SAMPLES = 96
"""Points of the curve E(x + t d)."""
BEYOND = 1.6
"""How far the curve goes, in the longest of the trials, where the bound allows."""
OFF_THE_LINE = 1e-6
"""Distance from x + t d, as a part of the step, from which on a trial counts as being elsewhere."""


@dataclass(frozen=True, eq=False)
class WatchedProblem(Problem):
    """A problem that notes every map that it, or a variant of it, is asked the energy of, in order; none twice in a row."""

    tried: list[Floats] = field(default_factory=list)

    def energy_and_inverted(self, positions: Floats) -> tuple[float, int]:
        """See `Problem.energy_and_inverted`."""
        self._note(positions)
        return super().energy_and_inverted(positions)

    def evaluate(self, positions: Floats, order: int = 1, *, project: bool = True) -> Evaluation:
        """See `Problem.evaluate`."""
        self._note(positions)
        return super().evaluate(positions, order, project=project)

    def _note(self, positions: Floats) -> None:
        if not self.tried or not np.array_equal(self.tried[-1], positions):
            self.tried.append(frozen(positions))


@dataclass(frozen=True, eq=False)
class Dissection:
    """A step from `before` to `after`, as a walk x + t d.

    Parameters
    ----------
    direction : (n, d) float64       of the walk: zero where nothing was tried
    step_size : float                t of the map after; 0 where no step was taken
    slope : float                    of the energy at t = 0
    bound : float                    largest t without inversion, inf where nothing can invert
    limiting_simplex : int           sets the bound, -1 where none does
    trial_sizes, trial_energies : (k,) float64      in the order they were asked; an energy may be inf. It is that of the
                                     problem, also where a solver went by that of a milder one
    trial_on_line : (k,) bool        whether the trial lies on x + t d at all: some solvers search from another point
    curve_sizes, curve_energies : (s,) float64      E(x + t d) at even steps; inf or NaN where it is none
    """

    before: State
    after: State
    direction: Floats
    step_size: float
    slope: float
    bound: float
    limiting_simplex: int
    trial_sizes: Floats
    trial_energies: Floats
    trial_on_line: Booleans
    curve_sizes: Floats
    curve_energies: Floats


def dissect(solver: Solver, problem: Problem, state: State, interrupt: Interrupt = never) -> Dissection:
    """Take the next step of `solver` from `state`, and look at it; neither is changed, nor the problem's factors and counts.

    The direction is that from the map before to the map after, over the step size that the solver tells; where it took no
    step, that to its first trial. Raises `SolverFaultError` where the solver itself is at fault.
    """
    own = Workspace(problem.density)
    values = {item.name: getattr(problem, item.name) for item in fields(Problem)}
    watched = WatchedProblem(**{**values, "workspace": own})
    after = guarded_step(solver, watched, replace(state, status=Status.RUNNING), interrupt)
    x = state.positions
    trials = [positions for positions in watched.tried if not np.array_equal(positions, x)]
    direction, size = _walk(x, after, trials)
    bound, simplex = largest_step(x, direction, problem.elements.simplices)
    bound, simplex = float(bound), int(simplex)
    plain = replace(problem, workspace=own)
    sizes, on_line = _places(x, direction, trials)
    gradient = plain.gradient(x)
    ends = sizes[on_line & (sizes > 0)] if len(sizes) else sizes
    curve = np.linspace(0.0, _reach(bound, max(size, float(ends.max(initial=0.0)))), SAMPLES)
    return Dissection(
        before=state,
        after=after,
        direction=frozen(direction),
        step_size=size,
        slope=float(np.einsum("ij,ij->", gradient, direction)),
        bound=bound,
        limiting_simplex=simplex,
        trial_sizes=sizes,
        trial_energies=np.array([plain.energy(positions) for positions in trials]),
        trial_on_line=on_line,
        curve_sizes=curve,
        curve_energies=np.array([plain.energy(x + t * direction) for t in curve]),
    )


def _walk(x: Floats, after: State, trials: list[Floats]) -> tuple[Floats, float]:
    """Direction and size of the step; a solver that tells no size has gone one whole direction."""
    moved = after.positions - x
    if moved.any():
        size = after.step_size if after.step_size > 0 else 1.0
        return moved / size, size
    return trials[0] - x if trials else np.zeros_like(x), 0.0


def _places(x: Floats, direction: Floats, trials: list[Floats]) -> tuple[Floats, Booleans]:
    """Of each trial the t of the nearest point of the walk, and whether it lies there."""
    square = float(np.einsum("ij,ij->", direction, direction))
    sizes, on_line = np.zeros(len(trials)), np.zeros(len(trials), dtype=bool)
    for row, trial in enumerate(trials):
        offset = trial - x
        sizes[row] = float(np.einsum("ij,ij->", offset, direction)) / square if square > 0 else 0.0
        off = float(np.linalg.norm(offset - sizes[row] * direction))
        on_line[row] = off <= OFF_THE_LINE * max(float(np.linalg.norm(offset)), 1e-300)
    return sizes, on_line


def _reach(bound: float, longest: float) -> float:
    """End of the curve: beyond the longest trial, and to the bound where that is not far."""
    longest = longest if longest > 0 else 1.0
    if not math.isfinite(bound):
        return BEYOND * longest
    return min(1.02 * bound, BEYOND * longest) if bound > BEYOND * longest else 1.02 * bound
