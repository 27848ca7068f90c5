"""Momentum: the map before is remembered, and a step may begin, or end, beyond the current map on the line through both."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.descent import Derivatives
from workbench.core.line_search import largest_step
from workbench.core.state import State
from workbench.core.status import Status

if TYPE_CHECKING:
    from workbench.core.problem import Problem


@dataclass(frozen=True, eq=False)
class Extrapolated(Derivatives):
    """The derivatives at the newest map, and the map before it.

    `steps` : steps since momentum was last dropped
    """

    previous: Floats
    steps: int = 0


def with_previous_map(following: State, state: State) -> State:
    """`following`, the outcome of a step from `state`, remembering the map of `state`; its energy is what went before."""
    if following.status is not Status.RUNNING or not isinstance(following.memory, Derivatives):
        return following
    memory = following.memory
    steps = state.memory.steps + 1 if isinstance(state.memory, Extrapolated) else 1
    return replace(
        following,
        previous_energy=state.energy,
        memory=Extrapolated(memory.problem, memory.evaluation, state.positions, steps),
    )


def moved_state(problem: Problem, state: State, positions: Floats) -> State | None:
    """`state` at another map (n, d), with energy and gradient there; None where that map is not allowed or not finite."""
    evaluation = problem.evaluate(positions, 1)
    allowed = evaluation.inverted <= problem.most_inverted(state.inverted)
    if not (allowed and math.isfinite(evaluation.energy) and np.isfinite(evaluation.gradient).all()):
        return None
    return replace(
        state,
        positions=positions,
        energy=evaluation.energy,
        gradient_norm=problem.free_gradient_norm(evaluation.gradient),
        inverted=evaluation.inverted,
        anchor_error=problem.anchor_error(positions),
        memory=Derivatives(problem, evaluation),
    )


def extrapolate(problem: Problem, state: State, length: float, limit: float) -> State | None:
    """The state at x + t (x - previous), t = `length` or `limit` times the largest step without inversion.

    None where there is no map before, or none to go to.
    """
    if not isinstance(state.memory, Extrapolated):
        return None
    velocity = state.positions - state.memory.previous
    if problem.forbids_inversions:
        length = min(length, limit * largest_step(state.positions, velocity, problem.elements.simplices)[0])
    return moved_state(problem, state, state.positions + length * velocity) if length > 0.0 else None
