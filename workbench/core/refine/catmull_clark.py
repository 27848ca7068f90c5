"""Catmull and Clark's scheme: faces become quadrilaterals, and the surface nears a smooth one (Catmull & Clark 1978)."""

from __future__ import annotations

import numpy as np
import scipy

from workbench.core.arrays import Integers
from workbench.core.refine.edge_table import edges_of_faces, weights_of_rows
from workbench.core.refine.smooth_boundary import at_vertices, neighbours


def catmull_clark_step(faces: Integers, vertex_count: int) -> tuple[Integers, scipy.sparse.csr_array]:
    """One level: a quadrilateral for each corner of each face.

    Parameters
    ----------
    faces : (m, k) int64      triangles or quadrilaterals

    Returns
    -------
    faces, weights : (k m, 4) int64, (n + e + m, n)     rows k i to k i + k - 1 are from face i: its corner, the edge after
    it, the middle of the face, the edge before it. Old vertices come first, then those of edges, then those of faces.

    Raises `MeshError` where an edge has more than two faces.
    """
    size = faces.shape[1]
    edges = edges_of_faces(faces, vertex_count)
    is_boundary = edges.boundary_edges()
    centres = weights_of_rows(faces, np.full(faces.shape, 1.0 / size), vertex_count)
    faces_at = np.bincount(faces.ravel(), minlength=vertex_count).astype(np.float64)
    count = np.maximum(faces_at, 1.0)
    face_of_side = np.repeat(np.arange(len(faces)), size)
    ones = np.ones(faces.size)
    at = scipy.sparse.csr_array((ones, (faces.ravel(), face_of_side)), shape=(vertex_count, len(faces)))
    beside = scipy.sparse.csr_array((ones, (edges.numbers.ravel(), face_of_side)), shape=(edges.edge_count, len(faces)))
    # inside, with n faces: (mean of the face points + 2 mean of the edges' middles + (n - 3) itself) / n
    around = neighbours(edges)
    own = (count - 2.0) / count
    others = scipy.sparse.diags_array(1.0 / count**2) @ (at @ centres + around)
    old = at_vertices(edges, is_boundary, own, others, faces_at)
    inside = 0.5 * edges.midpoints() + 0.25 * (beside @ centres)
    is_inside = scipy.sparse.diags_array((~is_boundary).astype(np.float64))
    middle = is_inside @ inside + scipy.sparse.diags_array(is_boundary.astype(np.float64)) @ edges.midpoints()
    after = edges.numbers + vertex_count
    centre = np.broadcast_to(vertex_count + edges.edge_count + np.arange(len(faces))[:, None], faces.shape)
    children = np.stack([faces, after, centre, np.roll(after, 1, axis=1)], axis=2).reshape(-1, 4)
    return children, scipy.sparse.csr_array(scipy.sparse.vstack([old, middle, centres]))


def split_quadrilaterals(quadrilaterals: Integers) -> Integers:
    """(2 m, 3): each along the diagonal from its first corner, as readers fan a polygon; the same in source and map."""
    return quadrilaterals[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
