"""Newton's method with the Hessian of every simplex projected to be positive semi-definite."""

from __future__ import annotations

from dataclasses import dataclass

from workbench.api import Evaluation, Floats, NewtonSolver, Problem, State


@dataclass(frozen=True)
class ProjectedNewton(NewtonSolver):
    """Projected Newton (Teran et al. 2005; Liu et al. 2016): negative eigenvalues of a simplex's Hessian are set to zero.

    The eigenvalues are those on Jacobians, known in closed form, instead of those on the coordinates of the simplex.
    """

    id = "projected-newton"
    label = "Projected Newton"
    short = "PN"
    citation = "Teran et al. 2005 [TSIF05]; Liu, Bouaziz, Kavan 2016 [LBK16]; section 4.3"
    derivative_order = 2

    def convex_hessian(self, problem: Problem, state: State, evaluation: Evaluation) -> Floats:
        assert evaluation.hessian_values is not None
        return evaluation.hessian_values
