"""Pixels of a film's pictures: triangles in flat colours or under a chequered texture, their edges, smooth outlines."""

from __future__ import annotations

from dataclasses import dataclass, field

import numba
import numpy as np
from numpy.typing import NDArray

from workbench.core.arrays import Floats, Integers
from workbench.engine.compile_elsewhere import compile_elsewhere
from workbench.figures.mesh_pictures import BETWEEN, FINE_LINE, FINER, LINE, RINGS, TEXTURE
from workbench.figures.picture_sampling import picture_colour
from workbench.figures.raster import rasterise
from workbench.figures.recipe import TEXTURES

Pixels = NDArray[np.uint8]
GRID, CIRCLES, STRIPES = (TEXTURES.index(name) for name in ("grid", "circles", "stripes"))
NO_PICTURE = np.empty((0, 0, 3))
EDGE_REACH = 0.35
"""Half the width of an edge, in pixels of the film."""


@dataclass(frozen=True, eq=False)
class Paint:
    """How triangles look.

    Parameters
    ----------
    colours : (k, 3) float64         in [0, 1], one a triangle
    places : (n, c) float64          of the points in a texture (see `TextureLook`); no rows: `colours` count
    texture : int                    place in `TEXTURES`
    picture : (r, c, 3) float64      in [0, 1], in place of a texture; no rows: there is none
    edge : (3,) float64              colour of edges
    strength : float                 in [0, 1], of edges; 0: none are drawn
    """

    colours: Floats
    places: Floats
    texture: int = 0
    picture: Floats = field(default_factory=lambda: NO_PICTURE)
    edge: tuple[float, float, float] = (0.2, 0.2, 0.2)
    strength: float = 0.0


def draw_triangles(points: Floats, triangles: Integers, layers: Integers, paint: Paint, picture: Pixels) -> None:
    """Draw triangles over what is in `picture` (h, w, 3), each pixel as much as it is covered.

    Parameters
    ----------
    points : (n, 2|3) float64     in pixels of the picture, x to the right, y up from the lower edge; a third column is nearness
    triangles : (k, 3) int64
    layers : (k,) int64           triangles of a higher layer cover those of lower ones
    """
    height, width = picture.shape[:2]
    finer = points * float(FINER)
    raster = rasterise(finer, triangles, FINER * width, FINER * height, layers)
    heights = _heights(finer[:, :2], triangles) if paint.strength > 0 else np.zeros((1, 3))
    _shade(
        raster.triangle, raster.weights, triangles, np.ascontiguousarray(paint.colours), np.array(TEXTURE),
        np.ascontiguousarray(paint.places, dtype=np.float64), paint.texture, np.ascontiguousarray(paint.picture), heights,
        np.array(paint.edge), paint.strength, EDGE_REACH * FINER, FINER, picture,
    )  # fmt: skip


def _heights(points: Floats, triangles: Integers) -> Floats:
    """(k, 3): the distance of each corner from the side opposite it."""
    a, b, c = points[triangles].transpose(1, 0, 2)
    double = np.abs((b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0]))
    sides = np.stack([np.hypot(*(c - b).T), np.hypot(*(a - c).T), np.hypot(*(b - a).T)], axis=1)
    found: Floats = double[:, None] / np.maximum(sides, 1e-12)
    return found


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _ink(place, texture):  # type: ignore[no-untyped-def]
    """Whether a place (c,) of a texture is dark: the same as `is_inked`, for one place; 1 or 0."""
    tile, square, line = 0, 0.0, 0
    fine = FINE_LINE if len(place) == 2 else 0.0
    for k in range(len(place)):
        cell = np.floor(place[k])
        tile += int(cell)
        square += (place[k] - cell - 0.5) ** 2
        within = place[k] - cell
        line = max(line, int(abs(within - 0.5) > 0.5 - LINE or abs(within - BETWEEN) < fine))
    if texture == GRID:
        return line
    if texture == CIRCLES:
        radius = np.sqrt(square)
        return int(radius < RINGS[0] or RINGS[1] < radius < RINGS[2])
    if texture == STRIPES:
        return int(np.floor(place[0])) % 2
    return tile % 2


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _shade(  # type: ignore[no-untyped-def]
    seen, weights, triangles, colours, inks, places, texture, pattern, heights, edge, strength, reach, finer, picture
):
    height, width = picture.shape[:2]
    share = 1.0 / (finer * finer)
    is_textured = places.shape[0] > 0
    mixed, place, laid = np.empty(3), np.empty(places.shape[1]), np.ones(3)
    for row in range(height):
        for column in range(width):
            covered = 0
            mixed[:] = 0.0
            for i in range(finer):
                for j in range(finer):
                    y, x = (height - 1 - row) * finer + i, column * finer + j
                    t = seen[y, x]
                    if t < 0:
                        continue
                    covered += 1
                    a, b, c = weights[y, x, 0], weights[y, x, 1], weights[y, x, 2]
                    if is_textured:
                        i0, i1, i2 = triangles[t, 0], triangles[t, 1], triangles[t, 2]
                        for k in range(places.shape[1]):
                            place[k] = a * places[i0, k] + b * places[i1, k] + c * places[i2, k]
                        if pattern.shape[0] > 0:
                            picture_colour(pattern, place[0], place[1], laid)
                        else:
                            laid[:] = inks[_ink(place, texture)]
                    dark = 0.0
                    if strength > 0.0 and min(a * heights[t, 0], b * heights[t, 1], c * heights[t, 2]) < reach:
                        dark = strength
                    for k in range(3):
                        # under a texture the colour of the triangle is how light falls on it
                        base = colours[t, k] * laid[k]
                        mixed[k] += (1.0 - dark) * base + dark * edge[k]
            if covered:
                for k in range(3):
                    value = share * (255.0 * mixed[k] + (finer * finer - covered) * picture[row, column, k])
                    picture[row, column, k] = np.uint8(min(max(value + 0.5, 0.0), 255.0))


def compile_shading() -> None:
    """Compile what draws films, in a process of its own unless it was before: nothing here is held up meanwhile."""
    compile_elsewhere(_shade, use_shading)


def use_shading() -> None:
    """Draw one triangle."""
    corner = np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]])
    one = Paint(np.ones((1, 3)), np.empty((0, 2)))
    draw_triangles(corner, np.array([[0, 1, 2]]), np.zeros(1, np.int64), one, np.zeros((4, 4, 3), np.uint8))
