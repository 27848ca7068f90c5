"""The normal of what is drawn, at some of its vertices."""

from __future__ import annotations

import numpy as np

from workbench.app.views.camera import Points
from workbench.core.arrays import Floats, Integers


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
