"""Signed singular values of many 3x3 matrices at once: Jacobi sweeps over blocks of `LANES` matrices that stay in the cache.

A sweep has no branch and its numbers lie side by side, so that a processor turns several matrices with one instruction: four
sweeps in the time of one of a matrix alone. What they leave over, mostly nothing, `orthogonalise` sees to matrix by matrix.
"""

from __future__ import annotations

import math

import numba
import numpy as np

from workbench.core.singular_values import determinant_3x3, frames_from_columns, orthogonalise, unit_of
from workbench.core.tape import LANES
from workbench.core.tetrahedron_edges import jacobian_3d, target_edges_3d

ROW = 3 * LANES
"""Numbers in a row of a block: entry (i, j) of the matrix in a lane stands at i ROW + j LANES + lane."""
SWEEPS = 4
"""Jacobi sweeps that leave hardly any matrix to `orthogonalise`."""
FLAT = 2e-15
"""Part of the largest singular value below which the last one has no sign of its own."""


@numba.njit(nogil=True, cache=True, error_model="numpy")
def load_jacobians(x, simplices, inverse_rest, first, count, columns, units, dets):  # type: ignore[no-untyped-def]
    """Write the Jacobians of the tetrahedra [first, first + count) into a block.

    columns : (9 LANES,) float64   divided by units (LANES,), see `unit_of`
    dets : (LANES,) float64        determinants, from the edges of the target
    """
    D, J = np.empty((3, 3)), np.empty((3, 3))
    for lane in range(count):
        e = first + lane
        dets[lane] = target_edges_3d(x, simplices, e, D) * determinant_3x3(inverse_rest[e])
        jacobian_3d(D, inverse_rest, e, J)
        largest = 0.0
        for i in range(3):
            for j in range(3):
                largest = max(largest, abs(J[i, j]))
        unit = unit_of(largest)
        units[lane] = unit
        for i in range(3):
            for j in range(3):
                columns[i * ROW + j * LANES + lane] = J[i, j] / unit


@numba.njit(nogil=True, cache=True, error_model="numpy")
def decompose_block(columns, turns, units, dets, count, U, s, V):  # type: ignore[no-untyped-def]
    """Signed decompositions of the matrices in a block, which is used up.

    columns : (9 LANES,), turns : (11 LANES,)     the block, and room to work in
    dets : (LANES,) float64                       give the sign of a last value that is lost in rounding
    U, V : (LANES, 3, 3), s : (LANES, 3)          written; s descends by magnitude, the last with the sign of det
    """
    for i in range(3):
        for j in range(3):
            turns[i * ROW + j * LANES : i * ROW + (j + 1) * LANES] = 1.0 if i == j else 0.0
    for _ in range(SWEEPS):
        # written out: a processor's wide instructions need to know at which distance the columns stand
        _turn_columns(columns, 0, LANES, turns)
        _turn_with(turns, 0, LANES)
        _turn_columns(columns, 0, 2 * LANES, turns)
        _turn_with(turns, 0, 2 * LANES)
        _turn_columns(columns, LANES, 2 * LANES, turns)
        _turn_with(turns, LANES, 2 * LANES)
    A = np.empty((3, 3))
    for lane in range(count):
        for i in range(3):
            for j in range(3):
                A[i, j] = columns[i * ROW + j * LANES + lane]
                V[lane, i, j] = turns[i * ROW + j * LANES + lane]
        frames_from_columns(A, U[lane], s[lane], V[lane])
        for i in range(3):
            s[lane, i] *= units[lane]
        if abs(s[lane, 2]) < FLAT * s[lane, 0]:  # the sign is rounding: that of the determinant, as the line search sees it
            s[lane, 2] = -abs(s[lane, 2]) if dets[lane] < 0.0 else abs(s[lane, 2])


@numba.njit(nogil=True, cache=True, error_model="numpy")
def values_of_block(columns, turns, units, count, s):  # type: ignore[no-untyped-def]
    """Singular values (3, LANES) by magnitude of the matrices in a block, which is used up; see `decompose_block`."""
    for _ in range(SWEEPS):
        _turn_columns(columns, 0, LANES, turns)
        _turn_columns(columns, 0, 2 * LANES, turns)
        _turn_columns(columns, LANES, 2 * LANES, turns)
    A, V = np.empty((3, 3)), np.zeros((3, 3))
    for lane in range(count):
        for i in range(3):
            for j in range(3):
                A[i, j] = columns[i * ROW + j * LANES + lane]
        orthogonalise(A, V)
        a = math.sqrt(A[0, 0] * A[0, 0] + A[1, 0] * A[1, 0] + A[2, 0] * A[2, 0])
        b = math.sqrt(A[0, 1] * A[0, 1] + A[1, 1] * A[1, 1] + A[2, 1] * A[2, 1])
        c = math.sqrt(A[0, 2] * A[0, 2] + A[1, 2] * A[1, 2] + A[2, 2] * A[2, 2])
        if a < b:
            a, b = b, a
        if b < c:
            b, c = c, b
        if a < b:
            a, b = b, a
        s[0, lane], s[1, lane], s[2, lane] = a * units[lane], b * units[lane], c * units[lane]


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="always")
def _turn_columns(A, p, q, turns):  # type: ignore[no-untyped-def]
    """Make columns p and q of every matrix orthogonal; cosines and sines go behind the nine rows of `turns`."""
    for lane in range(LANES):
        a0, a1, a2 = A[p + lane], A[ROW + p + lane], A[2 * ROW + p + lane]
        b0, b1, b2 = A[q + lane], A[ROW + q + lane], A[2 * ROW + q + lane]
        gap = b0 * b0 + b1 * b1 + b2 * b2 - (a0 * a0 + a1 * a1 + a2 * a2)
        double = 2.0 * (a0 * b0 + a1 * b1 + a2 * b2)
        signed = double if gap >= 0.0 else -double
        t = signed / (abs(gap) + math.sqrt(gap * gap + double * double) + 1e-300)
        c = 1.0 / math.sqrt(1.0 + t * t)
        z = c * t
        A[p + lane], A[q + lane] = c * a0 - z * b0, z * a0 + c * b0
        A[ROW + p + lane], A[ROW + q + lane] = c * a1 - z * b1, z * a1 + c * b1
        A[2 * ROW + p + lane], A[2 * ROW + q + lane] = c * a2 - z * b2, z * a2 + c * b2
        turns[3 * ROW + lane] = c
        turns[3 * ROW + LANES + lane] = z


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="always")
def _turn_with(V, p, q):  # type: ignore[no-untyped-def]
    """Turn columns p and q of V by the cosines and sines behind its nine rows."""
    for lane in range(LANES):
        c, z = V[3 * ROW + lane], V[3 * ROW + LANES + lane]
        for i in range(3):
            x, y = V[i * ROW + p + lane], V[i * ROW + q + lane]
            V[i * ROW + p + lane], V[i * ROW + q + lane] = c * x - z * y, z * x + c * y
