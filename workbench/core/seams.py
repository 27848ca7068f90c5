"""Seams: edges across which the texture coordinates of a file jump."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Booleans, Floats, Integers
from workbench.core.facets import FacetTable, facet_table
from workbench.core.mesh import Mesh, TextureCoordinates


def seam_pairs(texture: TextureCoordinates, table: FacetTable) -> Booleans:
    """Pairs of neighbouring triangles whose texture coordinates differ at an end of their shared edge, (p,) bool.

    Coordinates are compared, not their numbers: many writers repeat equal coordinates for each face.
    """
    as_numbers = texture.coordinates.view(np.complex128).ravel()  # one complex number a row sorts faster than rows
    _, value = np.unique(as_numbers, return_inverse=True)
    corner_value = value[texture.corners.ravel()]
    left, right = table.corners[table.pairs[:, 0]], table.corners[table.pairs[:, 1]]
    return np.asarray((corner_value[left] != corner_value[right]).any(axis=1))


def texture_at_vertices(mesh: Mesh) -> Floats | None:
    """Texture coordinates (n, 2) of the vertices; None where a corner has none, or a seam leaves a vertex with several."""
    texture = mesh.texture
    if texture is None or (texture.corners < 0).any():
        return None
    corners, values = mesh.simplices.ravel(), texture.coordinates[texture.corners.ravel()]
    found = np.full((mesh.vertex_count, 2), np.nan)
    found[corners] = values
    is_map = bool((found[corners] == values).all() and np.isfinite(found).all())
    return found if is_map else None


def seam_edges(texture: TextureCoordinates, triangles: Integers) -> Integers:
    """Seams (k, 2) as vertices of their ends.

    Parameters
    ----------
    texture : TextureCoordinates     of the triangles
    triangles : (m, 3) int64
    """
    table = facet_table(triangles)
    return table.sides[table.pairs[seam_pairs(texture, table), 0]]
