"""The patch of a surface round a triangle, up to where the surface bends sharply."""

from __future__ import annotations

import numpy as np
import scipy

from workbench.core.arrays import Floats, Integers
from workbench.core.facets import facet_table

SHARP = 30.0
"""Degrees between the normals of two neighbours from which on the edge between them is sharp."""


def surface_patches(positions: Floats, triangles: Integers, sharp: float = SHARP) -> Integers:
    """Label (k,) of the patch that each triangle belongs to: two neighbours are in one unless they meet at a sharp edge.

    Parameters
    ----------
    positions : (n, 2|3) float64
    triangles : (k, 3) int64      consistently oriented where they meet
    sharp : float                 degrees between normals

    Triangles without an area have no normal, and join no others. Where more than two triangles meet, none are joined.
    """
    table = facet_table(triangles)
    sides = table.pairs[table.pair_counts == 2]
    neighbours = sides // 3
    space = positions if positions.shape[1] == 3 else np.pad(positions, ((0, 0), (0, 1)))
    corners = space[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    with np.errstate(invalid="ignore", divide="ignore"):
        normals /= lengths[:, None]
    cosines = np.einsum("ij,ij->i", normals[neighbours[:, 0]], normals[neighbours[:, 1]])
    joined = neighbours[cosines > np.cos(np.radians(sharp))]  # a NaN joins nothing
    count = len(triangles)
    links = scipy.sparse.coo_array((np.ones(len(joined)), (joined[:, 0], joined[:, 1])), shape=(count, count))
    labels: Integers = scipy.sparse.csgraph.connected_components(links, directed=False)[1].astype(np.int64)
    return labels
