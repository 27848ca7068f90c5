"""Exact signs in the plane and in space: floating point where it is sure, fractions where it is not."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from workbench.core.arrays import Booleans, Floats, Integers
from workbench.core.exact_orientation import EPSILON, HUGE, TINY, UNSURE, orientation_signs_3d

# Shewchuk 1997, section 4: the sign of a value below this part of the sum of its absolute products is not sure.
_BOUND_2D = (3.0 + 16.0 * EPSILON) * EPSILON


def orientation(a: Floats, b: Floats, c: Floats) -> Integers:
    """Sign of the area of each triangle a b c: 1 counter-clockwise, -1 clockwise, 0 exactly collinear.

    Parameters
    ----------
    a, b, c : (k, 2) float64     finite

    Returns
    -------
    (k,) int64
    """
    a, b, c = np.broadcast_arrays(a, b, c)
    with np.errstate(over="ignore", invalid="ignore", under="ignore"):
        ax, ay, bx, by = a[:, 0] - c[:, 0], a[:, 1] - c[:, 1], b[:, 0] - c[:, 0], b[:, 1] - c[:, 1]
        left, right = ax * by, ay * bx
        value, size = left - right, np.abs(left) + np.abs(right)
        is_sure = (np.abs(value) > _BOUND_2D * size) & (size < HUGE) & (size > TINY)
    # an exact zero among the differences makes its product exact
    is_sure |= ((ax == 0) | (by == 0)) & ((ay == 0) | (bx == 0))
    is_sure &= np.isfinite(value)
    signs = np.sign(np.where(is_sure, value, 0.0)).astype(np.int64)
    for row in np.flatnonzero(~is_sure):
        signs[row] = _exact_sign([a[row], b[row], c[row]])
    return signs


def orientation_3d(a: Floats, b: Floats, c: Floats, d: Floats) -> Integers:
    """Sign of det(b - a, c - a, d - a) of each tetrahedron, exactly; arguments (k, 3), result (k,) int64."""
    signs = np.empty(len(a), dtype=np.int64)
    orientation_signs_3d(np.concatenate([a, b, c, d]), signs)
    for row in np.flatnonzero(signs == UNSURE):
        signs[row] = _exact_sign([a[row], b[row], c[row], d[row]])
    return signs


def segments_meet(a: Floats, b: Floats, c: Floats, d: Floats) -> Booleans:
    """Whether the closed segments a b and c d have a point in common, exactly; arguments (k, 2), result (k,) bool."""
    boxes_meet = np.ones(len(a), dtype=bool)
    for axis in (0, 1):
        first_low, first_high = np.minimum(a[:, axis], b[:, axis]), np.maximum(a[:, axis], b[:, axis])
        second_low, second_high = np.minimum(c[:, axis], d[:, axis]), np.maximum(c[:, axis], d[:, axis])
        boxes_meet &= (first_low <= second_high) & (second_low <= first_high)
    meet = np.zeros(len(a), dtype=bool)
    rows = np.flatnonzero(boxes_meet)
    p, q, r, s = a[rows], b[rows], c[rows], d[rows]
    # On one line the boxes decide; else each segment has to reach the other's line.
    meet[rows] = orientation(p, q, r) * orientation(p, q, s) <= 0
    meet[rows] &= orientation(r, s, p) * orientation(r, s, q) <= 0
    return meet


def rays_coincide(origin: Floats, first: Floats, second: Floats) -> Booleans:
    """Whether `first` and `second` lie in exactly the same direction from `origin`; (k, 2) each, result (k,) bool."""
    same_side = (np.sign(first - origin) == np.sign(second - origin)).all(axis=1)
    result: Booleans = same_side & (orientation(origin, first, second) == 0)
    return result


def _exact_sign(points: list[Floats]) -> int:
    """Sign of the determinant of the differences from the first point, in fractions."""
    rows = [[Fraction(float(x)) for x in point] for point in points]
    edges = [[x - y for x, y in zip(row, rows[0], strict=True)] for row in rows[1:]]
    if len(edges) == 2:
        value = edges[0][0] * edges[1][1] - edges[0][1] * edges[1][0]
    else:
        u, v, w = edges
        value = u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0])
    return (value > 0) - (value < 0)
