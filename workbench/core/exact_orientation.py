"""The exact sign of a determinant of coordinate differences, as kernels: floating point where sure, expansions where not.

An expansion is a sum of floating point numbers that do not overlap, the largest last: its sign is that of its last term
(Shewchuk 1997). All sums and products here are exact as long as nothing under- or overflows.
"""

from __future__ import annotations

import numba
import numpy as np

EPSILON = 2.0**-53
BOUND_3D = 2.0 * (7.0 + 56.0 * EPSILON) * EPSILON
"""A 3 x 3 determinant above this part of the sum of its absolute products has a sure sign: twice Shewchuk's bound of
section 4, as the terms are summed in another order than his."""
TINY, HUGE = 1e-280, 1e290
"""Where sums of products lie outside, digits may have been lost to underflow, or the sum to overflow."""
UNSURE = 2
"""Stands for a sign that is not found: a difference of coordinates lies beyond `SMALLEST` and `LARGEST`."""
SMALLEST, LARGEST = 1e-88, 1e95
"""Products of three numbers within these, and the errors of those products, are exact."""
TERMS = 6 * 8 * 4
_SPLITTER = 2.0**27 + 1.0


@numba.njit(nogil=True, cache=True, inline="always")
def _sum(a, b):  # type: ignore[no-untyped-def]
    """a + b rounded, and what rounding took away."""
    rounded = a + b
    share = rounded - a
    return rounded, (a - (rounded - share)) + (b - share)


@numba.njit(nogil=True, cache=True, inline="always")
def _product(a, b):  # type: ignore[no-untyped-def]
    """a b rounded, and what rounding took away: each factor is split into halves whose products are exact."""
    rounded = a * b
    wide = _SPLITTER * a
    a_high = wide - (wide - a)
    a_low = a - a_high
    wide = _SPLITTER * b
    b_high = wide - (wide - b)
    b_low = b - b_high
    error = ((a_high * b_high - rounded) + a_high * b_low + a_low * b_high) + a_low * b_low
    return rounded, error


@numba.njit(nogil=True, cache=True)
def _grown(terms, count, value):  # type: ignore[no-untyped-def]
    """The expansion of `count` terms plus `value`, in place without zeros; returns how many terms it has."""
    kept = 0
    for i in range(count):
        value, error = _sum(terms[i], value)
        if error != 0.0:
            terms[kept] = error
            kept += 1
    if value != 0.0:
        terms[kept] = value
        kept += 1
    return kept


@numba.njit(nogil=True, cache=True)
def _exact_sign(x, a, b, c, d):  # type: ignore[no-untyped-def]
    """The sign from exact differences, products and sums; `UNSURE` beyond their range."""
    edges = np.empty((3, 3, 2))  # edge, axis: the difference, and what rounding took away
    for axis in range(3):
        edges[0, axis, 0], edges[0, axis, 1] = _sum(x[b, axis], -x[a, axis])
        edges[1, axis, 0], edges[1, axis, 1] = _sum(x[c, axis], -x[a, axis])
        edges[2, axis, 0], edges[2, axis, 1] = _sum(x[d, axis], -x[a, axis])
        for edge in range(3):
            for part in range(2):
                size = abs(edges[edge, axis, part])
                if size != 0.0 and not SMALLEST < size < LARGEST:
                    return UNSURE
    terms = np.empty(TERMS)
    count = 0
    for order in range(6):
        first = order % 3
        second, third = ((first + 1) % 3, (first + 2) % 3) if order < 3 else ((first + 2) % 3, (first + 1) % 3)
        for part in range(8):
            u, v, w = edges[0, first, part & 1], edges[1, second, (part >> 1) & 1], edges[2, third, part >> 2]
            if u == 0.0 or v == 0.0 or w == 0.0:
                continue
            if order >= 3:
                u = -u
            high, low = _product(u, v)
            product, error = _product(high, w)
            count = _grown(terms, count, error)
            count = _grown(terms, count, product)
            if low != 0.0:
                product, error = _product(low, w)
                count = _grown(terms, count, error)
                count = _grown(terms, count, product)
    if count == 0:
        return 0
    return 1 if terms[count - 1] > 0.0 else -1


@numba.njit(nogil=True, cache=True)
def orientation_sign(x, a, b, c, d):  # type: ignore[no-untyped-def]
    """Sign of det(b - a, c - a, d - a) for rows a, b, c, d of the points x (n, 3): 0 exactly flat; `UNSURE` beyond range."""
    value, size, is_flat = 0.0, 0.0, True
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        u, v, w = x[b, i] - x[a, i], x[c, j] - x[a, j], x[d, k] - x[a, k]
        p, q = x[c, k] - x[a, k], x[d, j] - x[a, j]
        value += u * (v * w - p * q)
        size += abs(u) * (abs(v * w) + abs(p * q))
        is_flat = is_flat and (u == 0.0 or ((v == 0.0 or w == 0.0) and (p == 0.0 or q == 0.0)))
    if is_flat:  # no product at all
        return 0
    if abs(value) > BOUND_3D * size and TINY < size < HUGE:
        return 1 if value > 0.0 else -1
    return _exact_sign(x, a, b, c, d)


@numba.njit(nogil=True, cache=True)
def orientation_signs_3d(points, out):  # type: ignore[no-untyped-def]
    """`orientation_sign` of each of k tetrahedra, corners in (4 k, 3): all first ones, all second ones ...; into `out` (k,)."""
    count = len(out)
    for row in range(count):
        out[row] = orientation_sign(points, row, count + row, 2 * count + row, 3 * count + row)
