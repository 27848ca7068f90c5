"""Singular values of maps from surfaces to surfaces in space: triangles in, triangles out, both without a sign."""

from __future__ import annotations

import math

import numba
import numpy as np

from workbench.core.arrays import Floats
from workbench.core.jacobians import Elements, determinants, signed_singular_values


def is_into_space(elements: Elements, positions: Floats) -> bool:
    """Whether a map takes triangles into space, where they have no orientation of their own (45)."""
    return bool(positions.shape[1] > elements.dimension)


def singular_values_of_any(elements: Elements, positions: Floats) -> Floats:
    """(m, n) singular values, descending; signed where the map has an orientation."""
    values = surface_singular_values if is_into_space(elements, positions) else signed_singular_values
    return values(elements, positions)


def determinants_of_any(elements: Elements, positions: Floats) -> Floats:
    """(m,) signed factors of area or volume; of a surface in space without a sign."""
    if is_into_space(elements, positions):
        return np.asarray(surface_singular_values(elements, positions).prod(axis=1))
    return determinants(elements, positions)


def surface_singular_values(elements: Elements, positions: Floats) -> Floats:
    """Singular values of the maps of triangles into space (45).

    Parameters
    ----------
    elements : Elements            of triangles
    positions : (n, 3) float64     of their vertices

    Returns
    -------
    (m, 2) float64     descending, none negative: a triangle in space has no orientation of its own
    """
    out = np.empty((len(elements.simplices), 2))
    points = np.ascontiguousarray(positions, dtype=np.float64)
    _surface_values(points, elements.simplices, elements.inverse_rest, out)
    return out


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _surface_values(x, simplices, inverse_rest, out):  # type: ignore[no-untyped-def]
    a, b = np.empty(3), np.empty(3)  # columns of the Jacobian, 3 x 2
    for e in range(simplices.shape[0]):
        i, j, k = simplices[e, 0], simplices[e, 1], simplices[e, 2]
        m = inverse_rest[e]
        for c in range(3):
            p, q = x[j, c] - x[i, c], x[k, c] - x[i, c]
            a[c], b[c] = p * m[0, 0] + q * m[1, 0], p * m[0, 1] + q * m[1, 1]
        aa = a[0] * a[0] + a[1] * a[1] + a[2] * a[2]
        bb = b[0] * b[0] + b[1] * b[1] + b[2] * b[2]
        ab = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
        out[e, 0] = math.sqrt(0.5 * (aa + bb + math.hypot(aa - bb, 2.0 * ab)))
        n0, n1, n2 = a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]
        # the difference of the eigenvalues would cancel for slivers; the factor of area does not
        out[e, 1] = math.sqrt(n0 * n0 + n1 * n1 + n2 * n2) / out[e, 0] if out[e, 0] > 0.0 else 0.0
