"""Steepest descent."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from workbench.api import (
    Interrupt,
    Problem,
    Solver,
    State,
    Status,
    approach_anchors,
    derivatives_at,
    descend,
    is_finite,
    never,
    parameter,
)


@dataclass(frozen=True)
class GradientDescent(Solver):
    """Gradient descent with Armijo's rule below the largest step without inversion.

    Each step first tries `growth` times the accepted length of the one before.
    """

    id = "gradient-descent"
    label = "Gradient descent"
    short = "GD"
    citation = "Nocedal & Wright 2006 [NW06], section 3.1; section 4.3"

    growth: float = parameter(2.0, "factor on the last accepted step for the next first trial", minimum=1.0, maximum=100.0)

    def prepare(self, problem: Problem) -> None:
        """Nothing is made once."""

    def step(self, problem: Problem, state: State, interrupt: Interrupt = never) -> State:
        if problem.anchors_lag(state.positions):
            return approach_anchors(problem, state, interrupt)
        hard = problem.anchors.hard_vertices
        evaluation = derivatives_at(problem, state, 1)
        if not is_finite(evaluation):
            return replace(state, status=Status.NONFINITE)
        if interrupt():
            return replace(state, status=Status.INTERRUPTED)
        direction = -evaluation.gradient
        direction[hard] = 0.0
        if problem.constraints is not None:
            direction = problem.constraints.tangential(direction, hard)
        last = state.step_size if state.memory is not None else 0.0
        first = self.growth * last if last > 0.0 else self._first_trial(problem, direction)
        return descend(problem, state, evaluation, direction, interrupt, first=first, furthest=0.0)

    def _first_trial(self, problem: Problem, direction: np.ndarray) -> float:
        """A step that moves no vertex further than a tenth of the source's diameter."""
        longest = float(np.linalg.norm(direction, axis=1).max(initial=0.0))
        return 0.1 * problem.mesh.diameter / longest if longest > 0.0 else 1.0
