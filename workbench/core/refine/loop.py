"""Loop's scheme: triangles become four, and the surface nears a smooth one (Loop 1987)."""

from __future__ import annotations

import numpy as np
import scipy

from workbench.core.arrays import Floats, Integers
from workbench.core.refine.edge_table import edges_of_faces, weights_of_rows
from workbench.core.refine.linear import quarter
from workbench.core.refine.smooth_boundary import at_vertices, neighbours


def loop_step(triangles: Integers, vertex_count: int) -> tuple[Integers, scipy.sparse.csr_array]:
    """One level: four triangles for each, as `halve_triangles` makes them.

    Returns
    -------
    triangles, weights : (4 m, 3) int64, (n + e, n)     new vertices as averages of the old ones, which come first

    Raises `MeshError` where an edge has more than two triangles.
    Source: Loop, Smooth subdivision surfaces based on triangles, 1987; at the boundary Hoppe et al. 1994.
    libigl has the scheme too, with other weights, but it moves vertices that are in no triangle, and holds the
    interpreter lock, which would stop the window.
    """
    edges = edges_of_faces(triangles, vertex_count)
    is_boundary = edges.boundary_edges()
    around = neighbours(edges)
    valence = np.diff(around.indptr).astype(np.float64)
    share = ring_weights(valence)
    faces = np.bincount(triangles.ravel(), minlength=vertex_count).astype(np.float64)
    old = at_vertices(edges, is_boundary, 1.0 - valence * share, scipy.sparse.diags_array(share) @ around, faces)
    # an edge inside: 3/8 of its ends and 1/8 of the corners across it
    opposite = np.roll(triangles, 1, axis=1)
    across = scipy.sparse.coo_array(
        (np.full(triangles.size, 0.125), (edges.numbers.ravel(), opposite.ravel())), shape=(edges.edge_count, vertex_count)
    )
    inside = weights_of_rows(edges.ends, np.full(edges.ends.shape, 0.375), vertex_count) + across
    is_inside = scipy.sparse.diags_array((~is_boundary).astype(np.float64))
    middle = is_inside @ inside + scipy.sparse.diags_array(is_boundary.astype(np.float64)) @ edges.midpoints()
    return quarter(triangles, edges), scipy.sparse.csr_array(scipy.sparse.vstack([old, middle]))


def ring_weights(valence: Floats) -> Floats:
    """Loop's weight of each neighbour of an inner vertex with that many of them, (n,)."""
    count = np.maximum(valence, 1.0)
    return (0.625 - (0.375 + 0.25 * np.cos(2.0 * np.pi / count)) ** 2) / count
