"""Shapes that show a Jacobian at a place: lines along its principal stretches, images of circles and of balls."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from workbench.core.arrays import Floats, Integers, Points

CORNERS = 28
"""Of the polygon that stands for an ellipse."""
ROUNDS = 2
"""How often an octahedron is refined to stand for a ball."""


def stretch_lines(centres: Points, axes: Points) -> Points:
    """Centres (k, d), half axes (k, n, d) -> (k, n, 2, d): both ends of each axis."""
    middle = centres[:, None, :]
    return np.stack([middle - axes, middle + axes], axis=2)


def ellipses(centres: Points, axes: Points) -> Points:
    """Centres (k, d), two half axes (k, 2, d) -> (k, `CORNERS`, d): the ellipse through their ends, once round."""
    angles = np.linspace(0.0, 2.0 * np.pi, CORNERS, endpoint=False)
    weights = np.stack([np.cos(angles), np.sin(angles)], axis=1).astype(axes.dtype)
    return np.asarray(centres[:, None, :] + weights @ axes)


def ellipsoids(centres: Points, axes: Points) -> tuple[Points, Points]:
    """Centres (k, 3), three half axes (k, 3, 3) -> points and unit normals (k, p, 3), p as in `ball`.

    Where an axis vanishes the normals are those of the flat shape.
    """
    directions = ball()[0].astype(axes.dtype)
    points = centres[:, None, :] + directions @ axes
    squares = np.maximum((axes**2).sum(axis=2, keepdims=True), 1e-20)
    normals = directions @ (axes / squares)
    lengths = np.linalg.norm(normals, axis=2, keepdims=True)
    return points, normals / np.where(lengths > 0, lengths, 1.0)


@lru_cache(maxsize=1)
def ball() -> tuple[Floats, Integers]:
    """Points (p, 3) on the unit sphere and the triangles (t, 3) between them, facing outwards."""
    points = [np.array(p, dtype=float) for p in ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1))]
    triangles = [(x, y, z) for x in (0, 1) for y in (2, 3) for z in (4, 5)]
    triangles = [t if np.linalg.det([points[i] for i in t]) > 0 else (t[0], t[2], t[1]) for t in triangles]
    for _ in range(ROUNDS):
        middles: dict[tuple[int, int], int] = {}
        finer = []
        for corners in triangles:
            between = []
            for i in range(3):
                ends = (min(corners[i], corners[i - 2]), max(corners[i], corners[i - 2]))
                if ends not in middles:
                    middle = points[ends[0]] + points[ends[1]]
                    middles[ends] = len(points)
                    points.append(middle / np.linalg.norm(middle))
                between.append(middles[ends])
            a, b, c = corners
            ab, bc, ca = between
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = finer
    return np.array(points), np.array(triangles, dtype=np.int64)
