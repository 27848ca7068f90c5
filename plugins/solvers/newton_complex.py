"""Newton's method with the Hessian of every triangle projected in the complex view."""

from __future__ import annotations

from dataclasses import dataclass

from workbench.api import Evaluation, Floats, NewtonSolver, Problem, State, complex_hessian


@dataclass(frozen=True)
class NewtonComplex(NewtonSolver):
    """Projected Newton in the plane by a closed form on f_z and f_zbar: no singular vectors, no eigenvectors.

    Chen & Weber 2017 found the eigenvalues of the Hessian in f_z and f_zbar, Golla et al. 2018 use them on triangle meshes.
    Theirs are the derivatives by |f_z|^2 and |f_zbar|^2 of a few distortions; ours come from those of any distortion by
    sigma_1 and sigma_2. Clamped at zero they give the matrix of Projected Newton on Jacobians to rounding, so that the two
    differ in cost alone; our step bound, line search and stop are those of all solvers here.
    """

    id = "newton-complex"
    label = "Newton in the complex view"
    short = "CN"
    citation = "Golla, Seidel, Chen 2018 [GSC18]; Chen & Weber 2017 [CW17]; section 4.3"
    kinds = ("parameterize", "plane")

    def convex_hessian(self, problem: Problem, state: State, evaluation: Evaluation) -> Floats:
        return complex_hessian(problem, state.positions)
