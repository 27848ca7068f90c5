"""Newton's method with a convex majoriser built from the singular values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from workbench.api import Evaluation, Floats, NewtonSolver, Problem, State, complex_hessian, parameter


@dataclass(frozen=True)
class CompositeMajorization(NewtonSolver):
    """Steps to the minimum of a convex quadratic that comes from sigma_1 = |alpha| + |beta| and sigma_2 = |alpha| - |beta|.

    |alpha| and |beta| are convex in the positions. A convex function that grows keeps its curvature, one with a negative
    factor is concave and is replaced by its tangent (Shtengel et al. 2017, section 4). The factors are taken of |alpha| and
    of |beta|, D_1 + D_2 and D_1 - D_2, as the authors' program does; `separate` takes those of each singular value, D_1 and
    D_2, as the general formula of the paper reads: a looser bound. Where D is convex in (sigma_1, sigma_2), as for symmetric
    Dirichlet, its curvature there is kept whole; else its convex part, so that any distortion can be minimised, but the
    quadratic need not lie above the energy far from the map. Joined, the matrix is then that of Projected Newton on Jacobians.
    """

    id = "composite-majorization"
    label = "Composite majorization"
    short = "CM"
    citation = "Shtengel, Poranne, Sorkine-Hornung, Kovalsky, Lipman 2017 [SPSH*17]; section 4.3"
    kinds = ("parameterize", "plane")

    factors: Literal["joined", "separate"] = parameter("joined", "factors of |alpha| and |beta|, or of each singular value")

    def convex_hessian(self, problem: Problem, state: State, evaluation: Evaluation) -> Floats:
        return complex_hessian(problem, state.positions, self.factors)
