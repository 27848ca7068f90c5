"""Which triangles are drawn of a mesh: its own, or faces of its tetrahedra, between vertices and points made from them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from workbench.core.arrays import Booleans, Integers, Points
from workbench.core.facets import facet_table, neighbouring_simplices

SIDES = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]], dtype=np.int64)
"""Corners of the face opposite each corner of a tetrahedron, counter-clockwise seen from outside."""


class MadePoints(Protocol):
    """Points that follow from the vertices, wherever those are.

    `vertices` : (e,) int64     the vertex that each stands for when it is pointed at
    """

    @property
    def vertices(self) -> Integers: ...

    def at(self, points: Points) -> Points:
        """(n, 3) of the vertices -> (e, 3)."""
        ...


@dataclass(frozen=True, eq=False)
class DrawnFaces:
    """Triangles to draw.

    Attributes
    ----------
    triangles : (k, 3) int64    rows of the vertices, then of the points that are made of them
    simplices : (k,) int64      simplex that each triangle belongs to; None: triangle i is simplex i
    corners : (m, n+1) int64    where the corners of each simplex are drawn
    made : MadePoints           None where triangles lie between vertices
    """

    triangles: Integers
    simplices: Integers | None
    corners: Integers
    made: MadePoints | None = None

    def rows_of(self, simplices: Integers) -> Integers:
        """Rows (r,) of the triangles that are drawn of these simplices (k,), ascending for volumes."""
        if self.simplices is None:
            return simplices
        return np.flatnonzero(self._mask(simplices)[self.simplices])

    def all_sides(self, simplices: Integers) -> Integers:
        """(r, 3): triangles, or all four faces of tetrahedra, seen or not."""
        corners = self.corners[simplices]
        return corners if corners.shape[1] == 3 else corners[:, SIDES].reshape(-1, 3)

    def simplex_of(self, row: int) -> int:
        """Simplex of a triangle, -1 for -1."""
        return row if self.simplices is None or row < 0 else int(self.simplices[row])

    def vertex_of(self, point: int, vertex_count: int) -> int:
        """Vertex that a point stands for, -1 for -1."""
        return point if self.made is None or point < vertex_count else int(self.made.vertices[point - vertex_count])

    def _mask(self, simplices: Integers) -> Booleans:
        chosen = np.zeros(len(self.corners), dtype=bool)
        chosen[simplices] = True
        return chosen


def faces_between(simplices: Integers, neighbours: Integers, visible: Booleans | None = None) -> tuple[Integers, Integers]:
    """Faces of visible tetrahedra beyond which nothing visible lies: all that can be seen of them.

    Parameters
    ----------
    simplices : (m, 4) int64, neighbours : (m, 4) int64     see `neighbouring_simplices`
    visible : (m,) bool         all where it is not given

    Returns
    -------
    triangles, owners : (k, 3) int64, (k,) int64      facing outwards
    """
    if visible is None:
        is_open = neighbours < 0
    else:
        # -1 finds the last entry: nothing is seen beyond the boundary
        is_open = ~np.append(visible, False)[neighbours]
        is_open &= visible[:, None]
    sides = np.flatnonzero(is_open)
    owners = sides // 4
    return np.take_along_axis(simplices[owners], SIDES[sides % 4], axis=1), owners


def drawn_faces(simplices: Integers, neighbours: Integers | None = None) -> DrawnFaces:
    """What is drawn of a whole mesh: its triangles (m, 3), or the boundary of its tetrahedra (m, 4)."""
    if simplices.shape[1] == 3:
        return DrawnFaces(simplices, None, simplices)
    if neighbours is None:
        neighbours = neighbouring_simplices(facet_table(simplices))
    triangles, owners = faces_between(simplices, neighbours)
    return DrawnFaces(triangles, owners, simplices)
