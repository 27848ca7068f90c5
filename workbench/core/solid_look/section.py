"""The exact section of tetrahedra with a plane, as triangles between points on edges."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from workbench.core.arrays import Booleans, Floats, Integers, Points
from workbench.core.solid_look.drawn_faces import DrawnFaces, faces_between


@dataclass(frozen=True, eq=False)
class EdgePoints:
    """Points that divide edges in a fixed ratio, wherever the ends are.

    `first`, `second` : (e,) int64 ends;  `share` : (e,) float32, 0 at the first, 1 at the second
    """

    first: Integers
    second: Integers
    share: Floats

    @property
    def vertices(self) -> Integers:
        """(e,) the nearer end along the edge."""
        return np.where(self.share < 0.5, self.first, self.second)

    def at(self, points: Points) -> Points:
        begin = points[self.first]
        return np.asarray(begin + self.share[:, None] * (points[self.second] - begin))


class _Edges:
    """Collects triangles whose corners are vertices or points where the heights of an edge change sign."""

    def __init__(self, heights: Floats) -> None:
        self._heights = heights
        self._firsts: list[Integers] = []
        self._seconds: list[Integers] = []
        self._count = 0
        self.triangles: list[Integers] = []
        self.owners: list[Integers] = []

    def between(self, first: Integers, second: Integers) -> Integers:
        """Numbers (r,) of the points on these edges, after the vertices."""
        self._firsts.append(first)
        self._seconds.append(second)
        self._count += len(first)
        return len(self._heights) + np.arange(self._count - len(first), self._count)

    def add(self, owners: Integers, *corners: Integers) -> None:
        """Triangles, or convex polygons of more corners, each (r,), one a simplex of `owners` (r,)."""
        for i in range(1, len(corners) - 1):
            self.triangles.append(np.stack([corners[0], corners[i], corners[i + 1]], axis=1))
            self.owners.append(owners)

    def made(self) -> EdgePoints:
        first, second = np.concatenate(self._firsts), np.concatenate(self._seconds)
        low, high = self._heights[first], self._heights[second]
        return EdgePoints(first, second, (low / (low - high)).astype(np.float32))


def cut_faces(simplices: Integers, neighbours: Integers, heights: Floats, visible: Booleans) -> DrawnFaces:
    """What is left of visible tetrahedra below a plane: their faces, cut off at it, and the section itself.

    Parameters
    ----------
    simplices, neighbours : (m, 4) int64
    heights : (n,) float64      of the vertices above the plane; what is above is taken away
    visible : (m,) bool

    Cost: one pass over the simplices; the rest goes with what is drawn.
    """
    below = heights < 0
    counts = below[simplices].sum(axis=1)
    kept = visible & (counts > 0)
    edges = _Edges(heights)
    _cut_triangles(edges, *faces_between(simplices, neighbours, kept), below)
    crossing = np.flatnonzero(kept & (counts < 4))
    _cut_tetrahedra(edges, simplices[crossing], crossing, below)
    return DrawnFaces(np.concatenate(edges.triangles), np.concatenate(edges.owners), simplices, edges.made())


def _cut_triangles(edges: _Edges, triangles: Integers, owners: Integers, below: Booleans) -> None:
    is_below = below[triangles]
    counts = is_below.sum(axis=1)
    edges.add(owners[counts == 3], *triangles[counts == 3].T)
    for count in (1, 2):
        rows = np.flatnonzero(counts == count)
        # the corner that is alone on its side comes first; turning a triangle round keeps its orientation
        alone = np.argmax(is_below[rows] == (count == 1), axis=1)
        a, b, c = (triangles[rows, (alone + i) % 3] for i in range(3))
        ab, ac = edges.between(a, b), edges.between(a, c)
        if count == 1:
            edges.add(owners[rows], a, ab, ac)
        else:
            edges.add(owners[rows], b, c, ac, ab)


def _cut_tetrahedra(edges: _Edges, simplices: Integers, owners: Integers, below: Booleans) -> None:
    is_below = below[simplices]
    counts = is_below.sum(axis=1)
    for count in (1, 3):
        rows = np.flatnonzero(counts == count)
        alone = np.argmax(is_below[rows] == (count == 1), axis=1)
        a, *others = (simplices[rows, (alone + i) % 4] for i in range(4))
        edges.add(owners[rows], *(edges.between(a, other) for other in others))
    rows = np.flatnonzero(counts == 2)
    order = np.argsort(~is_below[rows], axis=1, kind="stable")
    a, b, c, d = np.take_along_axis(simplices[rows], order, axis=1).T
    edges.add(owners[rows], *(edges.between(*ends) for ends in ((a, c), (a, d), (b, d), (b, c))))
