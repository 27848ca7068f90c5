"""The edges of a tetrahedron's image and its Jacobian, for kernels; they are written into small arrays of the caller's."""

from __future__ import annotations

import numba

from workbench.core.singular_values import determinant_3x3


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="always")
def target_edges_3d(x, simplices, e, D):  # type: ignore[no-untyped-def]
    """Write the target edges of tetrahedron e as columns of D (3, 3); return their determinant."""
    o = simplices[e, 0]
    for j in range(3):
        v = simplices[e, j + 1]
        for c in range(3):
            D[c, j] = x[v, c] - x[o, c]
    return determinant_3x3(D)


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="always")
def jacobian_3d(D, inverse_rest, e, J):  # type: ignore[no-untyped-def]
    """Write the Jacobian of tetrahedron e, whose target edges are the columns of D, into J (3, 3)."""
    for i in range(3):
        for j in range(3):
            J[i, j] = D[i, 0] * inverse_rest[e, 0, j] + D[i, 1] * inverse_rest[e, 1, j] + D[i, 2] * inverse_rest[e, 2, j]
