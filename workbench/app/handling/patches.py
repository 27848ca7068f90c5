"""Which whole patch of the boundary is meant by a pointer: a face of a solid, a side of a figure."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from workbench.app.views.camera import Pixel
from workbench.app.views.mesh_view import MeshView
from workbench.app.views.picking import segment_distances
from workbench.core.arrays import Integers
from workbench.core.boundary_sides import boundary_edges, boundary_sides
from workbench.core.mesh import Mesh
from workbench.core.solid_look.drawn_faces import drawn_faces
from workbench.core.surface_patch import surface_patches

REACH = 40.0
"""Pixels from a side of a figure at which it is meant."""


class Patches:
    """The patches of one mesh, between sharp edges (corners) of its source; found when first asked for."""

    def __init__(self, mesh: Mesh, neighbours: Integers | None) -> None:
        self._mesh = mesh
        self._neighbours = neighbours
        self.is_figure = mesh.vertices.shape[1] == 2

    @cached_property
    def _facets(self) -> tuple[Integers, Integers]:
        """Triangles (k, 3) or edges (k, 2), and the patch of each."""
        mesh = self._mesh
        if self.is_figure:
            edges = boundary_edges(mesh.simplices)
            return edges, boundary_sides(mesh.vertices, edges)
        triangles = drawn_faces(mesh.simplices, self._neighbours).triangles
        return triangles, surface_patches(mesh.vertices, triangles)

    def vertices_at(self, view: MeshView, pixel: Pixel) -> Integers:
        """Vertices (k,) of the patch under a pointer; none where there is none."""
        facets, labels = self._facets
        facet = self._nearest_edge(view, pixel, facets) if self.is_figure else self._triangle_at(view, pixel, facets)
        return np.empty(0, np.int64) if facet < 0 else np.unique(facets[labels == labels[facet]])

    @staticmethod
    def _triangle_at(view: MeshView, pixel: Pixel, triangles: Integers) -> int:
        """-1 also inside a solid that is cut open: there is no boundary there."""
        row = view.triangle_at(pixel)
        if row < 0 or view.geometry_shown is None:
            return -1
        corners = np.sort(view.geometry_shown.triangles[row])
        found = np.flatnonzero((np.sort(triangles, axis=1) == corners).all(axis=1))
        return int(found[0]) if len(found) else -1

    @staticmethod
    def _nearest_edge(view: MeshView, pixel: Pixel, edges: Integers) -> int:
        assert view.geometry_shown is not None
        ends = view.project(view.geometry_shown.points[edges.ravel()]).reshape(-1, 2, 2)
        away = segment_distances(ends, np.asarray(pixel))
        best = int(np.argmin(away)) if len(away) else -1
        return best if best >= 0 and away[best] <= REACH else -1
