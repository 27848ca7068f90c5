"""A level set in space as well-shaped triangles: surface nets, then smoothing on the surface."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import numpy as np

from workbench.core.arrays import Booleans, Floats, Integers

Implicit = Callable[[Floats], Floats]
"""(k, 3) points -> (k,) values, negative inside, of slope about one near the surface."""

_SMOOTHING_ROUNDS = 25
_BLOCK = 8


def mesh_upper_surface(implicit: Implicit, low: Floats, high: Floats, spacing: float) -> tuple[Floats, Integers]:
    """The part of the level set 0 above the plane z = 0, for an `implicit` that is symmetric about that plane.

    One vertex a grid cell that the surface crosses, one quadrilateral a grid edge that it
    crosses (surface nets, Gibson 1998);
    the lowest cells straddle z = 0, where their vertices are the boundary.
    """
    axes = [np.arange(low[axis], high[axis] + spacing, spacing) for axis in (0, 1)]
    axes.append(np.arange(-0.5 * spacing, high[2] + spacing, spacing))
    inside = _without_ambiguous_faces(_sampled_inside(implicit, axes))
    cells = np.array(inside.shape) - 1
    corner_sum = np.zeros(cells, dtype=np.int64)
    for i, j, k in product((0, 1), repeat=3):
        corner_sum += inside[i : i + cells[0], j : j + cells[1], k : k + cells[2]]
    crossed = (corner_sum > 0) & (corner_sum < 8)
    index = np.full(crossed.shape, -1, dtype=np.int64)
    index[crossed] = np.arange(crossed.sum())
    vertices = np.stack(np.nonzero(crossed), axis=1) * spacing + [axis[0] + 0.5 * spacing for axis in axes]

    quads = []
    for axis in range(3):
        one, two = (axis + 1) % 3, (axis + 2) % 3
        before, after = [slice(None)] * 3, [slice(None)] * 3
        before[axis], after[axis] = slice(0, -1), slice(1, None)
        changes = inside[tuple(before)].astype(np.int64) - inside[tuple(after)]
        place = np.stack(np.nonzero(changes), axis=1)
        sign = changes[tuple(place.T)]
        # the four cells round a grid edge; edges of the lowest layer have none below, and bound the surface
        enough = (place[:, one] > 0) & (place[:, two] > 0)
        place, sign = place[enough], sign[enough]
        ring = []
        for step_one, step_two in ((-1, -1), (0, -1), (0, 0), (-1, 0)):
            cell = place.copy()
            cell[:, one] += step_one
            cell[:, two] += step_two
            keep = (cell < cells).all(axis=1)
            ring.append(np.where(keep, index[tuple(np.minimum(cell, cells - 1).T)], -1))
        quad = np.stack(ring, axis=1)
        quad[sign < 0] = quad[sign < 0][:, ::-1]
        quads.append(quad[(quad >= 0).all(axis=1)])
    vertices, quad = _without_corners(vertices, np.vstack(quads))
    vertices = _relaxed(implicit, vertices, quad, spacing)
    return vertices, _split(vertices, quad)


def _sampled_inside(implicit: Implicit, axes: list[Floats]) -> Booleans:
    """Which grid points are inside; blocks of the grid that the surface is far from are decided by their middle."""
    inside = np.zeros([len(axis) for axis in axes], dtype=bool)
    blocks = [np.arange(0, len(axis), _BLOCK) for axis in axes]
    spacing = axes[0][1] - axes[0][0]
    firsts = np.stack(np.meshgrid(*blocks, indexing="ij"), axis=-1).reshape(-1, 3)
    origin = np.array([axis[0] for axis in axes])
    value = implicit(origin + spacing * (firsts + 0.5 * (_BLOCK - 1)))
    near = np.abs(value) < spacing * _BLOCK  # a little more than half the diagonal of a block
    for i, j, k in firsts[~near & (value < 0)]:
        inside[i : i + _BLOCK, j : j + _BLOCK, k : k + _BLOCK] = True
    offsets = np.stack(np.meshgrid(*[np.arange(_BLOCK)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    for some in np.array_split(firsts[near], 1 + near.sum() // 200):
        points = (some[:, None] + offsets).reshape(-1, 3)
        points = points[(points < inside.shape).all(axis=1)]
        inside[tuple(points.T)] = implicit(origin + spacing * points) < 0
    return inside


def _without_ambiguous_faces(inside: Booleans) -> Booleans:
    """Grid points filled in until no grid face has its inner points on one diagonal only: two sheets would touch."""
    for _ in range(10):
        found = False
        for axis in range(3):
            planes = np.moveaxis(inside, axis, 0)  # a view: writing to it writes to `inside`
            a, b, c, d = planes[:, :-1, :-1], planes[:, :-1, 1:], planes[:, 1:, :-1], planes[:, 1:, 1:]
            fill_b = a & d & ~b & ~c
            fill_a = b & c & ~a & ~d
            found = found or bool(fill_a.any() or fill_b.any())
            b |= fill_b
            a |= fill_a
        if not found:
            break
    return inside


def _without_corners(vertices: Floats, quads: Integers) -> tuple[Floats, Integers]:
    """Without the quadrilaterals that are alone at a vertex of the rim: smoothing would flatten them there.

    The vertex opposite to that one goes to the rim, z = 0, instead.
    """
    edges = np.sort(quads[:, [[0, 1], [1, 2], [2, 3], [3, 0]]].reshape(-1, 2), axis=1)
    edges, uses = np.unique(edges, axis=0, return_counts=True)
    is_inner = np.ones(len(vertices), dtype=bool)
    is_inner[edges[uses == 1]] = False
    is_corner = (np.bincount(quads.ravel(), minlength=len(vertices)) == 1)[quads]
    opposite = quads[np.arange(len(quads)), (is_corner.argmax(axis=1) + 2) % 4]
    dropped = (is_corner.sum(axis=1) == 1) & is_inner[opposite]
    vertices[opposite[dropped], 2] = 0.0
    kept = np.unique(quads[~dropped])
    return vertices[kept], np.searchsorted(kept, quads[~dropped])


def _relaxed(implicit: Implicit, vertices: Floats, quads: Integers, spacing: float) -> Floats:
    """Vertices moved to the mean of their neighbours and back onto the surface; those on z = 0 stay on it."""
    edges = np.vstack([quads[:, [i, (i + 1) % 4]] for i in range(4)])
    edges = np.unique(np.sort(edges, axis=1), axis=0)
    count = np.bincount(edges.ravel(), minlength=len(vertices))
    rim = vertices[:, 2] < 0.25 * spacing
    rim_edges = edges[rim[edges].all(axis=1)]
    rim_count = np.maximum(np.bincount(rim_edges.ravel(), minlength=len(vertices)), 1)
    vertices = _project(implicit, vertices, rim)
    for step in range(_SMOOTHING_ROUNDS):
        mean = _neighbour_sum(vertices, edges) / count[:, None]
        rim_mean = _neighbour_sum(vertices, rim_edges) / rim_count[:, None]
        vertices = 0.4 * vertices + 0.6 * np.where(rim[:, None], rim_mean, mean)
        if step % 3 == 0:
            vertices = _project(implicit, vertices, rim)
    return vertices


def _neighbour_sum(vertices: Floats, edges: Integers) -> Floats:
    total = np.empty_like(vertices)
    for axis in range(3):
        total[:, axis] = np.bincount(edges[:, 0], vertices[edges[:, 1], axis], len(vertices))
        total[:, axis] += np.bincount(edges[:, 1], vertices[edges[:, 0], axis], len(vertices))
    return total


def _project(implicit: Implicit, points: Floats, rim: Booleans) -> Floats:
    step = 1e-5
    points[rim, 2] = 0.0
    moves = np.vstack([np.zeros((1, 3)), step * np.eye(3)])
    value = implicit((points[None] + moves[:, None]).reshape(-1, 3)).reshape(4, -1)
    gradient = (value[1:] - value[0]).T / step
    points = points - (value[0] / np.sum(gradient**2, axis=1))[:, None] * gradient
    points[rim, 2] = 0.0
    return points


def _split(vertices: Floats, quads: Integers) -> Integers:
    """Each quadrilateral into two triangles along the diagonal that leaves the larger of their smallest angles."""
    splits = quads[:, [[0, 1, 2], [0, 2, 3]]], quads[:, [[0, 1, 3], [1, 2, 3]]]
    one, two = (_smallest_angles(vertices[split.reshape(-1, 3)]).reshape(-1, 2).min(axis=1) for split in splits)
    # equal but for rounding in symmetric places: the first then, on every machine
    first = np.where((one >= two - 1e-9)[:, None, None], *splits)
    return np.ascontiguousarray(first.reshape(-1, 3))


def _smallest_angles(corners: Floats) -> Floats:
    """(m, 3, 3) corners -> (m,) smallest angle of each triangle, in radians."""
    edges = np.roll(corners, -1, axis=1) - corners
    back = -np.roll(edges, 1, axis=1)
    sine = np.linalg.norm(np.cross(edges, back), axis=2)
    found: Floats = np.arctan2(sine, np.einsum("mci,mci->mc", edges, back)).min(axis=1)
    return found
