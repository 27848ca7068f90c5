"""Newton's method with the Hessian of every simplex projected to be positive semi-definite."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from workbench.api import (
    SAFETY,
    Interrupt,
    Problem,
    SingularMatrixError,
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
class ProjectedNewton(Solver):
    """Projected Newton (Teran et al. 2005; Liu et al. 2016), with Armijo's rule below the largest step without inversion.

    Where the full step is accepted, a longer one is tried: the projected Hessian is too stiff, and a trial is cheap beside
    a factorisation.
    """

    id = "projected-newton"
    label = "Projected Newton"
    short = "PN"
    citation = "Teran et al. 2005 [TSIF05]; Liu, Bouaziz, Kavan 2016 [LBK16]; section 4.3"

    safety: float = parameter(SAFETY, "part of the largest step without inversion that is taken", minimum=0.1, maximum=0.99)
    reach: float = parameter(
        4.0, "longest step tried, in Newton steps; 1: never a longer one", minimum=1.0, maximum=10.0
    )

    def step(self, problem: Problem, state: State, interrupt: Interrupt = never) -> State:
        if problem.anchors_lag(state.positions):
            return approach_anchors(problem, state, interrupt)
        system, constraints = problem.system, problem.constraints
        evaluation = derivatives_at(problem, state, 2)
        if not is_finite(evaluation):
            return replace(state, status=Status.NONFINITE)
        if interrupt():
            return replace(state, status=Status.INTERRUPTED)
        residual = constraints.residual(state.positions) if constraints is not None else None
        try:
            system.factorise(evaluation.hessian_values, problem.anchors.hard_vertices)
            direction = system.solve(evaluation.gradient, None, constraints, residual)
        except SingularMatrixError:
            return replace(state, status=Status.SINGULAR)
        if not np.isfinite(direction).all():
            return replace(state, status=Status.SINGULAR)
        return descend(problem, state, evaluation, direction, interrupt, furthest=self.reach, safety=self.safety)
