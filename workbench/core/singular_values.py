"""Signed singular value decompositions of 2x2 and 3x3 matrices, as kernels.

J = U diag(sigma) V^T with U and V rotations, sigma_1 >= ... >= |sigma_n|; the last value carries the sign of det J.
"""

from __future__ import annotations

import math

import numba
import numpy as np

ORTHOGONAL = 1e-31
"""Square of the cosine between two columns below which they count as orthogonal: a few roundings."""


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="always")
def determinant_3x3(M):  # type: ignore[no-untyped-def]
    """Determinant of a (3, 3) matrix."""
    return (
        M[0, 0] * (M[1, 1] * M[2, 2] - M[1, 2] * M[2, 1])
        - M[0, 1] * (M[1, 0] * M[2, 2] - M[1, 2] * M[2, 0])
        + M[0, 2] * (M[1, 0] * M[2, 1] - M[1, 1] * M[2, 0])
    )


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="always")
def half_angle(x, y):  # type: ignore[no-untyped-def]
    """Cosine and sine of half the angle of the unit vector (x, y), without cancellation."""
    if x >= 0.0:
        c = math.sqrt(0.5 * (1.0 + x))
        return c, 0.5 * y / c
    s = math.sqrt(0.5 * (1.0 - x))
    if y < 0.0:
        s = -s
    return 0.5 * y / s, s


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="always")
def signed_svd_2x2(a, b, c, d, det):  # type: ignore[no-untyped-def]
    """Decomposition of [[a, b], [c, d]] from its similarity and anti-similarity parts (60)(61).

    `det` is the determinant as the caller knows it (from edges, where that is more exact).
    Returns sigma_1, sigma_2, and cosine and sine of the angles of U and V.
    """
    ax, ay = 0.5 * (a + d), 0.5 * (c - b)
    bx, by = 0.5 * (a - d), 0.5 * (c + b)
    alpha = math.sqrt(ax * ax + ay * ay)
    beta = math.sqrt(bx * bx + by * by)
    s1 = alpha + beta
    # |alpha| - |beta| cancels for slivers; the determinant does not.
    s2 = det / s1 if s1 > 0.0 else 0.0
    if alpha > 0.0:
        ax, ay = ax / alpha, ay / alpha
    else:
        ax, ay = 1.0, 0.0
    if beta > 0.0:
        bx, by = bx / beta, by / beta
    else:
        bx, by = 1.0, 0.0
    uc, us = half_angle(ax * bx - ay * by, ax * by + ay * bx)
    # angle of V = angle of U - angle of alpha
    vc = uc * ax + us * ay
    vs = us * ax - uc * ay
    return s1, s2, uc, us, vc, vs


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="always")
def unit_of(largest):  # type: ignore[no-untyped-def]
    """What to divide a matrix by, given its largest entry by magnitude, so that squares of squares stay numbers: mostly 1."""
    if 1e-60 < largest < 1e60 or not 0.0 < largest < math.inf:
        return 1.0
    return largest


@numba.njit(nogil=True, cache=True, error_model="numpy")
def signed_svd_3x3(J, U, s, V):  # type: ignore[no-untyped-def]
    """One-sided Jacobi (Hestenes): accurate for small, repeated and vanishing singular values.

    Writes rotations U and V (3, 3) and s (3,), descending by magnitude, the last with the sign of det J.
    """
    A = np.empty((3, 3))
    largest = 0.0
    for i in range(3):
        for j in range(3):
            largest = max(largest, abs(J[i, j]))
            V[i, j] = 1.0 if i == j else 0.0
    unit = unit_of(largest)
    for i in range(3):
        for j in range(3):
            A[i, j] = J[i, j] / unit
    frames_from_columns(A, U, s, V)
    for i in range(3):
        s[i] *= unit


@numba.njit(nogil=True, cache=True, error_model="numpy")
def orthogonalise(A, V):  # type: ignore[no-untyped-def]
    """Jacobi sweeps until the columns of A (3, 3) are orthogonal; the columns of V (3, 3) are turned alike."""
    for _ in range(30):
        rotated = False
        for k in range(3):
            p = 0 if k < 2 else 1
            q = 1 if k == 0 else 2
            app = A[0, p] * A[0, p] + A[1, p] * A[1, p] + A[2, p] * A[2, p]
            aqq = A[0, q] * A[0, q] + A[1, q] * A[1, q] + A[2, q] * A[2, q]
            apq = A[0, p] * A[0, q] + A[1, p] * A[1, q] + A[2, p] * A[2, q]
            if not apq * apq > ORTHOGONAL * app * aqq:
                continue
            rotated = True
            zeta = (aqq - app) / (2.0 * apq)
            t = (1.0 if zeta >= 0 else -1.0) / (abs(zeta) + math.sqrt(1.0 + zeta * zeta))
            c = 1.0 / math.sqrt(1.0 + t * t)
            z = c * t
            for i in range(3):
                x, y = A[i, p], A[i, q]
                A[i, p], A[i, q] = c * x - z * y, z * x + c * y
                x, y = V[i, p], V[i, q]
                V[i, p], V[i, q] = c * x - z * y, z * x + c * y
        if not rotated:
            break


@numba.njit(nogil=True, cache=True, error_model="numpy")
def frames_from_columns(A, U, s, V):  # type: ignore[no-untyped-def]
    """The decomposition of A V^T, V a rotation: U, s and a new V; A is used up."""
    orthogonalise(A, V)
    for j in range(3):
        s[j] = math.sqrt(A[0, j] * A[0, j] + A[1, j] * A[1, j] + A[2, j] * A[2, j])
    for k in range(3):  # sort the columns, descending
        p = 0 if k != 1 else 1
        q = 1 if k != 1 else 2
        if s[p] < s[q]:
            s[p], s[q] = s[q], s[p]
            for i in range(3):
                A[i, p], A[i, q] = A[i, q], A[i, p]
                V[i, p], V[i, q] = V[i, q], V[i, p]
    if determinant_3x3(V) < 0.0:
        for i in range(3):
            V[i, 2] = -V[i, 2]
            A[i, 2] = -A[i, 2]
    _left_rotation(A, s, U)


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _left_rotation(A, s, U):  # type: ignore[no-untyped-def]
    """U from the orthogonal columns of A; the third column is the cross product, so that det U = +1."""
    if s[0] <= 0.0:
        for i in range(3):
            for j in range(3):
                U[i, j] = 1.0 if i == j else 0.0
        s[0] = s[1] = s[2] = 0.0
        return
    for i in range(3):
        U[i, 0] = A[i, 0] / s[0]
    if s[1] > 1e-140 * s[0]:
        for i in range(3):
            U[i, 1] = A[i, 1] / s[1]
    else:  # rank one, as the square of a product tells no angle any more: any direction orthogonal to the first
        k = 0
        for i in range(1, 3):
            if abs(U[i, 0]) < abs(U[k, 0]):
                k = i
        norm = 0.0
        for i in range(3):
            U[i, 1] = (1.0 if i == k else 0.0) - U[k, 0] * U[i, 0]
            norm += U[i, 1] * U[i, 1]
        for i in range(3):
            U[i, 1] /= math.sqrt(norm)
    U[0, 2] = U[1, 0] * U[2, 1] - U[2, 0] * U[1, 1]
    U[1, 2] = U[2, 0] * U[0, 1] - U[0, 0] * U[2, 1]
    U[2, 2] = U[0, 0] * U[1, 1] - U[1, 0] * U[0, 1]
    if U[0, 2] * A[0, 2] + U[1, 2] * A[1, 2] + U[2, 2] * A[2, 2] < 0.0:
        s[2] = -s[2]
