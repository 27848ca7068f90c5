"""One simplex in any dimension n: its Jacobian, its singular frames, its hat gradients, for kernels that are not fused.

They are called, not inlined: what little time that costs is saved many times over in compilation.
"""

from __future__ import annotations

import numba

from workbench.core.singular_values import determinant_3x3, signed_svd_2x2, signed_svd_3x3
from workbench.core.tetrahedron_edges import target_edges_3d


@numba.njit(nogil=True, cache=True, error_model="numpy")
def jacobian_of(x, simplices, inverse_rest, e, D, J):  # type: ignore[no-untyped-def]
    """Write the Jacobian of simplex e into J, its target edges into D, both (3, 3); returns the determinant, from the edges."""
    n = x.shape[1]
    if n == 2:
        i, j, k = simplices[e, 0], simplices[e, 1], simplices[e, 2]
        D[0, 0], D[1, 0] = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1]
        D[0, 1], D[1, 1] = x[k, 0] - x[i, 0], x[k, 1] - x[i, 1]
        m = inverse_rest[e]
        det = (D[0, 0] * D[1, 1] - D[1, 0] * D[0, 1]) * (m[0, 0] * m[1, 1] - m[0, 1] * m[1, 0])
    else:
        det = target_edges_3d(x, simplices, e, D) * determinant_3x3(inverse_rest[e])
    for r in range(n):
        for c in range(n):
            J[r, c] = 0.0
            for t in range(n):
                J[r, c] += D[r, t] * inverse_rest[e, t, c]
    return det


@numba.njit(nogil=True, cache=True, error_model="numpy")
def frames_of(J, det, n, U, s, V):  # type: ignore[no-untyped-def]
    """Write the signed decomposition of J: rotations U and V (3, 3), values s (3,); only the first n rows and columns count."""
    if n == 2:
        s1, s2, uc, us, vc, vs = signed_svd_2x2(J[0, 0], J[0, 1], J[1, 0], J[1, 1], det)
        s[0], s[1] = s1, s2
        U[0, 0], U[0, 1], U[1, 0], U[1, 1] = uc, -us, us, uc
        V[0, 0], V[0, 1], V[1, 0], V[1, 1] = vc, -vs, vs, vc
    else:
        signed_svd_3x3(J, U, s, V)


@numba.njit(nogil=True, cache=True, error_model="numpy")
def hats_of(inverse_rest, e, H):  # type: ignore[no-untyped-def]
    """Write the gradients of the hat functions of simplex e, in its own frame, into H (n + 1, n)."""
    n = H.shape[1]
    for c in range(n):
        H[0, c] = 0.0
        for j in range(n):
            H[j + 1, c] = inverse_rest[e, j, c]
            H[0, c] -= inverse_rest[e, j, c]
