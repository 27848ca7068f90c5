"""Linear refinement: every edge is halved, triangles become four, tetrahedra eight; the shape stays (Theorem 9.1)."""

from __future__ import annotations

import numpy as np
import scipy

from workbench.core.arrays import Floats, Integers
from workbench.core.refine.edge_table import EdgeTable, edges_of_faces, edges_of_tetrahedra

# Middles of the edges 01, 02, 03, 12, 13, 23 are named 4 to 9: at each corner a half-size copy of the tetrahedron ...
CORNERS = ((0, 4, 5, 6), (4, 1, 7, 8), (5, 7, 2, 9), (6, 8, 9, 3))
# ... and between them an octahedron, which four tetrahedra round one of its three diagonals fill.
DIAGONALS = ((4, 9), (5, 8), (6, 7))
AROUND = (
    ((4, 9, 5, 6), (4, 9, 6, 8), (4, 9, 8, 7), (4, 9, 7, 5)),
    ((5, 8, 6, 4), (5, 8, 9, 6), (5, 8, 7, 9), (5, 8, 4, 7)),
    ((6, 7, 4, 5), (6, 7, 5, 9), (6, 7, 9, 8), (6, 7, 8, 4)),
)


def halve_triangles(triangles: Integers, vertex_count: int) -> tuple[Integers, scipy.sparse.csr_array]:
    """Four triangles for each, rows 4 i to 4 i + 3 from triangle i, oriented as it is.

    Returns
    -------
    triangles, weights : (4 m, 3) int64, (n + e, n)     new vertices as averages of the old ones, which come first
    """
    edges = edges_of_faces(triangles, vertex_count)
    return quarter(triangles, edges), _with_midpoints(edges)


def halve_tetrahedra(tetrahedra: Integers, vertices: Floats) -> tuple[Integers, scipy.sparse.csr_array]:
    """Eight tetrahedra for each, rows 8 i to 8 i + 7 from tetrahedron i, oriented as it is.

    The octahedron in the middle is split along its shortest diagonal in `vertices`, the first of those as short: this keeps
    the shapes from worsening level by level, and no neighbour sees it.

    Returns
    -------
    tetrahedra, weights : (8 m, 4) int64, (n + e, n)     as for triangles
    """
    edges = edges_of_tetrahedra(tetrahedra, len(vertices))
    weights = _with_midpoints(edges)
    names = np.concatenate([tetrahedra, edges.numbers + len(vertices)], axis=1)
    points = weights @ vertices
    ends = points[names[:, DIAGONALS]]
    lengths = np.linalg.norm(ends[:, :, 1] - ends[:, :, 0], axis=2)
    inner = np.array(AROUND)[lengths.argmin(axis=1)]
    local = np.concatenate([np.broadcast_to(np.array(CORNERS), inner.shape), inner], axis=1)
    children = np.take_along_axis(names, local.reshape(len(names), -1), axis=1)
    return children.reshape(-1, 4), weights


def quarter(triangles: Integers, edges: EdgeTable) -> Integers:
    """(4 m, 3): the three corners of each triangle, then its middle; vertex n + k lies on edge k."""
    a, b, c = triangles.T
    ab, bc, ca = (edges.numbers + edges.vertex_count).T
    children = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1)
    return np.ascontiguousarray(children.reshape(-1, 3))


def _with_midpoints(edges: EdgeTable) -> scipy.sparse.csr_array:
    return scipy.sparse.vstack([scipy.sparse.eye_array(edges.vertex_count, format="csr"), edges.midpoints()], format="csr")
