"""Flat maps as pictures without OpenGL: where no graphics card draws, several times cheaper than to imitate one."""

from __future__ import annotations

import threading

import numba
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
        pixels = self._blank(background, width, height)
        _fill(points, triangles, colours, NO_PLACES, NO_TILE, pixels)
        return pixels

    def paint_texture(
        self, points: Floats, triangles: Integers, places: Places, tile: Tile, background: int, width: int, height: int
    ) -> Colours:
        """The same under a texture, which lies at `places` (n, 2): a tile has the side 1, and is repeated."""
        pixels = self._blank(background, width, height)
        _fill(points, triangles, NO_COLOURS, places, tile, pixels)
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


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _fill(points, triangles, colours, places, tile, pixels):  # type: ignore[no-untyped-def]
    height, width = pixels.shape
    for t in range(len(triangles)):
        i, j, k = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        x0, y0, x1, y1, x2, y2 = points[i, 0], points[i, 1], points[j, 0], points[j, 1], points[k, 0], points[k, 1]
        det = (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0)
        if not 0.0 < abs(det) < np.inf:
            continue
        left, right = max(np.ceil(min(x0, x1, x2) - 0.5), 0.0), min(np.floor(max(x0, x1, x2) - 0.5), width - 1.0)
        low, high = max(np.ceil(min(y0, y1, y2) - 0.5), 0.0), min(np.floor(max(y0, y1, y2) - 0.5), height - 1.0)
        # twice the areas that a pixel spans with the edges, positive within; they grow evenly along a row
        turn = 1.0 if det > 0.0 else -1.0
        ax, ay, bx, by, cx, cy = y1 - y2, x2 - x1, y2 - y0, x0 - x2, y0 - y1, x1 - x0
        for row in range(int(low), int(high) + 1):
            x, y = left + 0.5, row + 0.5
            a, b, c = (x - x1) * ax + (y - y1) * ay, (x - x2) * bx + (y - y2) * by, (x - x0) * cx + (y - y0) * cy
            for column in range(int(left), int(right) + 1):
                if min(turn * a, turn * b, turn * c) >= 0.0:
                    if len(tile):
                        across = (a * places[i, 0] + b * places[j, 0] + c * places[k, 0]) / det
                        up = (a * places[i, 1] + b * places[j, 1] + c * places[k, 1]) / det
                        pixels[row, column] = _sample(tile, across, up)
                    else:
                        pixels[row, column] = colours[t]
                a += ax
                b += bx
                c += cx


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="always")
def _sample(tile, across, up):  # type: ignore[no-untyped-def]
    """Colour of a repeated tile between the centres of four of its pixels."""
    height, width = tile.shape[:2]
    x, y = width * (across - np.floor(across)) - 0.5, height * (up - np.floor(up)) - 0.5
    if not (abs(x) <= width and abs(y) <= height):
        return np.uint32(0xFF000000)  # where the map is not finite
    column, row = int(np.floor(x)), int(np.floor(y))
    s, t = x - column, y - row
    left, right, low, high = column % width, (column + 1) % width, row % height, (row + 1) % height
    packed = 0xFF
    for channel in (2, 1, 0):
        below = (1.0 - s) * tile[low, left, channel] + s * tile[low, right, channel]
        above = (1.0 - s) * tile[high, left, channel] + s * tile[high, right, channel]
        packed = packed << 8 | int((1.0 - t) * below + t * above + 0.5)
    return np.uint32(packed)
