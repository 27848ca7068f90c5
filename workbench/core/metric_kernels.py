"""Kernels that put a quadratic metric of every simplex into the fixed pattern: reweighted Laplacian, Killing energy.

Both work in any dimension n; each call adds the simplices [start, stop) into a buffer of its own.
"""

from __future__ import annotations

import math

import numba
import numpy as np

from workbench.core.simplex_kernels import frames_of, hats_of, jacobian_of
from workbench.core.tape import run_tape

TIE = 1e-8
"""Relative distance of a singular value from its target below which a weight is taken at its limit."""


@numba.njit(nogil=True, cache=True, error_model="numpy")
def reweighted_metric(  # type: ignore[no-untyped-def]
    x, simplices, inverse_rest, weights, kept, code, outputs, memory, centre, slots, start, stop, values
):
    """Add w (h_a . h_b) U diag(k) U^T for every two corners a, b: k_i = D_i / (sigma_i - s) (see `workbench.core.metrics`).

    kept : (m,) or (0,) float64   whether a simplex keeps its barrier, for densities that ask
    centre : float     s; below 0: the geometric mean of each simplex's own singular values
    values : (nnz,)    added to through slots
    """
    n = x.shape[1]
    lanes = memory.shape[1]
    frames, signed = np.empty((lanes, 3, 3)), np.empty((lanes, 3))
    D, J, V = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    H, P = np.empty((n + 1, n)), np.empty((n + 1, n + 1))
    M, k = np.empty((n, n)), np.empty(n)
    for block in range(start, stop, lanes):
        count = min(lanes, stop - block)
        for lane in range(count):
            e = block + lane
            det = jacobian_of(x, simplices, inverse_rest, e, D, J)
            frames_of(J, det, n, frames[lane], signed[lane], V)
            for i in range(n):
                memory[i, lane] = abs(signed[lane, i])
            if len(kept):
                memory[n, lane] = kept[e]
        run_tape(code, memory)
        for lane in range(count):
            e = block + lane
            s = centre
            if centre < 0.0:
                product = 1.0
                for i in range(n):
                    product *= memory[i, lane]
                s = product ** (1.0 / n)
            stiffest = 0.0
            for i in range(n):
                k[i] = _weight(
                    memory[outputs[1 + i], lane],
                    memory[outputs[1 + n + i * n - i * (i - 1) // 2], lane],
                    memory[i, lane] - s,
                    TIE * (memory[i, lane] + s),
                )
                stiffest = max(stiffest, k[i])
            for i in range(n):
                if not k[i] > 0.0:  # a density that does not feel this direction, or is concave in it
                    k[i] = 1e-3 * stiffest
            U = frames[lane]
            for i in range(n):
                for j in range(n):
                    M[i, j] = 0.0
                    for c in range(n):
                        M[i, j] += U[i, c] * k[c] * U[j, c]
            hats_of(inverse_rest, e, H)
            _products(H, weights[e], P)
            slot = 0
            for a in range(n + 1):
                for i in range(n):
                    for j in range(i, n):
                        values[slots[e, slot]] += P[a, a] * M[i, j]
                        slot += 1
                    for b in range(a + 1, n + 1):
                        for j in range(n):
                            values[slots[e, slot]] += P[a, b] * M[i, j]
                            slot += 1


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="always")
def _weight(first, second, offset, tie):  # type: ignore[no-untyped-def]
    """D_i over the distance from the target; its limit D_ii where they meet; 0 where neither is a positive number."""
    if abs(offset) > tie:
        quotient = first / offset
        if 0.0 < quotient < math.inf:
            return quotient
    if 0.0 < second < math.inf:
        return second
    return 0.0


@numba.njit(nogil=True, cache=True, error_model="numpy")
def killing_metric(x, simplices, inverse_rest, weights, slots, start, stop, values):  # type: ignore[no-untyped-def]
    """Add 4 w ((g_a . g_b) I + g_b g_a^T) for every two corners a, b, g the hat gradients on the current map.

    The Hessian of w |grad v + (grad v)^T|^2 for a field v on the map; values : (nnz,) added to through slots.
    """
    n = x.shape[1]
    D, J, inverse = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    H, G, P = np.empty((n + 1, n)), np.empty((n + 1, n)), np.empty((n + 1, n + 1))
    for e in range(start, stop):
        det = jacobian_of(x, simplices, inverse_rest, e, D, J)
        size = 0.0
        for i in range(n):
            for j in range(n):
                size += J[i, j] * J[i, j]
        least = 1e-10 * (size / n) ** (0.5 * n) + 1e-300
        if abs(det) < least:
            det = least if det >= 0.0 else -least
        if n == 2:
            inverse[0, 0], inverse[0, 1] = J[1, 1] / det, -J[0, 1] / det
            inverse[1, 0], inverse[1, 1] = -J[1, 0] / det, J[0, 0] / det
        else:
            for i in range(3):
                for j in range(3):
                    r, s = (j + 1) % 3, (j + 2) % 3
                    c, d = (i + 1) % 3, (i + 2) % 3
                    inverse[i, j] = (J[r, c] * J[s, d] - J[r, d] * J[s, c]) / det
        hats_of(inverse_rest, e, H)
        for a in range(n + 1):
            for j in range(n):
                G[a, j] = 0.0
                for c in range(n):
                    G[a, j] += H[a, c] * inverse[c, j]
        w = 4.0 * weights[e]
        _products(G, w, P)
        slot = 0
        for a in range(n + 1):
            for i in range(n):
                for b in range(a, n + 1):
                    for j in range(i if b == a else 0, n):
                        entry = w * G[b, i] * G[a, j]
                        if i == j:
                            entry += P[a, b]
                        values[slots[e, slot]] += entry
                        slot += 1


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="always")
def _products(H, w, P):  # type: ignore[no-untyped-def]
    """Write w times the inner products of the rows of H into the upper triangle of P."""
    for a in range(H.shape[0]):
        for b in range(a, H.shape[0]):
            total = 0.0
            for c in range(H.shape[1]):
                total += H[a, c] * H[b, c]
            P[a, b] = w * total
