"""How brushed triangles are marked in a view: a tint, and a double line round them that is seen on every colour."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import Any

import numpy as np
from vtkmodules.vtkCommonDataModel import vtkPolyData

from workbench.app.appearance.theme import BRUSH, BRUSH_CASING
from workbench.app.views.actors import THROUGH, cells, line_actor, surface_actor
from workbench.app.views.geometry import Geometry
from workbench.core.arrays import Integers
from workbench.core.solid_look.drawn_faces import DrawnFaces

TINT = 0.3
"""Opacity of the tint: what lies below it, the yellow of inverted triangles too, is still told apart."""
MOST_FRAMES = 200
"""Tetrahedra up to which the edges of all are drawn, also of those that lie inside."""


@dataclass(frozen=True, eq=False)
class BrushedPart:
    """What is marked, the same in every view: rows of the triangles (k,), edges round them (e, 2).

    `frames` (f, 2) are the edges of a few chosen tetrahedra, wherever they lie: these are seen through all that is before them.
    """

    rows: Integers
    outline: Integers
    frames: Integers


class BrushedParts:
    """Finds what is drawn of any set of simplices, and its outline; the table behind it is made at the first question."""

    def __init__(self, faces: DrawnFaces) -> None:
        self._faces = faces
        self._triangles = faces.triangles

    def part(self, simplices: Integers) -> BrushedPart:
        """The set of these simplices (k,); those that do not exist are left out.

        Its outline are the edges that belong to one triangle of the set only: lines inside it would hide its colours.
        """
        simplices = simplices[simplices < len(self._faces.corners)]
        rows, frames = self._faces.rows_of(simplices), self._frames(simplices)
        if not len(rows):
            return BrushedPart(rows, np.empty((0, 2), np.int64), frames)
        edges, edges_of_triangle = self._edge_table
        counts = np.bincount(edges_of_triangle[rows].ravel(), minlength=len(edges))
        return BrushedPart(rows, edges[counts == 1], frames)

    def _frames(self, simplices: Integers) -> Integers:
        """All edges (f, 2) of tetrahedra, as long as they can be told apart."""
        corners = self._faces.corners[simplices]
        if corners.shape[1] == 3 or len(simplices) > MOST_FRAMES:
            return np.empty((0, 2), np.int64)
        return np.concatenate([corners[:, list(ends)] for ends in combinations(range(4), 2)])

    @cached_property
    def _edge_table(self) -> tuple[Integers, Integers]:
        """Every edge once (e, 2), and which three each triangle has (m, 3)."""
        ends = np.stack([self._triangles, np.roll(self._triangles, -1, axis=1)], axis=2).reshape(-1, 2)
        ends.sort(axis=1)
        count = int(self._triangles.max(initial=0)) + 1
        keys, places = np.unique(ends[:, 0] * count + ends[:, 1], return_inverse=True)
        return np.stack([keys // count, keys % count], axis=1), places.reshape(-1, 3)


class BrushMark:
    """Marks a set of triangles of one `Geometry`, in place; it costs nothing while the set is empty."""

    def __init__(self, geometry: Geometry) -> None:
        self._geometry = geometry
        self._area, self._outline, self._frames = vtkPolyData(), vtkPolyData(), vtkPolyData()
        for part in (self._area, self._outline, self._frames):
            part.SetPoints(geometry.vtk_points)
        tint: Any = surface_actor(self._area, BRUSH, nearer=9.0)
        tint.GetProperty().SetOpacity(TINT)
        casing = line_actor(self._outline, BRUSH_CASING, 5.0, nearer=14.0)
        core = line_actor(self._outline, BRUSH, 2.2, nearer=17.0)
        self._frame_actor = line_actor(self._frames, BRUSH, 1.6, nearer=1.5 * THROUGH)
        self.actors = (tint, casing, core, self._frame_actor)

    def show(self, part: BrushedPart) -> None:
        """Mark these triangles, in place of those before."""
        for actor in self.actors[:3]:
            actor.SetVisibility(len(part.rows) > 0)
        self._frame_actor.SetVisibility(len(part.frames) > 0)
        if len(part.frames):
            self._frames.SetLines(cells(part.frames))
        if len(part.rows):
            self._area.SetPolys(cells(self._geometry.triangles[part.rows]))
            self._outline.SetLines(cells(part.outline))
