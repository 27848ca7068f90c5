"""Which way what is drawn faces, at some of its vertices."""

from __future__ import annotations

import numpy as np

from workbench.app.views.camera import Points
from workbench.core.arrays import Booleans, Floats, Integers


def mean_normal(points: Points, triangles: Integers, vertices: Integers) -> Floats | None:
    """(3,) the mean normal of the triangles that lie in a set of vertices, or, where none does, touch it.

    Weighted by area; None where they cancel out, or there are none.
    """
    belongs = np.zeros(len(points), dtype=bool)
    belongs[vertices] = True
    corners = belongs[triangles]
    chosen = corners.all(axis=1)
    if not chosen.any():
        chosen = corners.any(axis=1)
    a, b, c = np.moveaxis(np.asarray(points, dtype=np.float64)[triangles[chosen]], 1, 0)
    doubled = np.cross(b - a, c - a)
    total = doubled.sum(axis=0)
    length = float(np.linalg.norm(total))
    if not length > 1e-9 * float(np.linalg.norm(doubled, axis=1).sum() or 1.0):
        return None
    return np.asarray(total / length)


def faces_away(points: Points, triangles: Integers, vertices: Integers, sight: Floats) -> Booleans:
    """(k,) whether no drawn triangle at each of `vertices` (k,) faces the eye: those at the back of a solid, or inside.

    `sight` : (3,) float64, towards the eye
    """
    row = np.full(len(points), -1, dtype=np.int64)
    row[vertices] = np.arange(len(vertices))
    corners = row[triangles]
    touching = (corners >= 0).any(axis=1)
    corners = corners[touching]
    a, b, c = np.moveaxis(np.asarray(points, dtype=np.float64)[triangles[touching]], 1, 0)
    is_front = np.cross(b - a, c - a) @ sight > 0.0
    away = np.ones(len(vertices) + 1, dtype=bool)
    away[corners[is_front]] = False  # the last entry stands for the vertices that nobody asked about
    return away[:-1]
