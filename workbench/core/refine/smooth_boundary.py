"""What the smooth schemes share: at the boundary both make the cubic B-spline of the boundary curve."""

from __future__ import annotations

import numpy as np
import scipy

from workbench.core.arrays import Booleans, Floats
from workbench.core.refine.edge_table import EdgeTable


def neighbours(edges: EdgeTable, among: Booleans | None = None) -> scipy.sparse.csr_array:
    """(n, n) ones: vertices joined by an edge, or by one of the edges `among` (e,)."""
    ends = edges.ends if among is None else edges.ends[among]
    size = edges.vertex_count
    half = scipy.sparse.coo_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(size, size))
    return scipy.sparse.csr_array(half + half.T)


def at_vertices(
    edges: EdgeTable, is_boundary: Booleans, own: Floats, others: scipy.sparse.csr_array, faces: Floats
) -> scipy.sparse.csr_array:
    """(n, n) weights of the old vertices in their new places.

    Parameters
    ----------
    is_boundary : (e,) bool
    own, others : (n,), (n, n)     rule inside: new = own * old + others @ old
    faces : (n,)                   how many faces meet at each vertex

    On the boundary a vertex takes 3/4 of itself and 1/8 of both neighbours along it. Vertices in no face, and those where
    more than one boundary curve passes, stay where they are.
    """
    along = neighbours(edges, is_boundary)
    boundary_valence = np.bincount(edges.ends[is_boundary].ravel(), minlength=edges.vertex_count)
    is_inside = (boundary_valence == 0) & (faces > 0)
    is_on_curve = boundary_valence == 2
    kept = np.where(is_inside, own, np.where(is_on_curve, 0.75, 1.0))
    return scipy.sparse.csr_array(
        scipy.sparse.diags_array(kept)
        + scipy.sparse.diags_array(is_inside.astype(np.float64)) @ others
        + scipy.sparse.diags_array(np.where(is_on_curve, 0.125, 0.0)) @ along
    )
