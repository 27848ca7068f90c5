"""Rounded solids inside of level sets: the gingerbread man and a star-shaped blob."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.samples.closed import blob_radius
from workbench.core.samples.figure import ANCHOR_PLACES, figure_distance
from workbench.core.samples.isosurface_stuffing import stuffed_solid

FIGURE_PLACES = tuple((1.3 * x, 1.3 * y, 0.0) for x, y in ANCHOR_PLACES)
"""Beyond hands, feet, head: what is nearest lies on the surface."""
BLOB_PLACES = ((1.8, 0.4, 0.8), (-1.2, 1.4, 0.6), (0.2, 0.6, -1.9))
"""Beyond three of its lumps."""


def solid_gingerbread(tetrahedra: int) -> tuple[Floats, Integers]:
    """Vertices (n, 3) and about `tetrahedra` tetrahedra of the figure with round limbs."""
    return stuffed_solid(figure_distance, np.array([-1.5, -1.5, -0.6]), np.array([1.5, 2.0, 0.6]), tetrahedra)


def solid_blob(tetrahedra: int) -> tuple[Floats, Integers]:
    """Vertices (n, 3) and about `tetrahedra` tetrahedra of the inside of the blob: star-shaped, no ball."""
    return stuffed_solid(blob_distance, np.full(3, -1.5), np.full(3, 1.5), tetrahedra)


def blob_distance(points: Floats) -> Floats:
    """How far points (k, 3) lie outside the blob along their rays; negative inside."""
    lengths = np.linalg.norm(points, axis=1)
    return lengths - blob_radius(points / np.maximum(lengths, 1e-12)[:, None])
