"""A solid pulled apart: every tetrahedron moves away from the middle as a whole, and all is drawn smaller to fit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from workbench.core.arrays import Booleans, Integers, Points
from workbench.core.solid_look.drawn_faces import SIDES, DrawnFaces


@dataclass(frozen=True, eq=False)
class SpreadCorners:
    """The corners of tetrahedra (v, 4) whose centroids have gone `spread` times as far again, drawn 1 + `spread` times smaller.

    Centroids thus stay where they were on the screen, and the view need not be fitted anew.
    """

    simplices: Integers
    spread: float

    @property
    def vertices(self) -> Integers:
        return self.simplices.ravel()

    def at(self, points: Points) -> Points:
        corners = points[self.simplices]
        centroids = 0.25 * (corners[:, :1] + corners[:, 1:2] + corners[:, 2:3] + corners[:, 3:])
        corners -= centroids
        corners *= np.float32(1.0 / (1.0 + self.spread))
        corners += centroids
        return np.asarray(corners).reshape(-1, 3)


def spread_faces(simplices: Integers, visible: Booleans, spread: float, vertex_count: int) -> DrawnFaces:
    """All four faces of each tetrahedron (m, 4) that is visible (m,), pulled apart; `vertex_count` is that of the mesh."""
    chosen = np.flatnonzero(visible)
    corners = simplices.copy()
    corners[chosen] = vertex_count + np.arange(4 * len(chosen)).reshape(-1, 4)
    triangles = corners[chosen][:, SIDES].reshape(-1, 3)
    return DrawnFaces(triangles, np.repeat(chosen, 4), corners, SpreadCorners(simplices[chosen], spread))
