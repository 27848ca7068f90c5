"""How brushed triangles are marked in a view: a tint, and a double line round them that is seen on every colour."""

from __future__ import annotations

from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkPolyData

from workbench.app.theme import BRUSH, BRUSH_CASING
from workbench.app.views.actors import cells, line_actor, surface_actor
from workbench.app.views.geometry import Geometry
from workbench.core.arrays import Integers

TINT = 0.3
"""Opacity of the tint: what lies below it, the yellow of inverted triangles too, is still told apart."""


class BrushMark:
    """Marks a set of triangles of one `Geometry`, in place; it costs nothing while the set is empty."""

    def __init__(self, geometry: Geometry) -> None:
        self._geometry = geometry
        self._table: tuple[Integers, Integers] | None = None
        self._area, self._outline = vtkPolyData(), vtkPolyData()
        for part in (self._area, self._outline):
            part.SetPoints(geometry.vtk_points)
        tint: Any = surface_actor(self._area, BRUSH, nearer=9.0)
        tint.GetProperty().SetOpacity(TINT)
        casing = line_actor(self._outline, BRUSH_CASING, 5.0, nearer=14.0)
        core = line_actor(self._outline, BRUSH, 2.2, nearer=17.0)
        self.actors = (tint, casing, core)

    def show(self, triangles: Integers) -> None:
        """Mark these rows (k,) of the triangles; those that do not exist are left out."""
        rows = triangles[triangles < len(self._geometry.triangles)]
        for actor in self.actors:
            actor.SetVisibility(len(rows) > 0)
        if len(rows):
            self._area.SetPolys(cells(self._geometry.triangles[rows]))
            self._outline.SetLines(cells(self._edges_round(rows)))

    def _edges_round(self, rows: Integers) -> Integers:
        """Edges (e, 2) that belong to one triangle of the set only: lines inside it would hide its colours."""
        if self._table is None:
            self._table = _edge_table(self._geometry.triangles)
        edges, edges_of_triangle = self._table
        counts = np.bincount(edges_of_triangle[rows].ravel(), minlength=len(edges))
        return edges[counts == 1]


def _edge_table(triangles: Integers) -> tuple[Integers, Integers]:
    """Every edge once (e, 2), and which three each triangle has (m, 3)."""
    ends = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2)
    ends.sort(axis=1)
    count = int(triangles.max(initial=0)) + 1
    keys, places = np.unique(ends[:, 0] * count + ends[:, 1], return_inverse=True)
    return np.stack([keys // count, keys % count], axis=1), places.reshape(-1, 3)
