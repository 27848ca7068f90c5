"""What steps of descent methods have in common: the step bound, the line search, the state that follows."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.energy import Evaluation
from workbench.core.expression import SWITCH
from workbench.core.line_search import SAFETY, armijo, largest_step
from workbench.core.solver import ROUNDING, ZERO, Interrupt
from workbench.core.state import State
from workbench.core.status import Status

if TYPE_CHECKING:
    from workbench.core.problem import Problem


@dataclass(frozen=True, eq=False)
class Derivatives:
    """The derivatives at the newest map: a step ends with them, so that the next one need not assemble them again."""

    problem: Problem
    evaluation: Evaluation


def derivatives_at(problem: Problem, state: State, order: int) -> Evaluation:
    """Energy and derivatives at the current map; those of `descend` where they are for this very problem."""
    memory = state.memory
    if isinstance(memory, Derivatives) and memory.problem is problem:
        return memory.evaluation
    return problem.evaluate(state.positions, order)


def is_finite(evaluation: Evaluation) -> bool:
    """Whether energy and gradient are finite numbers."""
    return math.isfinite(evaluation.energy) and bool(np.isfinite(evaluation.gradient).all())


def descend(
    problem: Problem,
    state: State,
    evaluation: Evaluation,
    direction: Floats,
    interrupt: Interrupt,
    *,
    first: float = 1.0,
    furthest: float = 1.0,
    safety: float = SAFETY,
    sufficient: float = 1e-4,
) -> State:
    """The state after a line search along a descent direction.

    Parameters
    ----------
    evaluation : Evaluation      energy and gradient (and Hessian) at the current map; the next ones have the same order
    direction : (N, d) float64   zero at the hard anchors
    first, furthest : float      first trial, and how far a longer one may go; both below `safety` times the largest step
    sufficient : float           part of the promised decrease that a trial must reach

    Returns a state with NO_DESCENT where no trial lowers the energy, INTERRUPTED with the old positions where asked to stop.
    A direction whose promise is below rounding leaves the map as it is: the map is the minimum.
    """
    energy, x = evaluation.energy, state.positions
    slope = float(np.einsum("ij,ij->", evaluation.gradient, direction))
    if -slope * first <= ROUNDING * abs(energy):
        return replace(state, iteration=state.iteration + 1, energy=energy, previous_energy=energy, step_size=0.0)
    limiting = -1
    with problem.workspace.timed("line_search"):
        if problem.forbids_inversions:
            held = problem.held_simplices(state.inverted)
            bound, simplex = largest_step(x, direction, problem.elements.simplices[held])
            furthest = min(furthest, safety * bound)
            if safety * bound < first:
                first, limiting = safety * bound, int(np.arange(len(problem.elements.simplices))[held][simplex])
        search = problem.energy_and_inverted
        most = problem.most_inverted(state.inverted)
        found = armijo(
            search, x, direction, energy, slope, first, interrupt,
            sufficient=sufficient, furthest=furthest, most_inverted=most,
        )  # fmt: skip
    problem.workspace.counts["trials"] += found.trials
    if found.interrupted:
        return replace(state, status=Status.INTERRUPTED)
    if found.size == 0.0:
        is_zero = abs(energy) <= ZERO * problem.total_measure
        if is_zero or (problem.density.has_kinks and -slope * first <= SWITCH * abs(energy)):
            # what the derivatives promise is below what they round off at a kink: the map is a minimum to that precision
            return replace(state, iteration=state.iteration + 1, energy=energy, previous_energy=energy, step_size=0.0)
        return replace(state, status=Status.NO_DESCENT)
    following = problem.evaluate(found.positions, 1 if evaluation.hessian_values is None else 2)
    return replace(
        state,
        positions=found.positions,
        iteration=state.iteration + 1,
        energy=found.energy,
        previous_energy=energy,
        gradient_norm=problem.free_gradient_norm(following.gradient),
        step_size=found.size,
        inverted=found.inverted,
        anchor_error=problem.anchor_error(found.positions),
        limiting_simplex=limiting,
        memory=Derivatives(problem, following),
    )
