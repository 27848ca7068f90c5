"""Patterns and pictures that are laid over triangles, repeated evenly in a map or in the source."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonDataModel import vtkImageData
from vtkmodules.vtkRenderingCore import vtkTexture

from workbench.app.views.camera import Points

Pattern = Literal["checkerboard", "grid", "circles", "stripes", "picture", "plain"]
PATTERNS: tuple[Pattern, ...] = ("checkerboard", "grid", "circles", "stripes", "picture", "plain")
PATTERN_LABELS: dict[str, str] = {
    "checkerboard": "Checkerboard",
    "grid": "Grid",
    "circles": "Circles",
    "stripes": "Stripes",
    "picture": "Picture",
    "plain": "Plain",
}
Pixels = NDArray[np.uint8]
"""Red, green and blue (height, width, 3), the first row at the top."""
TILES_ACROSS = 14.0
"""Repetitions of a pattern along the diameter of what it lies in, at its usual size; a picture is there once."""
TILE = 64
"""Pixels along a side of a pattern."""
RINGS = (0.18, 0.38, 0.45)
"""Radii of the circles of a tile, in its side: ink is within the first, and between the others."""


@dataclass(frozen=True, eq=False)
class Texture:
    """A pattern and how it lies.

    Parameters
    ----------
    pattern : Pattern
    size : float          of its tiles, as a factor of the usual one
    degrees : float       by which it is turned, counter-clockwise
    picture : Pixels      the tile of the pattern `picture`; None: there is none yet, a board takes its place
    fills : bool          whether a picture is as high as it is wide, whatever its pixels: as u and v from 0 to 1 are
    points : callable     where the points of the geometry are that it is laid out on, in units of the display; None: on the
                          points that are drawn
    """

    pattern: Pattern
    size: float = 1.0
    degrees: float = 0.0
    picture: Pixels | None = None
    fills: bool = False
    points: Callable[[], Points | None] | None = None

    @property
    def is_picture(self) -> bool:
        return self.pattern == "picture" and self.picture is not None

    @property
    def repeats(self) -> float:
        """Tiles along a unit of the display."""
        return (1.0 if self.is_picture else TILES_ACROSS) / self.size

    def coordinates(self, points: Points) -> NDArray[np.float32]:
        """(n, 2|3) in units of the display -> (n, 2), where a tile has the side 1; a picture lies in the middle."""
        angle = np.deg2rad(self.degrees)
        back = self.repeats * np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
        if self.is_picture and not self.fills:
            assert self.picture is not None
            height, width = self.picture.shape[:2]
            back /= np.array([[width], [height]]) / max(width, height)
        found = points[:, :2] @ back.T.astype(np.float32)
        return np.asarray(found + 0.5 if self.is_picture else found, dtype=np.float32)

    def coordinates_in_space(self, points: Points) -> NDArray[np.float32]:
        """(n, 3) in units of the display -> (n, 3), where a tile is a cube of side 1; turned about the third axis."""
        return np.column_stack([self.coordinates(points), self.repeats * points[:, 2]]).astype(np.float32)

    def tile(self, dark: bool) -> Pixels:
        """What is repeated."""
        if self.picture is not None and self.is_picture:
            return self.picture
        return pattern_image("checkerboard" if self.pattern == "picture" else self.pattern, dark)


def pattern_image(pattern: Pattern, dark: bool) -> Pixels:
    """One tile of a pattern: two by two fields of a board, one cell of a grid, a disc in a ring, two stripes."""
    paper, ink = ((58, 66, 76), (118, 132, 148)) if dark else ((250, 251, 252), (150, 166, 186))
    row, column = np.indices((TILE, TILE))
    amount = np.zeros((TILE, TILE))
    if pattern == "checkerboard":
        amount[(row < TILE // 2) != (column < TILE // 2)] = 1.0
    elif pattern == "grid":
        line, middle = 4, TILE // 2
        amount[(row < line) | (column < line) | (row == middle) | (column == middle)] = 1.0
    elif pattern == "circles":
        radius = np.hypot(row - 0.5 * (TILE - 1), column - 0.5 * (TILE - 1)) / TILE
        within = [np.clip((ring - radius) * TILE + 0.5, 0.0, 1.0) for ring in RINGS]  # soft over one pixel
        amount = within[0] + within[2] - within[1]
    elif pattern == "stripes":
        amount[column < TILE // 2] = 1.0
    mixed = np.multiply.outer(1.0 - amount, paper) + np.multiply.outer(amount, ink)
    return np.rint(mixed).astype(np.uint8)


def repeating(tile: Pixels, fine: bool) -> vtkTexture:
    """A VTK texture that repeats; `fine` filters it when it is far away, which costs much without a graphics card."""
    image = np.ascontiguousarray(tile[::-1])  # VTK counts rows from below
    data = vtkImageData()
    data.SetDimensions(image.shape[1], image.shape[0], 1)
    data.GetPointData().SetScalars(numpy_to_vtk(image.reshape(-1, 3), deep=1))
    texture = vtkTexture()
    texture.SetInputData(data)
    texture.RepeatOn()
    texture.InterpolateOn()
    texture.SetMipmap(fine)
    return texture
