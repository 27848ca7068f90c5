"""What is drawn of a solid for a look at it: which tetrahedra, which of their faces."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from workbench.core.arrays import Booleans, Floats, Integers
from workbench.core.facets import facet_table, neighbouring_simplices
from workbench.core.mesh import Mesh
from workbench.core.solid_look.drawn_faces import DrawnFaces, drawn_faces, faces_between
from workbench.core.solid_look.look import VolumeLook
from workbench.core.solid_look.section import cut_faces
from workbench.core.solid_look.spread import spread_faces

MOST_SPREAD = 20_000
"""Tetrahedra up to which all are drawn when they are pulled apart."""
LAYERS = 2
"""Layers of them that are drawn beyond that."""


class Solid:
    """The tables of a tetrahedral mesh that drawing it needs, made once."""

    def __init__(self, mesh: Mesh, neighbours: Integers | None = None) -> None:
        """`neighbours` (m, 4) as `neighbouring_simplices` finds them, which is done here where they are not given."""
        self.mesh = mesh
        self.neighbours = neighbouring_simplices(facet_table(mesh.simplices)) if neighbours is None else neighbours

    @cached_property
    def boundary(self) -> DrawnFaces:
        """The whole solid."""
        return drawn_faces(self.mesh.simplices, self.neighbours)

    def visible(
        self, look: VolumeLook, values: NDArray[np.floating] | None, marked: Integers, heights: Floats | None
    ) -> Booleans:
        """Which tetrahedra (m,) are left.

        Parameters
        ----------
        values : (m,) float     of the quantity to peel by; None where they are not known yet
        marked : (k,) int64     brushed tetrahedra
        heights : (n,) float64  see `VolumeLook.heights`; None where no plane cuts
        """
        if look.threshold is None or values is None:
            visible = np.ones(self.mesh.simplex_count, dtype=bool)
        else:
            # what is inverted has no value that could be compared, and is what one looks for
            visible = ~(values < look.threshold)
        if look.only_marked and len(marked):
            chosen = np.zeros_like(visible)
            chosen[marked] = True
            visible &= chosen
        if heights is not None and not self._cuts_through(look):
            visible &= heights[self.mesh.simplices].sum(axis=1) < 0
        return visible

    @staticmethod
    def _cuts_through(look: VolumeLook) -> bool:
        """Tetrahedra that are pulled apart are drawn whole."""
        return look.is_exact and not look.spread > 0

    def _outer_layers(self, visible: Booleans) -> Booleans:
        """Of very many tetrahedra only those near the surface of the set: gaps between them show no deeper ones."""
        if np.count_nonzero(visible) <= MOST_SPREAD:
            return visible
        hidden = np.append(~visible, True)  # beyond the boundary, which -1 stands for, nothing is seen
        for _ in range(LAYERS):
            hidden[:-1] |= hidden[self.neighbours].any(axis=1)
        return np.asarray(hidden[:-1] & visible)

    def faces(
        self,
        look: VolumeLook,
        positions: Floats | None = None,
        values: NDArray[np.floating] | None = None,
        marked: Integers | None = None,
    ) -> DrawnFaces:
        """What is drawn: `positions` (n, 3) are those of the map, for a plane of the target."""
        if look.is_whole:
            return self.boundary
        mesh = self.mesh
        marked = np.empty(0, np.int64) if marked is None else marked
        plane_of = positions if look.cuts_target and positions is not None else mesh.vertices
        heights = look.heights(plane_of) if look.is_cut else None
        visible = self.visible(look, values, marked, heights)
        if look.spread > 0:
            visible = self._outer_layers(visible)
            return spread_faces(mesh.simplices, visible, look.spread, mesh.vertex_count)
        if heights is not None and self._cuts_through(look):
            return cut_faces(mesh.simplices, self.neighbours, heights, visible)
        return DrawnFaces(*faces_between(mesh.simplices, self.neighbours, visible), mesh.simplices)
