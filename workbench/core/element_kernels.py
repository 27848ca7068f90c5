"""The fused kernels for triangles: positions to energy, gradient and projected Hessian, a block of simplices at a time.

Each kernel works on the simplices [start, stop) and adds into buffers of its own, so that a few threads share the work and
the sum is taken in a fixed order. Within a block: edges -> signed singular values -> the formula's tape -> assembly.
Hessian in J-space: the block D_ij on span(u_i v_i^T), and a twist and a flip for each pair (the isotropic eigensystem).

Where D_i and D_j differ at sigma_i = sigma_j (max(sigma), say), D has a kink there: along any way through the tie it runs
like (D_i - D_j) |sigma_i - sigma_j| / 2, the length of a vector, so the flip eigenvalue tends to infinity and the second
derivative across is 0 up to the tie. Within the part `SWITCH` of sigma_1 that length is replaced by Huber's function, a
parabola: at the tie itself the derivative is the mean of D_i and D_j, the subgradient that no rotation changes. A projected
Hessian moreover takes the flip eigenvalue across the tie too, as iteratively reweighted least squares does: Newton steps then
end at the tie.
"""

from __future__ import annotations

import math

import numba
import numpy as np

from workbench.core.expression import SWITCH
from workbench.core.jacobians import jacobian_2d
from workbench.core.singular_values import half_angle, signed_svd_2x2
from workbench.core.tape import run_tape

TIE = 1e-7
"""Relative gap of two singular values below which the flip eigenvalue is taken at its limit D_ii - D_ij."""


@numba.njit(nogil=True, cache=True, error_model="numpy")
def energy_2d(  # type: ignore[no-untyped-def]
    x, simplices, inverse_rest, weights, kept, code, outputs, memory, barrier, start, stop
):
    """Energy of triangles [start, stop): (sum w D, inverted count); +inf at the first inverted one of a barrier.

    kept : (m,) or (0,) float64    1 where a simplex keeps its barrier, 0 where it has none; empty: all keep it
    """
    lanes = memory.shape[1]
    energy = 0.0
    inverted = 0
    for block in range(start, stop, lanes):
        count = min(lanes, stop - block)
        for lane in range(count):
            e = block + lane
            a, b, c, d, det = jacobian_2d(x, simplices, inverse_rest, e)
            if not det > 0.0:
                inverted += 1
                if barrier and (len(kept) == 0 or kept[e] > 0.5):
                    return math.inf, inverted
            alpha = math.sqrt((a + d) * (a + d) + (c - b) * (c - b))
            beta = math.sqrt((a - d) * (a - d) + (c + b) * (c + b))
            s1 = 0.5 * (alpha + beta)
            memory[0, lane] = s1
            memory[1, lane] = abs(det) / s1 if s1 > 0.0 else 0.0
            if len(kept):
                memory[2, lane] = kept[e]
        run_tape(code, memory)
        row = memory[outputs[0]]
        for lane in range(count):
            energy += weights[block + lane] * row[lane]
    return energy, inverted


@numba.njit(nogil=True, cache=True, error_model="numpy")
def derivatives_2d(  # type: ignore[no-untyped-def]
    x, simplices, inverse_rest, weights, kept, code, outputs, memory, order, project, kink, slots, start, stop, gradient, values
):
    """Energy, gradient and, for order 2, Hessian values of triangles [start, stop).

    gradient : (N, 2) added to;  values : (nnz,) added to through slots (m, 21);  returns (energy, inverted count)
    kept : see `energy_2d`;  kink : whether D is not smooth where singular values are equal (see the head of this file)
    """
    lanes = memory.shape[1]
    frames = np.empty((lanes, 5))  # cosine and sine of U and V, sign of sigma_2
    energy = 0.0
    inverted = 0
    B = np.empty((4, 6))
    lam = np.empty(4)
    for block in range(start, stop, lanes):
        count = min(lanes, stop - block)
        for lane in range(count):
            e = block + lane
            a, b, c, d, det = jacobian_2d(x, simplices, inverse_rest, e)
            s1, s2, uc, us, vc, vs = signed_svd_2x2(a, b, c, d, det)
            if not det > 0.0:
                inverted += 1
            memory[0, lane], memory[1, lane] = s1, abs(s2)
            if len(kept):
                memory[2, lane] = kept[e]
            frames[lane, 0], frames[lane, 1], frames[lane, 2], frames[lane, 3] = uc, us, vc, vs
            frames[lane, 4] = -1.0 if s2 < 0.0 else 1.0
        run_tape(code, memory)
        for lane in range(count):
            e = block + lane
            w = weights[e]
            sign = frames[lane, 4]
            s1, s2 = memory[0, lane], memory[1, lane]  # sizes; the sign of the second one comes in below
            energy += w * memory[outputs[0], lane]
            d1, d2 = memory[outputs[1], lane], memory[outputs[2], lane]
            gap = s1 - s2
            near = SWITCH * s1
            if kink and gap < near:
                d1, d2 = 0.5 * (d1 + d2) + 0.5 * (d1 - d2) * (gap / near), 0.5 * (d1 + d2) - 0.5 * (d1 - d2) * (gap / near)
            uc, us, vc, vs = frames[lane, 0], frames[lane, 1], frames[lane, 2], frames[lane, 3]
            m00, m01 = inverse_rest[e, 0, 0], inverse_rest[e, 0, 1]
            m10, m11 = inverse_rest[e, 1, 0], inverse_rest[e, 1, 1]
            # hat gradients in the frame of V: h_j = V^T g_j
            h10, h11 = vc * m00 + vs * m01, vc * m01 - vs * m00
            h20, h21 = vc * m10 + vs * m11, vc * m11 - vs * m10
            # gradient: U diag(D_i) h_j
            a0, a1 = d1 * h10, sign * d2 * h11
            b0, b1 = d1 * h20, sign * d2 * h21
            gj0, gj1 = w * (uc * a0 - us * a1), w * (us * a0 + uc * a1)
            gk0, gk1 = w * (uc * b0 - us * b1), w * (us * b0 + uc * b1)
            i, j, k = simplices[e, 0], simplices[e, 1], simplices[e, 2]
            gradient[j, 0] += gj0
            gradient[j, 1] += gj1
            gradient[k, 0] += gk0
            gradient[k, 1] += gk1
            gradient[i, 0] -= gj0 + gk0
            gradient[i, 1] -= gj1 + gk1
            if order < 2:
                continue
            d11, d12, d22 = memory[outputs[3], lane], memory[outputs[4], lane], memory[outputs[5], lane]
            total = max(s1 + s2, 1e-300)
            across = (d1 - d2) / gap if gap > TIE * s1 else d11 - d12
            if kink:
                across = (d1 - d2) / max(gap, near, 1e-300)
                if gap < near or (project and across > 0.5 * (d11 - 2.0 * d12 + d22)):
                    lift = 0.5 * (across - 0.5 * (d11 - 2.0 * d12 + d22))
                    d11, d12, d22 = d11 + lift, d12 - lift, d22 + lift
            d12 *= sign
            # on an inverted simplex, twist and flip change places
            lam[2], lam[3] = (d1 + d2) / total, across
            if sign < 0.0:
                lam[2], lam[3] = lam[3], lam[2]
            # eigenvectors of the 2x2 block
            mean, half = 0.5 * (d11 + d22), 0.5 * (d11 - d22)
            radius = math.sqrt(half * half + d12 * d12)
            if radius > 0.0:
                bc, bs = half_angle(half / radius, d12 / radius)
            else:
                bc, bs = 1.0, 0.0
            lam[0], lam[1] = mean + radius, mean - radius
            if project:
                for r in range(4):
                    if not lam[r] > 0.0:
                        lam[r] = 0.0
            # rows of B: derivative of each J-space direction by the six coordinates, in the frame of U
            for v in range(1, 3):
                h0, h1 = (h10, h11) if v == 1 else (h20, h21)
                for r in range(4):
                    if r == 0:
                        y0, y1 = bc * h0, bs * h1
                    elif r == 1:
                        y0, y1 = -bs * h0, bc * h1
                    elif r == 2:  # twist (u1 v2^T - u2 v1^T) / sqrt 2
                        y0, y1 = math.sqrt(0.5) * h1, -math.sqrt(0.5) * h0
                    else:  # flip (u1 v2^T + u2 v1^T) / sqrt 2
                        y0, y1 = math.sqrt(0.5) * h1, math.sqrt(0.5) * h0
                    B[r, 2 * v], B[r, 2 * v + 1] = uc * y0 - us * y1, us * y0 + uc * y1
            for r in range(4):
                B[r, 0], B[r, 1] = -B[r, 2] - B[r, 4], -B[r, 3] - B[r, 5]
                lam[r] *= w
            slot = 0
            for a in range(6):
                c0, c1 = lam[0] * B[0, a], lam[1] * B[1, a]
                c2, c3 = lam[2] * B[2, a], lam[3] * B[3, a]
                for b in range(a, 6):
                    values[slots[e, slot]] += c0 * B[0, b] + c1 * B[1, b] + c2 * B[2, b] + c3 * B[3, b]
                    slot += 1
    return energy, inverted
