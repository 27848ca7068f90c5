"""Pairs of triangles in space that meet elsewhere than in their common vertices and edges, found exactly."""

from __future__ import annotations

from typing import Literal

import numba
import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.exact_orientation import BOUND_3D, TINY, orientation_sign

Which = Literal["all", "joined", "apart"]
_ALL, _JOINED, _APART = 0, 1, 2
_FINEST = 2.0**-230
"""Coordinates below this part of the largest count as 0: so products of three differences are exact."""
_FIRST_ROOM = 1024


def meeting_triangles(triangles: Integers, positions: Floats, which: Which = "all", most: int = 10_000) -> Integers:
    """Pairs (p, 2) of triangles, lower number first, that meet elsewhere than in what they have in common.

    Triangles are closed: to touch is to meet. Two on one edge meet where they lie on each other; two at one vertex where
    they have more than that point in common, and so arbitrarily close to it.

    Parameters
    ----------
    triangles : (b, 3) int64          none of them degenerate in `positions`, no two on the same three vertices
    positions : (n, 3) float64        finite
    which : str                       pairs with a common vertex ("joined"), those without ("apart"), or all
    most : int                        the search ends when so many are found

    Boxes are swept along the axis that tells them apart best; signs are exact. Releases the interpreter lock.
    Cost: O(b log b + pairs whose boxes overlap along that axis): 10 ms for 10,000 triangles of a ball.
    """
    if len(triangles) < 2:
        return np.empty((0, 2), dtype=np.int64)
    scale = float(np.abs(positions[triangles]).max())
    points = positions * 2.0 ** -np.ceil(np.log2(scale)) if scale > 0.0 else positions.copy()
    points[np.abs(points) < _FINEST] = 0.0
    corners = points[triangles]
    low, high = corners.min(axis=1), corners.max(axis=1)
    axis = int(np.argmin((high - low).mean(axis=0) / np.maximum(np.ptp(points[triangles.ravel()], axis=0), 1e-300)))
    order = np.argsort(low[:, axis], kind="stable")
    only = {"all": _ALL, "joined": _JOINED, "apart": _APART}[which]
    found = _sweep(points, triangles[order], low[order], high[order], axis, only, most)
    pairs: Integers = np.sort(order[found], axis=1)
    return pairs[np.lexsort(pairs.T[::-1])]


@numba.njit(nogil=True, cache=True)
def _sweep(points, triangles, low, high, axis, only, most):  # type: ignore[no-untyped-def]
    pairs = np.empty((_FIRST_ROOM, 2), np.int64)
    count = 0
    one, two = (axis + 1) % 3, (axis + 2) % 3
    for i in range(len(triangles)):
        for j in range(i + 1, len(triangles)):
            if low[j, axis] > high[i, axis]:
                break
            if low[j, one] > high[i, one] or high[j, one] < low[i, one]:
                continue
            if low[j, two] > high[i, two] or high[j, two] < low[i, two]:
                continue
            if only != _ALL and (_common(triangles[i], triangles[j]) == 0) == (only == _JOINED):
                continue
            if not _meet(points, triangles[i], triangles[j]):
                continue
            if count == len(pairs):
                wider = np.empty((2 * count, 2), np.int64)
                wider[:count] = pairs
                pairs = wider
            pairs[count, 0], pairs[count, 1] = i, j
            count += 1
            if count >= most:
                return pairs[:count]
    return pairs[:count]


@numba.njit(nogil=True, cache=True)
def _common(first, second):  # type: ignore[no-untyped-def]
    """How many vertices two triangles share."""
    count = 0
    for i in range(3):
        for j in range(3):
            if first[i] == second[j]:
                count += 1
    return count


@numba.njit(nogil=True, cache=True)
def _meet(x, first, second):  # type: ignore[no-untyped-def]
    """Whether two triangles have a point in common beside shared vertices and edges.

    Convex sets that meet, meet on the boundary of one of them: so an edge of one reaches the other. From a shared vertex
    the ray through another common point leaves one of the two triangles by the side opposite that vertex.
    """
    shared = _common(first, second)
    if shared == 3:
        return True
    i, j = _odd_corner(first, second, shared), _odd_corner(second, first, shared)
    if shared == 2:
        return _folded(x, first[(i + 1) % 3], first[(i + 2) % 3], first[i], second[j])
    for turn in range(2):
        one, other, corner = (first, second, i) if turn == 0 else (second, first, j)
        for side in range(3):  # opposite the corner with this number
            is_apart = shared == 0 or side == corner
            if is_apart and _reaches(x, one[(side + 1) % 3], one[(side + 2) % 3], other):
                return True
    return False


@numba.njit(nogil=True, cache=True)
def _odd_corner(first, second, shared):  # type: ignore[no-untyped-def]
    """Corner of the first triangle that is the only shared one, or the only one not shared of two."""
    for i in range(3):
        is_shared = first[i] == second[0] or first[i] == second[1] or first[i] == second[2]
        if is_shared == (shared == 1):
            return i
    return 0


@numba.njit(nogil=True, cache=True)
def _folded(x, a, b, c, d):  # type: ignore[no-untyped-def]
    """Whether the triangles a b c and a b d lie on each other: flat, with c and d on one side of a b."""
    if orientation_sign(x, a, b, c, d) != 0:
        return False
    axis = _projection(x, a, b, c)
    return _flat_sign(x, a, b, c, axis) * _flat_sign(x, a, b, d, axis) > 0


@numba.njit(nogil=True, cache=True)
def _reaches(x, p, q, triangle):  # type: ignore[no-untyped-def]
    """Whether the closed segment p q and a closed triangle have a point in common."""
    side_p = orientation_sign(x, triangle[0], triangle[1], triangle[2], p)
    side_q = orientation_sign(x, triangle[0], triangle[1], triangle[2], q)
    if side_p * side_q > 0:
        return False
    if side_p == 0 and side_q == 0:
        return _reaches_in_plane(x, p, q, triangle)
    turn = 0  # the sense in which the triangle goes round the line p q
    for i in range(3):
        sign = orientation_sign(x, p, q, triangle[i], triangle[(i + 1) % 3])
        if sign * turn < 0:
            return False
        if sign != 0:
            turn = sign
    return True


@numba.njit(nogil=True, cache=True)
def _reaches_in_plane(x, p, q, triangle):  # type: ignore[no-untyped-def]
    """The same for five points in one plane: seen along an axis from which the triangle is not a line."""
    axis = _projection(x, triangle[0], triangle[1], triangle[2])
    turn = _flat_sign(x, triangle[0], triangle[1], triangle[2], axis)
    is_inside = True
    for i in range(3):
        a, b = triangle[i], triangle[(i + 1) % 3]
        is_inside = is_inside and turn * _flat_sign(x, a, b, p, axis) >= 0
        if _cross_flat(x, p, q, a, b, axis):
            return True
    return is_inside


@numba.njit(nogil=True, cache=True)
def _cross_flat(x, p, q, a, b, axis):  # type: ignore[no-untyped-def]
    """Whether the closed segments p q and a b meet, seen along `axis`."""
    for step in (1, 2):
        k = (axis + step) % 3
        if max(x[p, k], x[q, k]) < min(x[a, k], x[b, k]) or max(x[a, k], x[b, k]) < min(x[p, k], x[q, k]):
            return False
    if _flat_sign(x, p, q, a, axis) * _flat_sign(x, p, q, b, axis) > 0:
        return False
    return _flat_sign(x, a, b, p, axis) * _flat_sign(x, a, b, q, axis) <= 0


@numba.njit(nogil=True, cache=True)
def _projection(x, a, b, c):  # type: ignore[no-untyped-def]
    """Axis along which the triangle a b c is seen largest, its area not exactly 0 there."""
    best, size = 0, -1.0
    for axis in range(3):
        area = abs(_flat_area(x, a, b, c, axis)[0])
        if area > size and _flat_sign(x, a, b, c, axis) != 0:
            best, size = axis, area
    return best


@numba.njit(nogil=True, cache=True)
def _flat_area(x, a, b, c, axis):  # type: ignore[no-untyped-def]
    """Twice the area of the triangle a b c seen along `axis`, and the sum of its absolute products."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    left = (x[b, i] - x[a, i]) * (x[c, j] - x[a, j])
    right = (x[b, j] - x[a, j]) * (x[c, i] - x[a, i])
    return left - right, abs(left) + abs(right)


@numba.njit(nogil=True, cache=True)
def _flat_sign(x, a, b, c, axis):  # type: ignore[no-untyped-def]
    """Exact sign of the area of the triangle a b c seen along `axis`."""
    area, size = _flat_area(x, a, b, c, axis)
    if abs(area) > BOUND_3D * size and size > TINY:
        return 1 if area > 0.0 else -1
    # that of a tetrahedron of height 1 over it
    i, j = (axis + 1) % 3, (axis + 2) % 3
    points = np.zeros((4, 3))
    for row, vertex in ((0, a), (1, b), (2, c), (3, a)):
        points[row, 0], points[row, 1] = x[vertex, i], x[vertex, j]
    points[3, 2] = 1.0
    return orientation_sign(points, 0, 1, 2, 3)
