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
    as_numbers = texture.coordinates.view(np.complex128).ravel()  # one complex number a row sorts faster than rows
    _, value = np.unique(as_numbers, return_inverse=True)
    corner_value = value[texture.corners.ravel()]
    left, right = table.corners[table.pairs[:, 0]], table.corners[table.pairs[:, 1]]
    return np.asarray((corner_value[left] != corner_value[right]).any(axis=1))
