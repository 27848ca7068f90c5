"""Where points are in a tetrahedral mesh: the tetrahedron that holds each, or the nearest one."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numba
import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.box_tree import LEAF, build_box_tree
from workbench.core.jacobians import build_elements
from workbench.core.mesh import Mesh

TIE = 1e-9
"""Tetrahedra whose distances differ by this part are equally near: that which extrapolates least is taken."""
DEEPEST = 64


@dataclass(frozen=True, eq=False)
class Places:
    """Places of points in a tetrahedral mesh.

    Parameters
    ----------
    simplices : (k,) int64       tetrahedron of each point
    weights : (k, 4) float64     barycentric coordinates in it; some are negative for a point outside
    distances : (k,) float64     to that tetrahedron, 0 inside; in the unit of the mesh
    """

    simplices: Integers
    weights: Floats
    distances: Floats


def locate(mesh: Mesh, points: Floats) -> Places:
    """The tetrahedron that each point is in, or else the nearest.

    Parameters
    ----------
    mesh : Mesh                 tetrahedra, none degenerate, of either orientation
    points : (k, 3) float64

    Raises `MeshError` for degenerate tetrahedra. Cost: O((m + k) log m), releases the interpreter lock.
    """
    elements = build_elements(mesh)
    tree = build_box_tree(mesh.vertices, mesh.simplices)
    found = np.empty(len(points), dtype=np.int64)
    weights, squares = np.empty((len(points), 4)), np.empty(len(points))
    _locate_all(
        np.ascontiguousarray(points, dtype=np.float64),
        mesh.vertices, mesh.simplices, elements.inverse_rest, tree.low, tree.high, tree.order,
        found, weights, squares,
    )  # fmt: skip
    return Places(found, weights, np.sqrt(squares))


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _locate_all(points, vertices, simplices, inverse, low, high, order, found, weights, squares):  # type: ignore[no-untyped-def]
    stack = np.empty(DEEPEST, dtype=np.int64)
    waiting = np.empty(DEEPEST)
    w = np.empty(4)
    for k in range(len(points)):
        e = _holder(points, k, vertices, simplices, inverse, low, high, order, stack, w)
        squares[k] = 0.0
        if e < 0:
            e, squares[k] = _nearest(points, k, vertices, simplices, inverse, low, high, order, stack, waiting, w)
        found[k] = e
        _barycentric(points, k, vertices, simplices, inverse, e, w)
        for j in range(4):
            weights[k, j] = w[j]


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _holder(points, k, vertices, simplices, inverse, low, high, order, stack, w):  # type: ignore[no-untyped-def]
    """A tetrahedron that holds point k, or -1."""
    leaves = len(low) // 2
    stack[0], depth = 1, 1
    while depth:
        depth -= 1
        node = stack[depth]
        if _square_to_box(points, k, low, high, node) > 0.0:
            continue
        if node < leaves:
            stack[depth], stack[depth + 1] = 2 * node + 1, 2 * node
            depth += 2
            continue
        for place in range((node - leaves) * LEAF, (node - leaves + 1) * LEAF):
            e = order[place]
            if e >= 0 and _barycentric(points, k, vertices, simplices, inverse, e, w) >= 0.0:
                return e
    return -1


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _nearest(points, k, vertices, simplices, inverse, low, high, order, stack, waiting, w):  # type: ignore[no-untyped-def]
    """The tetrahedron nearest to point k, which none holds, and the square of its distance."""
    leaves = len(low) // 2
    p = points[k]
    best, least, chosen = math.inf, -math.inf, -1
    stack[0], waiting[0], depth = 1, 0.0, 1
    while depth:
        depth -= 1
        node = stack[depth]
        if waiting[depth] > best * (1.0 + TIE):
            continue
        if node < leaves:
            near, far = 2 * node, 2 * node + 1
            to_near, to_far = _square_to_box(points, k, low, high, near), _square_to_box(points, k, low, high, far)
            if to_far < to_near:
                near, far, to_near, to_far = far, near, to_far, to_near
            stack[depth], waiting[depth] = far, to_far
            stack[depth + 1], waiting[depth + 1] = near, to_near
            depth += 2
            continue
        for place in range((node - leaves) * LEAF, (node - leaves + 1) * LEAF):
            e = order[place]
            if e < 0:
                break
            lowest = _barycentric(points, k, vertices, simplices, inverse, e, w)
            square = _square_to_tetrahedron(p, vertices, simplices, e, w)
            is_tie = best * (1.0 - TIE) <= square <= best * (1.0 + TIE)
            if (is_tie and lowest > least) or (not is_tie and square < best):
                best, least, chosen = min(best, square), lowest, e
    return chosen, best


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _square_to_box(points, k, low, high, node):  # type: ignore[no-untyped-def]
    total = 0.0
    for i in range(3):
        beyond = max(low[node, i] - points[k, i], points[k, i] - high[node, i], 0.0)
        total += beyond * beyond
    return total


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _barycentric(points, k, vertices, simplices, inverse, e, w):  # type: ignore[no-untyped-def]
    """Write the barycentric coordinates of point k in tetrahedron e into w (4,); returns the least."""
    o = simplices[e, 0]
    x, y, z = points[k, 0] - vertices[o, 0], points[k, 1] - vertices[o, 1], points[k, 2] - vertices[o, 2]
    w[0], lowest = 1.0, math.inf
    for j in range(3):
        w[j + 1] = inverse[e, j, 0] * x + inverse[e, j, 1] * y + inverse[e, j, 2] * z
        w[0] -= w[j + 1]
        lowest = min(lowest, w[j + 1])
    return min(lowest, w[0])


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _square_to_tetrahedron(p, vertices, simplices, e, w):  # type: ignore[no-untyped-def]
    """Square of the distance from p, outside, to tetrahedron e: the nearest place is on a face that p is beyond."""
    best = math.inf
    for j in range(4):
        if w[j] < 0.0:
            a = vertices[simplices[e, (j + 1) % 4]]
            b = vertices[simplices[e, (j + 2) % 4]]
            c = vertices[simplices[e, (j + 3) % 4]]
            best = min(best, _square_to_triangle(p, a, b, c))
    return best


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _square_to_triangle(p, a, b, c):  # type: ignore[no-untyped-def]
    u0, u1, u2 = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    v0, v1, v2 = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    n0, n1, n2 = u1 * v2 - u2 * v1, u2 * v0 - u0 * v2, u0 * v1 - u1 * v0
    r0, r1, r2 = p[0] - a[0], p[1] - a[1], p[2] - a[2]
    normal = n0 * n0 + n1 * n1 + n2 * n2
    if normal > 0.0:
        # coordinates of the foot of the perpendicular: (r x v).n and (u x r).n over n.n
        t = ((r1 * v2 - r2 * v1) * n0 + (r2 * v0 - r0 * v2) * n1 + (r0 * v1 - r1 * v0) * n2) / normal
        s = ((u1 * r2 - u2 * r1) * n0 + (u2 * r0 - u0 * r2) * n1 + (u0 * r1 - u1 * r0) * n2) / normal
        if s >= 0.0 and t >= 0.0 and s + t <= 1.0:
            height = r0 * n0 + r1 * n1 + r2 * n2
            return height * height / normal
    return min(_square_to_segment(p, a, b), _square_to_segment(p, b, c), _square_to_segment(p, c, a))


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _square_to_segment(p, a, b):  # type: ignore[no-untyped-def]
    along = length = 0.0
    for i in range(3):
        along += (p[i] - a[i]) * (b[i] - a[i])
        length += (b[i] - a[i]) * (b[i] - a[i])
    t = min(1.0, max(0.0, along / length)) if length > 0.0 else 0.0
    total = 0.0
    for i in range(3):
        gap = p[i] - a[i] - t * (b[i] - a[i])
        total += gap * gap
    return total
