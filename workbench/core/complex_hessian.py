"""Convex Hessians of planar maps in the complex view, where every triangle is a pair (f_z, f_zbar).

With alpha = |f_z| and beta = |f_zbar|, sigma_1 = alpha + beta and the signed sigma_2 = alpha - beta (60)(61). In polar
coordinates of the two complex numbers the Hessian of a triangle is a 2x2 block on (alpha, beta) and one number for each of
the two angles, so that every convex approximation has a closed form: no decomposition of a matrix is computed.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

import numba
import numpy as np

from workbench.core.arrays import Floats
from workbench.core.element_kernels import TIE
from workbench.core.expression import SWITCH
from workbench.core.jacobians import jacobian_2d
from workbench.core.tape import run_tape
from workbench.core.threads import over_ranges

if TYPE_CHECKING:
    from workbench.core.problem import Problem

Factors = Literal["joined", "separate"]
"""Of the larger and the smaller one of alpha and beta: as D depends on them, or as each singular value does."""


def complex_hessian(problem: Problem, positions: Floats, factors: Factors = "joined") -> Floats:
    """Positive semi-definite Hessian values (nnz,) of a planar map on the pattern, soft anchors included.

    joined : negative curvatures set to zero, the exact projection of every triangle (Chen & Weber 2017, Golla et al. 2018)
    separate : sigma_1 and sigma_2 majorised each for itself, a looser bound (Shtengel et al. 2017)

    Kinks of D are met as in `workbench.core.element_kernels`. Cost: O(m), releases the interpreter lock.
    """
    with problem.workspace.timed("assemble"):
        problem.workspace.counts["hessian"] += 1
        e, pattern, kept = problem.elements, problem.density.pattern, problem.density.barrier_flags
        compiled = problem.distortion.compiled(2)
        tape, kink = compiled.majoriser, compiled.is_kinked_at_ties

        def work(part: int, start: int, stop: int) -> Floats:
            values = np.zeros(pattern.entry_count)
            _add_hessians(
                positions, e.simplices, e.inverse_rest, e.rest_measures, kept, tape.code, tape.outputs, tape.registers(),
                factors == "separate", kink, pattern.slots, start, stop, values,
            )  # fmt: skip
            return values

        results = over_ranges(work, len(e.simplices))
        total = results[0]
        for other in results[1:]:
            total += other
        problem.add_soft_anchors(total)
        return total


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _add_hessians(  # type: ignore[no-untyped-def]
    x, simplices, inverse_rest, weights, kept, code, outputs, memory, separate, kink, slots, start, stop, values
):
    """Add the Hessians of triangles [start, stop) to `values` (nnz,) through slots (m, 21)."""
    lanes = memory.shape[1]
    units = np.empty((lanes, 5))  # f_z / |f_z|, f_zbar / |f_zbar|, sign of the determinant
    B = np.empty((4, 6))
    for block in range(start, stop, lanes):
        count = min(lanes, stop - block)
        for lane in range(count):
            e = block + lane
            a, b, c, d, det = jacobian_2d(x, simplices, inverse_rest, e)
            ax, ay = 0.5 * (a + d), 0.5 * (c - b)
            bx, by = 0.5 * (a - d), 0.5 * (c + b)
            alpha, beta = math.sqrt(ax * ax + ay * ay), math.sqrt(bx * bx + by * by)
            s1 = alpha + beta
            memory[0, lane] = s1
            # |alpha| - |beta| cancels for slivers; the determinant does not.
            memory[1, lane] = abs(det) / s1 if s1 > 0.0 else 0.0
            if len(kept):
                memory[2, lane] = kept[e]
            units[lane, 0], units[lane, 1] = (ax / alpha, ay / alpha) if alpha > 0.0 else (1.0, 0.0)
            units[lane, 2], units[lane, 3] = (bx / beta, by / beta) if beta > 0.0 else (1.0, 0.0)
            units[lane, 4] = -1.0 if det < 0.0 else 1.0
        run_tape(code, memory)
        for lane in range(count):
            e = block + lane
            w = weights[e]
            s1, s2 = memory[0, lane], memory[1, lane]
            d1, d2 = memory[outputs[1], lane], memory[outputs[2], lane]
            d11, d12, d22 = memory[outputs[3], lane], memory[outputs[4], lane], memory[outputs[5], lane]
            gap, near = s1 - s2, SWITCH * s1
            # curvature along the angle of the smaller one of alpha and beta, which is gap / 2
            radial = d11 - 2.0 * d12 + d22
            around = 2.0 * (d1 - d2) / gap if gap > TIE * s1 else radial
            if separate:
                around = 2.0 * (max(d1, 0.0) + max(-d2, 0.0)) / max(gap, near, 1e-300)
            elif kink:
                share = min(gap / near, 1.0) if near > 0.0 else 1.0
                around = 2.0 * share * (d1 - d2) / max(gap, near, 1e-300)
            if kink and (gap < near or around > radial):
                lift = 0.25 * (around - radial)
                d11, d12, d22 = d11 + lift, d12 - lift, d22 + lift
            # along the angle of the larger one, (s1 + s2) / 2
            factor = max(d1, 0.0) + max(d2, 0.0) if separate else max(d1 + d2, 0.0)
            turning = 2.0 * factor / max(s1 + s2, 1e-300)
            around = max(around, 0.0)
            k00, k01, k11 = _convex_block(d11, d12, d22)
            _polar_rows(inverse_rest, e, units[lane], B)
            slot = 0
            for p in range(6):
                c0, c1 = w * (k00 * B[0, p] + k01 * B[1, p]), w * (k01 * B[0, p] + k11 * B[1, p])
                c2, c3 = w * turning * B[2, p], w * around * B[3, p]
                for q in range(p, 6):
                    values[slots[e, slot]] += c0 * B[0, q] + c1 * B[1, q] + c2 * B[2, q] + c3 * B[3, q]
                    slot += 1


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="always")
def _polar_rows(inverse_rest, e, unit, B):  # type: ignore[no-untyped-def]
    """Rows of B (4, 6), by the six coordinates: d a, d b, a d(arg a), b d(arg b) for a larger than b of |f_z| and |f_zbar|."""
    larger, smaller = (0, 1) if unit[4] > 0.0 else (1, 0)
    for c in range(4):
        B[c, 0] = B[c, 1] = 0.0
    for v in range(2):
        # f_z = sum c_v z_v and f_zbar = sum conj(c_v) z_v with c_v = (h_x - i h_y) / 2 of the hat gradient h
        hx, hy = 0.5 * inverse_rest[e, v, 0], 0.5 * inverse_rest[e, v, 1]
        # q = c_v / unit of f_z, r = conj(c_v) / unit of f_zbar
        qx, qy = hx * unit[0] - hy * unit[1], -hy * unit[0] - hx * unit[1]
        rx, ry = hx * unit[2] + hy * unit[3], hy * unit[2] - hx * unit[3]
        column = 2 * v + 2
        B[larger, column], B[larger, column + 1] = qx, -qy
        B[smaller, column], B[smaller, column + 1] = rx, -ry
        B[2 + larger, column], B[2 + larger, column + 1] = qy, qx
        B[2 + smaller, column], B[2 + smaller, column + 1] = ry, rx
        for c in range(4):
            B[c, 0] -= B[c, column]
            B[c, 1] -= B[c, column + 1]


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="always")
def _convex_block(d11, d12, d22):  # type: ignore[no-untyped-def]
    """Positive semi-definite part of the Hessian in (sigma_1, sigma_2), carried over to (alpha, beta): (k00, k01, k11)."""
    mean, half = 0.5 * (d11 + d22), 0.5 * (d11 - d22)
    radius = math.sqrt(half * half + d12 * d12)
    if mean + radius <= 0.0:
        return 0.0, 0.0, 0.0
    if mean < radius:
        # one eigenvalue of each sign: (A - lambda_2 I) / (lambda_1 - lambda_2) projects on the positive one
        part = 0.5 * (mean + radius) / radius
        mean, half, d12 = part * radius, part * half, part * d12
    return 2.0 * (mean + d12), 2.0 * half, 2.0 * (mean - d12)
