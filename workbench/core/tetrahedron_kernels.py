"""The fused kernels for tetrahedra, in the scheme of `workbench.core.element_kernels`.

In the frames of U and V the Hessian by the Jacobian is a 3x3 block D_ij and, for each pair i < j, a 2x2 block of twist and
flip: a vertex pair's 3x3 block is put together there and turned by U, at half the cost of the nine directions one by one.
"""

from __future__ import annotations

import math

import numba
import numpy as np

from workbench.core.element_kernels import TIE
from workbench.core.expression import SWITCH
from workbench.core.singular_value_lanes import decompose_block, load_jacobians, values_of_block
from workbench.core.tape import run_tape


@numba.njit(nogil=True, cache=True, error_model="numpy")
def energy_3d(  # type: ignore[no-untyped-def]
    x, simplices, inverse_rest, weights, kept, code, outputs, memory, barrier, start, stop
):
    """Energy of tetrahedra [start, stop): see `energy_2d`."""
    lanes = memory.shape[1]
    energy = 0.0
    inverted = 0
    columns, turns = np.zeros(9 * lanes), np.zeros(11 * lanes)
    units, dets = np.empty(lanes), np.empty(lanes)
    for block in range(start, stop, lanes):
        count = min(lanes, stop - block)
        load_jacobians(x, simplices, inverse_rest, block, count, columns, units, dets)
        for lane in range(count):
            if not dets[lane] > 0.0:
                inverted += 1
                if barrier and (len(kept) == 0 or kept[block + lane] > 0.5):
                    return math.inf, inverted
            if len(kept):
                memory[3, lane] = kept[block + lane]
        values_of_block(columns, turns, units, count, memory)
        run_tape(code, memory)
        row = memory[outputs[0]]
        for lane in range(count):
            energy += weights[block + lane] * row[lane]
    return energy, inverted


@numba.njit(nogil=True, cache=True, error_model="numpy")
def derivatives_3d(  # type: ignore[no-untyped-def]
    x, simplices, inverse_rest, weights, kept, code, outputs, memory, order, project, kink, slots, start, stop, gradient, values
):
    """Energy, gradient and, for order 2, Hessian values of tetrahedra [start, stop); slots (m, 78), see `derivatives_2d`."""
    lanes = memory.shape[1]
    frames_u, frames_v, signed = np.empty((lanes, 3, 3)), np.empty((lanes, 3, 3)), np.empty((lanes, 3))
    columns, turns = np.zeros(9 * lanes), np.zeros(11 * lanes)
    units, dets = np.empty(lanes), np.empty(lanes)
    energy = 0.0
    inverted = 0
    H, pulled = np.empty((3, 3)), np.empty(3)
    first, size = np.empty(3), np.empty(3)
    stretch, same, other, Q = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    blocks = np.empty((4, 3, 4, 3))
    for block in range(start, stop, lanes):
        count = min(lanes, stop - block)
        load_jacobians(x, simplices, inverse_rest, block, count, columns, units, dets)
        decompose_block(columns, turns, units, dets, count, frames_u, signed, frames_v)
        for lane in range(count):
            if not dets[lane] > 0.0:
                inverted += 1
            memory[0, lane], memory[1, lane], memory[2, lane] = signed[lane, 0], signed[lane, 1], abs(signed[lane, 2])
            if len(kept):
                memory[3, lane] = kept[block + lane]
        run_tape(code, memory)
        for lane in range(count):
            e = block + lane
            w = weights[e]
            U, V = frames_u[lane], frames_v[lane]
            sign = -1.0 if signed[lane, 2] < 0.0 else 1.0
            energy += w * memory[outputs[0], lane]
            for i in range(3):
                first[i] = memory[outputs[1 + i], lane]
                size[i] = memory[i, lane]
            if kink:
                _meet_at_ties(size, first)
            for j in range(3):  # hat gradients of the last three vertices, in the frame of V
                m0, m1, m2 = inverse_rest[e, j, 0], inverse_rest[e, j, 1], inverse_rest[e, j, 2]
                for i in range(3):
                    H[j, i] = V[0, i] * m0 + V[1, i] * m1 + V[2, i] * m2
            pulled[:] = 0.0
            for j in range(3):
                v = simplices[e, j + 1]
                h0, h1, h2 = w * first[0] * H[j, 0], w * first[1] * H[j, 1], w * sign * first[2] * H[j, 2]
                for c in range(3):
                    pull = U[c, 0] * h0 + U[c, 1] * h1 + U[c, 2] * h2
                    gradient[v, c] += pull
                    pulled[c] += pull
            v = simplices[e, 0]
            for c in range(3):
                gradient[v, c] -= pulled[c]
            if order < 2:
                continue
            k = 4
            for i in range(3):
                for j in range(i, 3):
                    stretch[i, j] = stretch[j, i] = memory[outputs[k], lane]
                    k += 1
            for i in range(3):
                for j in range(i + 1, 3):
                    gap = size[i] - size[j]
                    twist = (first[i] + first[j]) / max(size[i] + size[j], 1e-12 * size[0] + 1e-300)
                    flip = (first[i] - first[j]) / gap if gap > TIE * size[0] else stretch[i, i] - stretch[i, j]
                    if kink:
                        flip = (first[i] - first[j]) / max(gap, SWITCH * size[0], 1e-300)
                        radial = 0.5 * (stretch[i, i] - 2.0 * stretch[i, j] + stretch[j, j])
                        if gap < SWITCH * size[0] or (project and flip > radial):
                            lift = 0.5 * (flip - radial)
                            stretch[i, i] += lift
                            stretch[j, j] += lift
                            stretch[i, j] -= lift
                            stretch[j, i] -= lift
                    # twist and flip change places where one of the two values is negative
                    if j == 2 and sign < 0.0:
                        twist, flip = flip, twist
                    if project:
                        twist = twist if twist > 0.0 else 0.0
                        flip = flip if flip > 0.0 else 0.0
                    same[i, j] = same[j, i] = 0.5 * w * (flip + twist)
                    other[i, j] = other[j, i] = 0.5 * w * (flip - twist)
            for i in range(2):
                stretch[i, 2] *= sign
                stretch[2, i] *= sign
            if project and not _is_definite(stretch):
                _clamp_eigenvalues(stretch, Q)
            for i in range(3):
                same[i, i] = w * stretch[i, i]
                for j in range(i + 1, 3):
                    stretch[i, j] *= w
                    stretch[j, i] *= w
            _vertex_blocks(H, U, stretch, same, other, blocks)
            flat = blocks.reshape(12, 12)
            slot = 0
            for a in range(12):
                for b in range(a, 12):
                    values[slots[e, slot]] += flat[a, b]
                    slot += 1
    return energy, inverted


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _vertex_blocks(H, U, stretch, same, other, blocks):  # type: ignore[no-untyped-def]
    """Write the upper triangle of the Hessian (4, 3, 4, 3) by the positions of the corners.

    H : (3, 3)        hat gradients of the last three corners in the frame of V; the first corner's is minus their sum
    same, other       second derivatives by F_ij twice, and by F_ij and F_ji; by F_ii and F_kk: `stretch`; all others vanish
    """
    h = np.empty((3, 3))
    for v in range(3):
        for t in range(v, 3):
            for i in range(3):
                h[i, i] = H[v, 0] * same[i, 0] * H[t, 0] + H[v, 1] * same[i, 1] * H[t, 1] + H[v, 2] * same[i, 2] * H[t, 2]
                for k in range(3):
                    if k != i:
                        h[i, k] = H[v, i] * stretch[i, k] * H[t, k] + H[v, k] * other[i, k] * H[t, i]
            for c in range(3):
                r0 = U[c, 0] * h[0, 0] + U[c, 1] * h[1, 0] + U[c, 2] * h[2, 0]
                r1 = U[c, 0] * h[0, 1] + U[c, 1] * h[1, 1] + U[c, 2] * h[2, 1]
                r2 = U[c, 0] * h[0, 2] + U[c, 1] * h[1, 2] + U[c, 2] * h[2, 2]
                for d in range(3):
                    blocks[v + 1, c, t + 1, d] = r0 * U[d, 0] + r1 * U[d, 1] + r2 * U[d, 2]
    for d in range(3):
        for c in range(3):
            b01, b12, b02 = blocks[1, c, 2, d], blocks[2, c, 3, d], blocks[1, c, 3, d]
            blocks[0, c, 1, d] = -(blocks[1, c, 1, d] + blocks[1, d, 2, c] + blocks[1, d, 3, c])
            blocks[0, c, 2, d] = -(b01 + blocks[2, c, 2, d] + blocks[2, d, 3, c])
            blocks[0, c, 3, d] = -(b02 + b12 + blocks[3, c, 3, d])
    for c in range(3):
        for d in range(c, 3):
            blocks[0, c, 0, d] = -(blocks[0, c, 1, d] + blocks[0, c, 2, d] + blocks[0, c, 3, d])


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _meet_at_ties(size, first):  # type: ignore[no-untyped-def]
    """Draw the D_i of nearly equal singular values to their mean: the whole way at a tie."""
    near = SWITCH * size[0]
    if size[0] - size[2] < near:
        mean = (first[0] + first[1] + first[2]) / 3.0
        share = (size[0] - size[2]) / near
        for i in range(3):
            first[i] = mean + share * (first[i] - mean)
        return
    for i in range(2):
        gap = size[i] - size[i + 1]
        if gap < near:
            mean, half = 0.5 * (first[i] + first[i + 1]), 0.5 * (first[i] - first[i + 1]) * (gap / near)
            first[i], first[i + 1] = mean + half, mean - half


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="always")
def _is_definite(A):  # type: ignore[no-untyped-def]
    """Whether all pivots of A (3, 3) symmetric are positive: then its eigenvalues need not be known."""
    if not A[0, 0] > 0.0:
        return False
    l1, l2 = A[1, 0] / A[0, 0], A[2, 0] / A[0, 0]
    d1 = A[1, 1] - l1 * A[0, 1]
    if not d1 > 0.0:
        return False
    left = A[2, 1] - l2 * A[0, 1]
    return A[2, 2] - l2 * A[0, 2] - left * left / d1 > 0.0


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _clamp_eigenvalues(A, Q):  # type: ignore[no-untyped-def]
    """The nearest positive semi-definite matrix, in place; Q (3, 3) is room to work in."""
    symmetric_eigen_3x3(A, Q)
    l0, l1, l2 = A[0, 0], A[1, 1], A[2, 2]
    l0 = l0 if l0 > 0.0 else 0.0
    l1 = l1 if l1 > 0.0 else 0.0
    l2 = l2 if l2 > 0.0 else 0.0
    for i in range(3):
        for j in range(3):
            A[i, j] = l0 * Q[i, 0] * Q[j, 0] + l1 * Q[i, 1] * Q[j, 1] + l2 * Q[i, 2] * Q[j, 2]


@numba.njit(nogil=True, cache=True, error_model="numpy")
def symmetric_eigen_3x3(A, Q):  # type: ignore[no-untyped-def]
    """Cyclic Jacobi: A (3, 3) symmetric is made diagonal in place, the columns of Q are the eigenvectors."""
    for i in range(3):
        for j in range(3):
            Q[i, j] = 1.0 if i == j else 0.0
    for _ in range(30):
        scale = abs(A[0, 0]) + abs(A[1, 1]) + abs(A[2, 2])
        off = abs(A[0, 1]) + abs(A[0, 2]) + abs(A[1, 2])
        if not off > 1e-17 * scale:
            return
        for k in range(3):
            p = 0 if k < 2 else 1
            q = 1 if k == 0 else 2
            if A[p, q] == 0.0:
                continue
            theta = (A[q, q] - A[p, p]) / (2.0 * A[p, q])
            t = (1.0 if theta >= 0 else -1.0) / (abs(theta) + math.sqrt(1.0 + theta * theta))
            c = 1.0 / math.sqrt(1.0 + t * t)
            s = c * t
            for i in range(3):
                a, b = A[i, p], A[i, q]
                A[i, p], A[i, q] = c * a - s * b, s * a + c * b
            for i in range(3):
                a, b = A[p, i], A[q, i]
                A[p, i], A[q, i] = c * a - s * b, s * a + c * b
            for i in range(3):
                a, b = Q[i, p], Q[i, q]
                Q[i, p], Q[i, q] = c * a - s * b, s * a + c * b
