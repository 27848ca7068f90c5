"""A mesh as a graph of its edges: shortest paths along them, and what is near."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from workbench.core.arrays import Floats, Integers


@dataclass(frozen=True, eq=False)
class EdgeGraph:
    """Edges between vertices (n, 2|3), with their lengths.

    Parameters
    ----------
    vertices : (n, 2|3) float64
    simplices : (m, k) int64     edges, triangles or tetrahedra; every pair of corners is an edge
    """

    vertices: Floats
    simplices: Integers

    @cached_property
    def edges(self) -> Integers:
        """(e, 2) int64, each once, the smaller vertex first"""
        from workbench.core.refine.edge_table import edges_of_faces, edges_of_tetrahedra

        table = edges_of_tetrahedra if self.simplices.shape[1] == 4 else edges_of_faces
        return table(self.simplices, len(self.vertices)).ends

    @cached_property
    def lengths(self) -> Floats:
        """(e,) float64"""
        a, b = self.edges.T
        return np.asarray(np.linalg.norm(self.vertices[a] - self.vertices[b], axis=1))

    @cached_property
    def _matrix(self) -> scipy.sparse.csr_array:
        a, b = self.edges.T
        # a length of 0 would count as no edge
        lengths = np.maximum(self.lengths, np.finfo(np.float64).tiny)
        return scipy.sparse.csr_array((lengths, (a, b)), shape=(len(self.vertices),) * 2)

    def distances(self, starts: Integers) -> Floats:
        """(n,) length of the shortest path along edges from the nearest of `starts` (k,); inf where there is none."""
        found: Floats = scipy.sparse.csgraph.dijkstra(self._matrix, directed=False, indices=starts, min_only=True)
        return found

    def nearest(self, starts: Integers) -> Integers:
        """(n,) int64: the one of `starts` (k,) that is nearest along edges; -1 where none can be reached."""
        found = scipy.sparse.csgraph.dijkstra(
            self._matrix, directed=False, indices=starts, min_only=True, return_predecessors=True
        )[2]
        return np.where(found < 0, -1, found).astype(np.int64)

    def paths_from(self, start: int) -> PathTree:
        """Shortest paths from one vertex to all others."""
        before = scipy.sparse.csgraph.dijkstra(self._matrix, directed=False, indices=start, return_predecessors=True)[1]
        return PathTree(start, before.astype(np.int64))


@dataclass(frozen=True, eq=False)
class PathTree:
    """Shortest paths along edges from `start`; `before` (n,) is the vertex before each, negative where there is none."""

    start: int
    before: Integers

    def to(self, end: int) -> Integers:
        """(k,) int64: vertices from the start to `end`, both among them; none where no path leads there."""
        path = [end]
        while path[-1] != self.start:
            previous = int(self.before[path[-1]])
            if previous < 0:
                return np.empty(0, np.int64)
            path.append(previous)
        return np.array(path[::-1], dtype=np.int64)
