"""Triangles filled at the centres of pixels: the kernel of `FlatPicture`, whose compiler takes long to import."""

from __future__ import annotations

import numba
import numpy as np


@numba.njit(nogil=True, cache=True, error_model="numpy")
def fill(points, triangles, colours, places, tile, pixels):  # type: ignore[no-untyped-def]
    """Pixels (height, width) of triangles in their order; see `FlatPicture` for the rest."""
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
