"""Flat maps as pictures without OpenGL: where no graphics card draws, several times cheaper than to imitate one."""

from __future__ import annotations

import threading

import numpy as np
from numpy.typing import NDArray

from workbench.core.arrays import Floats, Integers

Colours = NDArray[np.uint32]
"""Red, green, blue and opacity, a byte each, red the lowest."""
Places = NDArray[np.float32]
Tile = NDArray[np.uint8]
"""Red, green and blue (height, width, 3) of what a texture repeats, the first row at the bottom."""

NO_COLOURS: Colours = np.zeros(0, np.uint32)
NO_PLACES, NO_TILE = np.zeros((0, 2), np.float32), np.zeros((0, 0, 3), np.uint8)


def packed(colour: tuple[float, float, float]) -> int:
    """A colour in [0, 1] as one number."""
    red, green, blue = (round(255 * part) for part in colour)
    return red | green << 8 | blue << 16 | 0xFF << 24


class FlatPicture:
    """Triangles filled in their order, in a colour each or under a texture, at the centres of pixels, as OpenGL does.

    The kernel is compiled the first time ever, which takes a second; `is_ready` tells that it comes without a wait.
    """

    is_ready = False

    def __init__(self) -> None:
        self._pixels: Colours = np.zeros((0, 0), np.uint32)

    def paint(self, points: Floats, triangles: Integers, colours: Colours, background: int, width: int, height: int) -> Colours:
        """Pixels (height, width), valid until the next call.

        Parameters
        ----------
        points : (n, 2) float64       in pixels, x to the right, y as the rows are counted
        triangles : (m, 3) int64      later ones cover earlier ones
        colours : (m,)                one a triangle
        """
        from workbench.app.views.picture_kernel import fill

        pixels = self._blank(background, width, height)
        fill(points, triangles, colours, NO_PLACES, NO_TILE, pixels)
        return pixels

    def paint_texture(
        self, points: Floats, triangles: Integers, places: Places, tile: Tile, background: int, width: int, height: int
    ) -> Colours:
        """The same under a texture, which lies at `places` (n, 2): a tile has the side 1, and is repeated."""
        from workbench.app.views.picture_kernel import fill

        pixels = self._blank(background, width, height)
        fill(points, triangles, NO_COLOURS, places, tile, pixels)
        return pixels

    def _blank(self, background: int, width: int, height: int) -> Colours:
        if self._pixels.shape != (height, width):
            self._pixels = np.empty((height, width), np.uint32)
        self._pixels[:] = background
        return self._pixels


_compiling = threading.Lock()


def compile_pictures() -> None:
    """Load or compile the kernel; for a thread beside the window."""
    with _compiling:
        if not FlatPicture.is_ready:
            FlatPicture().paint(np.zeros((3, 2)), np.array([[0, 1, 2]]), np.zeros(1, np.uint32), 0, 1, 1)
            FlatPicture.is_ready = True
