"""Colours of a picture that is laid over triangles: between its pixels, repeated, made smaller where it is seen from afar."""

from __future__ import annotations

import numba
import numpy as np
from numpy.typing import NDArray

from workbench.core.arrays import Floats, Integers


def sampled(picture: Floats, places: Floats) -> Floats:
    """Colours (h, w, 3) of a picture (r, c, 3) at places (h, w, 2)."""
    result = np.empty((*places.shape[:2], 3))
    _sample(np.ascontiguousarray(picture), np.ascontiguousarray(places), result)
    return result


def fitting(picture: NDArray[np.uint8], places: Floats, points: Floats, triangles: Integers) -> Floats:
    """A picture (r, c, 3) uint8 as numbers in [0, 1], made smaller by as much as it is seen smaller on most of the triangles.

    Parameters
    ----------
    places : (n, 2|3) float64     of the vertices in the picture
    points : (n, 2|3) float64     where they are drawn, in the pixels at which the picture is looked up
    """
    from PIL import Image

    height, width = picture.shape[:2]
    there, here = areas(places[:, :2] * [width, height], triangles), areas(points[:, :2], triangles)
    seen = here > 0
    ratio = np.sqrt(there[seen] / here[seen])
    order, weights = np.argsort(ratio), here[seen]
    middle = np.searchsorted(np.cumsum(weights[order]), 0.5 * weights.sum()) if len(order) else 0
    factor = int(min(ratio[order[min(middle, len(order) - 1)]], min(width, height))) if len(order) else 1
    image = Image.fromarray(picture)
    return np.asarray(image.reduce(factor) if factor > 1 else image, dtype=np.float64) / 255.0


def areas(points: Floats, triangles: Integers) -> Floats:
    """(m,) of triangles in the plane."""
    p, q, r = points[triangles].transpose(1, 0, 2)
    found: Floats = 0.5 * np.abs((q[:, 0] - p[:, 0]) * (r[:, 1] - p[:, 1]) - (q[:, 1] - p[:, 1]) * (r[:, 0] - p[:, 0]))
    return found


@numba.njit(nogil=True, cache=True, error_model="numpy")
def picture_colour(picture, u, v, colour):  # type: ignore[no-untyped-def]
    """Write the colour of a picture (r, c, 3) at u to the right and v up, both repeated from 0 to 1, into `colour` (3,)."""
    rows, columns = picture.shape[:2]
    x, y = (u - np.floor(u)) * columns - 0.5, (1.0 - (v - np.floor(v))) * rows - 0.5
    left, top = int(np.floor(x)), int(np.floor(y))
    a, b = x - left, y - top
    i, j = top % rows, left % columns
    below, right = (top + 1) % rows, (left + 1) % columns
    for k in range(3):
        upper = (1.0 - a) * picture[i, j, k] + a * picture[i, right, k]
        lower = (1.0 - a) * picture[below, j, k] + a * picture[below, right, k]
        colour[k] = (1.0 - b) * upper + b * lower


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _sample(picture, places, result):  # type: ignore[no-untyped-def]
    for row in range(places.shape[0]):
        for column in range(places.shape[1]):
            picture_colour(picture, places[row, column, 0], places[row, column, 1], result[row, column])
