"""Newton's method with the absolute eigenvalues of every simplex's Hessian."""

from __future__ import annotations

from dataclasses import dataclass

from workbench.api import Evaluation, Floats, NewtonSolver, Problem, State


@dataclass(frozen=True)
class NewtonAbsolute(NewtonSolver):
    """Newton's method where negative eigenvalues of a simplex's Hessian change their sign, instead of being set to zero.

    Directions of negative curvature keep a stiffness of their own size: steps are shorter and need fewer trials where the
    Hessian is far from convex, as for distortions that keep volumes. Taken from Chen et al. 2024: the filter; theirs works on
    the eigenvalues of the 12 coordinates of a tetrahedron, ours on those of its Jacobian, which are known in closed form.
    """

    id = "newton-absolute"
    label = "Newton with absolute eigenvalues"
    short = "AbsN"
    citation = "Chen, Liu, Levin, Zheng, Jacobson 2024 [CLL*24]: absolute eigenvalue filtering"

    def convex_hessian(self, problem: Problem, state: State, evaluation: Evaluation) -> Floats:
        clamped = problem.evaluate(state.positions, 2).hessian_values
        exact = problem.evaluate(state.positions, 2, project=False).hessian_values
        assert clamped is not None and exact is not None
        # |a| = 2 max(a, 0) - a holds for every eigenvalue, so it holds for the sums over the simplices.
        return 2.0 * clamped - exact
