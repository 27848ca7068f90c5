"""Newton's method with the Hessian of every simplex projected to be positive semi-definite."""

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
    SingularMatrixError,
    Solver,
    State,
    Status,
    approach_anchors,
    armijo,
    largest_step,
    never,
    parameter,
)


@dataclass(frozen=True)
class ProjectedNewton(Solver):
    """Projected Newton (Teran et al. 2005; Liu et al. 2016), with Armijo's rule below the largest step without inversion."""

    id = "projected-newton"
    label = "Projected Newton"
    short = "PN"
    citation = "Teran et al. 2005 [TSIF05]; Liu, Bouaziz, Kavan 2016 [LBK16]; section 4.3"

    safety: float = parameter(SAFETY, "part of the largest step without inversion that is taken", minimum=0.1, maximum=0.99)

    def step(self, problem: Problem, state: State, interrupt: Interrupt = never) -> State:
        if problem.anchors_lag(state.positions):
            return approach_anchors(problem, state, interrupt)
        x, hard, system = state.positions, problem.anchors.hard_vertices, problem.system
        evaluation = _evaluation(problem, state)
        if not math.isfinite(evaluation.energy) or not np.isfinite(evaluation.gradient).all():
            return replace(state, status=Status.NONFINITE)
        if interrupt():
            return replace(state, status=Status.INTERRUPTED)
        residual = problem.constraints.residual(x) if problem.constraints is not None else None
        try:
            system.factorise(evaluation.hessian_values, hard)
            direction = system.solve(evaluation.gradient, None, problem.constraints, residual)
        except SingularMatrixError:
            return replace(state, status=Status.SINGULAR)
        if not np.isfinite(direction).all():
            return replace(state, status=Status.SINGULAR)
        slope = float(np.einsum("ij,ij->", evaluation.gradient, direction))
        if -slope <= ROUNDING * abs(evaluation.energy):
            # The decrease that Newton's model promises is below rounding: the map is the minimum.
            energy = evaluation.energy
            return replace(state, iteration=state.iteration + 1, energy=energy, previous_energy=energy, step_size=0.0)
        first, furthest, limiting = 1.0, 4.0, -1
        with problem.workspace.timed("line_search"):
            if problem.forbids_inversions:
                bound, simplex = largest_step(x, direction, problem.elements.simplices)
                furthest = min(furthest, self.safety * bound)
                if furthest < 1.0:
                    first, limiting = furthest, simplex
            energy = evaluation.energy
            search = problem.energy_and_inverted
            found = armijo(search, x, direction, energy, slope, first, interrupt, furthest=furthest)
        if found.interrupted:
            return replace(state, status=Status.INTERRUPTED)
        if found.size == 0.0:
            return replace(state, status=Status.NO_DESCENT)
        following = problem.evaluate(found.positions, 2)
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
            memory=Derivatives(problem, following),
        )


@dataclass(frozen=True, eq=False)
class Derivatives:
    """The Hessian at the newest map: a step ends with it, so that the next one need not assemble it again."""

    problem: Problem
    evaluation: Evaluation


def _evaluation(problem: Problem, state: State) -> Evaluation:
    memory = state.memory
    if isinstance(memory, Derivatives) and memory.problem is problem:
        return memory.evaluation
    return problem.evaluate(state.positions, 2)
