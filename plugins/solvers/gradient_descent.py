"""Steepest descent."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from workbench.api import (
    ROUNDING,
    SAFETY,
    Evaluation,
    Interrupt,
    Problem,
    Solver,
    State,
    Status,
    approach_anchors,
    armijo,
    largest_step,
    never,
    parameter,
)


@dataclass(frozen=True, eq=False)
class Memory:
    """The gradient at the newest map and the size of the step that led there."""

    problem: Problem
    evaluation: Evaluation
    size: float


@dataclass(frozen=True)
class GradientDescent(Solver):
    """Gradient descent with Armijo's rule below the largest step without inversion.

    Each step tries twice the accepted length of the one before.
    """

    id = "gradient-descent"
    label = "Gradient descent"
    short = "GD"
    citation = "Nocedal & Wright 2006, section 3.1; section 4.3"

    growth: float = parameter(2.0, "factor on the last accepted step for the next first trial", minimum=1.0, maximum=100.0)

    def step(self, problem: Problem, state: State, interrupt: Interrupt = never) -> State:
        if problem.anchors_lag(state.positions):
            return approach_anchors(problem, state, interrupt)
        x, hard = state.positions, problem.anchors.hard_vertices
        memory = state.memory if isinstance(state.memory, Memory) and state.memory.problem is problem else None
        evaluation = memory.evaluation if memory else problem.evaluate(x, 1)
        if not math.isfinite(evaluation.energy) or not np.isfinite(evaluation.gradient).all():
            return replace(state, status=Status.NONFINITE)
        direction = -evaluation.gradient
        direction[hard] = 0.0
        if problem.constraints is not None:
            direction = problem.constraints.tangential(direction, hard)
        slope = float(np.einsum("ij,ij->", evaluation.gradient, direction))
        with problem.workspace.timed("line_search"):
            first = self.growth * memory.size if memory and memory.size else self._first_trial(problem, direction)
            limiting = -1
            if problem.forbids_inversions:
                bound, simplex = largest_step(x, direction, problem.elements.simplices)
                if SAFETY * bound < first:
                    first, limiting = SAFETY * bound, simplex
            predicted = -slope * min(first, 1e300)
            if predicted <= ROUNDING * abs(evaluation.energy):
                first = 0.0
            found = armijo(problem.energy_and_inverted, x, direction, evaluation.energy, slope, first, interrupt)
        if found.interrupted:
            return replace(state, status=Status.INTERRUPTED)
        if found.size == 0.0 and first > 0.0:
            return replace(state, status=Status.NO_DESCENT)
        following = problem.evaluate(found.positions, 1)
        return replace(
            state,
            positions=found.positions,
            iteration=state.iteration + 1,
            energy=found.energy,
            previous_energy=evaluation.energy,
            gradient_norm=problem.free_gradient_norm(following.gradient),
            step_size=found.size,
            inverted=found.inverted,
            anchor_error=problem.anchor_error(found.positions),
            limiting_simplex=limiting,
            memory=Memory(problem, following, found.size),
        )

    def _first_trial(self, problem: Problem, direction: np.ndarray) -> float:
        """A step that moves no vertex further than a tenth of the source's diameter."""
        longest = float(np.linalg.norm(direction, axis=1).max(initial=0.0))
        return 0.1 * problem.mesh.diameter / longest if longest > 0.0 else 1.0
