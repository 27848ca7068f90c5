"""Seams: edges across which the texture coordinates of a file jump."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Booleans
from workbench.core.facets import FacetTable
from workbench.core.mesh import TextureCoordinates


def seam_pairs(texture: TextureCoordinates, table: FacetTable) -> Booleans:
    """Pairs of neighbouring triangles whose texture coordinates differ at an end of their shared edge, (p,) bool.

    Coordinates are compared, not their numbers: many writers repeat equal coordinates for each face.
    """
    _, value = np.unique(texture.coordinates, axis=0, return_inverse=True)
    corner_value = value.reshape(-1)[texture.corners.ravel()]
    left, right = table.corners[table.pairs[:, 0]], table.corners[table.pairs[:, 1]]
    return np.asarray((corner_value[left] != corner_value[right]).any(axis=1))
