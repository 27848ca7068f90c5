"""Progressive references: a source between the map and the true source, so near that no triangle is distorted much.

With J = U diag(sigma) V^T from the true triangle to its image, the reference at t in [0, 1] is the triangle from which the
image has the Jacobian U diag(sigma^t) V^T: the image itself up to a rotation at t = 0, the true triangle at t = 1.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numba
import numpy as np

from workbench.core.arrays import Floats
from workbench.core.jacobians import Elements, jacobian_2d, signed_singular_values
from workbench.core.singular_values import signed_svd_2x2

if TYPE_CHECKING:
    from workbench.core.problem import Problem

HALVINGS = 40
"""Of the interval [0, 1] in which t lies."""


def largest_exponent(singular_values: Floats, bound: float) -> float:
    """Largest t in [0, 1] with sum sigma^2t + sigma^-2t <= `bound` in every simplex; (m, n) positive values."""
    logarithms = 2.0 * np.log(singular_values)
    # Convex in t and least at t = 0: only simplices above the bound at t = 1 limit it.
    logarithms = logarithms[_symmetric_dirichlet(logarithms) > bound]
    if not len(logarithms):
        return 1.0
    low, high = 0.0, 1.0
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if (_symmetric_dirichlet(middle * logarithms) <= bound).all():
            low = middle
        else:
            high = middle
    return low


def _symmetric_dirichlet(logarithms: Floats) -> Floats:
    with np.errstate(over="ignore"):
        result: Floats = 2.0 * np.cosh(logarithms).sum(axis=1)
    return result


def progressive_problem(problem: Problem, positions: Floats, bound: float, uniform: bool) -> tuple[Problem, float]:
    """The problem whose source is the reference as near to the true one as `bound` allows, and its t.

    Parameters
    ----------
    problem : Problem           of triangles
    positions : (N, 2) float64  no triangle inverted
    bound : float > 4           largest symmetric Dirichlet density (32) from the reference to the map
    uniform : bool              every triangle of the reference weighs the same, instead of its true area

    Source: Liu, Ye, Ni, Fu 2018, section 4. Cost: O(m).
    """
    e = problem.elements
    t = largest_exponent(signed_singular_values(e, positions), bound)
    if t >= 1.0:
        return problem, t
    inverse_rest = np.empty_like(e.inverse_rest)
    _reference_frames(positions, e.simplices, e.inverse_rest, t, inverse_rest)
    measures = np.full(len(e.simplices), problem.total_measure / len(e.simplices)) if uniform else e.rest_measures
    density = replace(problem.density, elements=Elements(e.simplices, inverse_rest, measures, e.vertex_count))
    return replace(problem, density=density), t


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _reference_frames(x, simplices, inverse_rest, t, out):  # type: ignore[no-untyped-def]
    """Inverse rest edges of the reference: those of the source times V diag(sigma^(t - 1)) V^T."""
    for e in range(simplices.shape[0]):
        a, b, c, d, det = jacobian_2d(x, simplices, inverse_rest, e)
        s1, s2, _, _, vc, vs = signed_svd_2x2(a, b, c, d, det)
        r1, r2 = s1 ** (t - 1.0), s2 ** (t - 1.0)
        first, both, second = vc * vc * r1 + vs * vs * r2, vc * vs * (r1 - r2), vs * vs * r1 + vc * vc * r2
        for row in range(2):
            m0, m1 = inverse_rest[e, row, 0], inverse_rest[e, row, 1]
            out[e, row, 0], out[e, row, 1] = m0 * first + m1 * both, m0 * both + m1 * second
