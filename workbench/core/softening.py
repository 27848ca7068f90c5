"""Norms of the Jacobian, which are not smooth where a simplex collapses: a descent on ever less softened ones.

The norms of (84) are convex, but like |x| at 0 they have a kink where singular values vanish, and their minima collapse
simplices: Newton's method stops far from them. So each sigma_i is softened to sqrt(sigma_i^2 + s^2), which keeps the energy
convex and makes it smooth; when the softened energy is at its minimum, s shrinks by `SHRINKAGE`, down to `LEAST` of the size
of the map. A step is kept only if the energy proper does not rise by it; else s shrinks at once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from workbench.core.jacobians import signed_singular_values
from workbench.core.problem import Problem
from workbench.core.solver import Interrupt, Solver
from workbench.core.state import State
from workbench.core.status import Status

FIRST = 0.1
"""Softening to begin with, as part of the mean largest singular value."""
SHRINKAGE = 0.1
LEAST = 1e-9
"""Softening at which a minimum counts as one of the energy proper, as part of the same."""


@dataclass(frozen=True, eq=False)
class Softened:
    """A solver's memory on a softened problem: what it goes on from in the next step; `problem` is the one proper."""

    problem: Problem
    softened: Problem
    state: State
    softening: float
    least: float


def softened_step(solver: Solver, problem: Problem, state: State, interrupt: Interrupt) -> State:
    """`solver.step` on the softened energy; CONVERGED where it is at its minimum with the least softening."""
    memory = state.memory
    if isinstance(memory, Softened) and memory.problem is problem:
        kept = memory
    else:
        size = float(np.abs(signed_singular_values(problem.elements, state.positions)[:, 0]).mean())
        kept = _soften(solver, problem, state, FIRST * size, LEAST * size)
    while True:
        following = solver.step(kept.softened, kept.state, interrupt)
        if following.status is Status.INTERRUPTED:
            return replace(state, status=Status.INTERRUPTED)
        energy = problem.energy_and_inverted(following.positions)[0]
        lags = problem.anchors_lag(state.positions)
        is_over = solver.terminate(kept.softened, following) is not Status.RUNNING
        is_kept = following.positions is not kept.state.positions and (lags or energy <= state.energy)
        if is_over and lags:
            return replace(following, energy=energy)
        if (is_over or not is_kept) and kept.softening > kept.least:
            start = following if is_kept else state
            kept = _soften(solver, problem, start, max(SHRINKAGE * kept.softening, kept.least), kept.least)
            if is_kept:
                return replace(following, energy=energy, status=Status.RUNNING, previous_energy=math.nan, memory=kept)
            continue
        if is_kept:
            previous = state.energy if is_over else math.nan
            status = Status.CONVERGED if is_over else following.status
            memory = replace(kept, state=following)
            return replace(following, energy=energy, previous_energy=previous, status=status, memory=memory)
        return replace(state, iteration=state.iteration + 1, step_size=0.0, status=Status.CONVERGED)


def _soften(solver: Solver, problem: Problem, state: State, softening: float, least: float) -> Softened:
    softened = problem.softened(softening)
    return Softened(problem, softened, replace(solver.rebase(softened, state), iteration=state.iteration), softening, least)
