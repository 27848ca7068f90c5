"""Few iterations from far away: progressive references, then Newton steps with ever more of the exact Hessian."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from workbench.api import (
    Evaluation,
    Floats,
    Interrupt,
    Problem,
    Progress,
    ProgressiveSolver,
    SingularMatrixError,
    State,
    Status,
    descend,
    direction_in_metric,
    parameter,
)

LADDER = (1.0, 0.6, 0.3, 0.1, 0.02)
"""Share of the projected Hessian in the matrix of a step; the rest is the exact one. Down by a rung a step.

Never 0: a map without anchors may turn freely, and the exact Hessian is definite there at a minimum only, if at all.
"""
REST = 3
"""Steps on the rung above after a matrix that was not positive definite."""
SMALLEST_SHIFT = (1e-10,)


@dataclass(frozen=True)
class Fast(ProgressiveSolver):
    """Newton's method from far to near. Far away, steps on progressive references (Liu et al. 2018) undo the worst distortion.

    Near the optimum, projecting every simplex is what slows Newton's method down: the sum of the exact Hessians is often
    positive definite although those of single simplices are not. So the projected Hessian gives way to the exact one by
    shares, as long as the factorisation succeeds (after Longva et al. 2023, who decide between the two at once); where it
    fails, some of the projected one is put back, for a few steps.
    """

    id = "fast"
    label = "Fast Newton"
    short = "FN"
    citation = "Liu, Ye, Ni, Fu 2018 [LYNF18]; Longva, Löschner, Fernández-Fernández, Larionov, Ascher, Bender 2023 [LLF*23]"

    initializer = "auto"

    close: float = parameter(0.3, "relative decrease of a step below which the source is used", minimum=0.0, maximum=1.0)
    uniform: bool = parameter(False, "every triangle of a reference weighs the same, instead of its area")

    def near(
        self, problem: Problem, state: State, evaluation: Evaluation, progress: Progress, interrupt: Interrupt
    ) -> tuple[State, Progress]:
        projected = problem.evaluate(state.positions, 2).hessian_values
        assert projected is not None
        rung, rest = progress.rung, max(progress.rest - 1, 0)
        if not progress.rest:
            rung = min(rung + 1, len(LADDER) - 1) if progress.is_close else 0
        exact = problem.evaluate(state.positions, 2, project=False).hessian_values if rung else None
        while exact is not None and rung:
            values = LADDER[rung] * projected + (1.0 - LADDER[rung]) * exact
            following = self._mixed(problem, state, evaluation, values, interrupt)
            if following is not None:
                return following, replace(progress, rung=rung, rest=rest)
            if interrupt():
                return replace(state, status=Status.INTERRUPTED), progress
            rung, rest = rung - 1, REST
        direction = direction_in_metric(problem, projected, evaluation.gradient)
        following = descend(problem, state, evaluation, direction, interrupt, furthest=self.reach, safety=self.safety)
        return following, replace(progress, rung=0, rest=rest)

    def _mixed(
        self, problem: Problem, state: State, evaluation: Evaluation, values: Floats, interrupt: Interrupt
    ) -> State | None:
        """A step with a matrix that may not be positive definite; None where it is not, or where no step goes down."""
        try:
            direction = direction_in_metric(problem, values, evaluation.gradient, SMALLEST_SHIFT)
        except SingularMatrixError:
            return None
        # A back end that also factorises indefinite matrices says nothing: the slope does.
        if not float(np.einsum("ij,ij->", evaluation.gradient, direction)) < 0.0:
            return None
        following = descend(problem, state, evaluation, direction, interrupt, furthest=self.reach, safety=self.safety)
        return None if following.status is Status.NO_DESCENT else following
