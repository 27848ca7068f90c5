"""Where a point is in a pattern, counted as figures count."""

from __future__ import annotations

import numpy as np

from workbench.app.views.camera import Points
from workbench.app.views.solid_texture import CELLS, OFFSET
from workbench.app.views.textures import TILE, Texture
from workbench.core.arrays import Floats

LINE = 4.0
"""Pixels of a tile that the line of a grid takes: it lies at the beginning of a cell, and in figures about it."""


def squares_of(texture: Texture, points: Points, *, is_through: bool) -> Floats:
    """Points (n, 3) in units of the display -> (n, 2|3) as `TextureLook` has them; `is_through` for a pattern in space."""
    pattern = texture.pattern
    if is_through:
        return np.asarray(CELLS[pattern] * texture.coordinates_in_space(points) + OFFSET, dtype=np.float64)
    places = texture.coordinates(points).astype(np.float64)
    if pattern in ("checkerboard", "stripes") or (pattern == "picture" and not texture.is_picture):
        return np.asarray(2.0 * places + [1.0, 0.0])  # two fields a tile, the first one dark
    if pattern == "grid":
        return np.asarray(places * [1.0, -1.0] - 0.5 * LINE / TILE)  # the first line of a tile is at its top
    return places
