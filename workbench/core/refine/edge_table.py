"""The edges of triangles, quadrilaterals or tetrahedra, each once."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np
import scipy

from workbench.core.arrays import Booleans, Floats, Integers
from workbench.core.errors import MeshError


@dataclass(frozen=True, eq=False)
class EdgeTable:
    """Attributes
    ----------
    ends : (e, 2) int64        vertices of each edge, ascending
    numbers : (m, k) int64     edge of each side of each cell: sides in the order of `edges_of_faces`, `edges_of_tetrahedra`
    counts : (e,) int64        cells at each edge
    vertex_count : int
    """

    ends: Integers
    numbers: Integers
    counts: Integers
    vertex_count: int

    @property
    def edge_count(self) -> int:
        return len(self.ends)

    def midpoints(self) -> scipy.sparse.csr_array:
        """(e, n) weights: the middle of each edge."""
        return weights_of_rows(self.ends, np.full(self.ends.shape, 0.5), self.vertex_count)

    def boundary_edges(self) -> Booleans:
        """(e,) bool: edges of one face. Raises `MeshError` where an edge has more than two, or one vertex only."""
        if (self.ends[:, 0] == self.ends[:, 1]).any():
            raise MeshError("A triangle names the same vertex twice; use the linear scheme, or mend the mesh.")
        if self.counts.max(initial=0) > 2:
            tail, head = self.ends[int(self.counts.argmax())]
            raise MeshError(
                f"The edge between vertices {tail} and {head} (from 0) has more than two triangles, where smooth schemes "
                f"have no rule; use the linear scheme, or mend the mesh."
            )
        return self.counts == 1


def edges_of_faces(faces: Integers, vertex_count: int) -> EdgeTable:
    """Sides j of each face (m, 3|4) run from its corner j to the next."""
    return _edge_table(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2), vertex_count)


def edges_of_tetrahedra(tetrahedra: Integers, vertex_count: int) -> EdgeTable:
    """Sides of each tetrahedron (m, 4) in the order 01, 02, 03, 12, 13, 23 of its corners."""
    return _edge_table(tetrahedra[:, list(combinations(range(4), 2))], vertex_count)


def weights_of_rows(columns: Integers, weights: Floats, column_count: int) -> scipy.sparse.csr_array:
    """(r, column_count) sparse: row i has `weights[i]` at `columns[i]`, both (r, k)."""
    rows, width = columns.shape
    starts = np.arange(rows + 1) * width
    # a copy: sparse matrices sort their indices in place when it suits them
    return scipy.sparse.csr_array((weights.ravel(), columns.ravel(), starts), shape=(rows, column_count), copy=True)


def _edge_table(sides: Integers, vertex_count: int) -> EdgeTable:
    low, high = sides.min(axis=2), sides.max(axis=2)
    keys, numbers, counts = np.unique((low * vertex_count + high).ravel(), return_inverse=True, return_counts=True)
    ends = np.column_stack(np.divmod(keys, vertex_count))
    return EdgeTable(ends, numbers.reshape(low.shape).astype(np.int64), counts.astype(np.int64), vertex_count)
