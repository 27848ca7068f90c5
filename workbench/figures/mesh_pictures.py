"""Pictures of a mesh as images: triangles in colours, and a source with a chequered texture."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from workbench.core.arrays import Booleans, Floats, Integers
from workbench.core.facets import facet_table
from workbench.core.mesh import Mesh
from workbench.figures.picture_sampling import sampled
from workbench.figures.raster import Raster, rasterise
from workbench.figures.recipe import CHEQUERED

PIXELS = 320
"""Of the longer side of a picture."""
STRIP = 256
"""Rows of pixels, about, that are drawn at once."""
FINER = 2
"""Pixels a side that are averaged to one."""
SQUARES = 14
"""Of the chequered texture along the side of a square as large as the source."""
TEXTURE = ((0.96, 0.95, 0.92), (0.20, 0.38, 0.58))
LINE, FINE_LINE = 1 / 32, 1 / 128
"""Half the width of the lines of a grid, and of the fine ones between them in the plane, in its cells."""
BETWEEN = 61 / 128
"""Where the fine lines are: in the middle of what the others leave, to a pixel of the views."""
OFF_CORNERS = 0.37
"""Squares by which a texture is shifted that is fitted to a map: a flat side of a solid often lies at a round coordinate."""
RINGS = (0.18, 0.38, 0.45)
"""Radii of a disc, and of the ring round it, of circles."""
LIGHT = np.array([-0.35, 0.5, 0.8]) / np.linalg.norm([-0.35, 0.5, 0.8])


@dataclass(frozen=True, eq=False)
class Skin:
    """What can be seen of a mesh: its triangles, or those that bound its tetrahedra.

    `triangles` : (k, 3) int64;  `simplex` : (k,) int64, the simplex of the mesh that each belongs to
    """

    triangles: Integers
    simplex: Integers


def skin_of(mesh: Mesh) -> Skin:
    """The visible triangles of a mesh."""
    if mesh.dimension == 2:
        return Skin(mesh.simplices, np.arange(mesh.simplex_count))
    table = facet_table(mesh.simplices)
    outer = np.flatnonzero(table.counts[table.facets] == 1)
    return Skin(table.sides[outer], outer // table.simplex_size)


def view_of(mesh: Mesh) -> Floats:
    """A turn (3, 3) that shows a mesh in space well: rows are the axes to the right, up and to the viewer.

    One looks along the axis in which the mesh is thinnest, from the side that most of an open surface faces, and, unless
    it is flat, a little from the side and from above.
    """
    extent = np.ptp(mesh.vertices, axis=0)
    ahead = np.zeros(3)
    ahead[int(np.argmin(extent))] = 1.0
    if mesh.dimension == 2:
        p, q, r = mesh.vertices[mesh.simplices].transpose(1, 0, 2)
        if np.cross(q - p, r - p).sum(axis=0) @ ahead < -1e-9:
            ahead = -ahead
    up = np.array([0.0, 0.0, 1.0]) if abs(ahead[1]) > 0.5 else np.array([0.0, 1.0, 0.0])
    turned = ahead.copy()
    if extent.min() > 1e-3 * extent.max():
        turned += 0.35 * np.cross(up, ahead) + 0.25 * up
    turned /= np.linalg.norm(turned)
    right = np.cross(up, turned)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(turned, right), turned])


@dataclass(frozen=True)
class Frame:
    """Part of the plane that a picture shows: its centre and the half of its width and height.

    `density` is the number of pixels of a unit of length; 0 for `PIXELS` along the longer side.
    """

    centre: tuple[float, float]
    half: tuple[float, float]
    density: float = 0.0

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """left, right, bottom, top"""
        (x, y), (w, h) = self.centre, self.half
        return x - w, x + w, y - h, y + h

    @property
    def pixels(self) -> tuple[int, int]:
        """Width and height of the picture."""
        density = self.density or PIXELS / (2 * max(self.half))
        return max(8, round(2 * density * self.half[0])), max(8, round(2 * density * self.half[1]))


def frame_round(points: Floats, half: tuple[float, float] | None = None) -> Frame:
    """The frame about points (n, 2|3), of their own size with a little air where none is given."""
    low, high = points[:, :2].min(axis=0), points[:, :2].max(axis=0)
    if half is None:
        width, height = 0.52 * np.maximum(high - low, 1e-3 * (high - low).max() + 1e-300)
        half = (float(width), float(height))
    return Frame((float(low[0] + high[0]) / 2, float(low[1] + high[1]) / 2), half)


def in_strips(draw: Callable[[Frame], Floats], frame: Frame) -> Floats:
    """A large picture (h, w, 4), drawn strip by strip from the lowest: memory stays that of one strip."""
    count = max(1, frame.pixels[1] // STRIP)
    (x, y), (width, height) = frame.centre, frame.half
    low, step = y - height, 2 * height / count
    return np.vstack([
        draw(replace(frame, centre=(x, low + (i + 0.5) * step), half=(width, 0.5 * step))) for i in range(count)
    ])  # fmt: skip


def coloured_picture(points: Floats, skin: Skin, colours: Floats, frame: Frame, on_top: Booleans | None = None) -> Floats:
    """An image (h, w, 4) of triangles in one colour each; transparent where there is none.

    Parameters
    ----------
    points : (n, 2|3) float64     in the plane, or turned by `view_of`: then shaded, too
    colours : (k, 3) float64      of the triangles of `skin`
    on_top : (k,) bool            triangles that are drawn over the others
    """
    raster = _raster(points, skin, frame, on_top)
    image = raster.of_triangles(colours)
    if points.shape[1] == 3:
        image = image * raster.of_triangles(shades(points, skin))[..., None]
    return raster.averaged(image, FINER)


def textured_picture(
    points: Floats, skin: Skin, places: Floats, frame: Frame, pattern: str = CHEQUERED, picture: Floats | None = None
) -> Floats:
    """An image (h, w, 4) of triangles under a texture, one of `TEXTURES`, or under a picture (r, c, 3).

    `places` : (n, 2|3) of the vertices in squares of the texture, or in the picture (see `TextureLook`)
    """
    raster = _raster(points, skin, frame, None)
    if picture is None:
        image = np.array(TEXTURE)[is_inked(raster.of_vertices(skin.triangles, places), pattern).astype(np.int64)]
    else:
        image = sampled(picture, raster.of_vertices(skin.triangles, places[:, :2]))
    if points.shape[1] == 3:
        image = image * raster.of_triangles(shades(points, skin))[..., None]
    return raster.averaged(image, FINER)


def is_inked(places: Floats, pattern: str) -> Booleans:
    """Which of places (…, c), in squares of a texture, are dark."""
    cells = np.floor(places)
    if pattern == "stripes":
        return np.asarray(cells[..., 0] % 2 == 1)
    within = places - cells
    if pattern == "grid":
        fine = FINE_LINE if places.shape[-1] == 2 else 0.0
        lines = (np.abs(within - 0.5) > 0.5 - LINE) | (np.abs(within - BETWEEN) < fine)
        return np.asarray(lines.any(axis=-1))
    if pattern == "circles":
        radius = np.linalg.norm(within - 0.5, axis=-1)
        return np.asarray((radius < RINGS[0]) | ((radius > RINGS[1]) & (radius < RINGS[2])))
    return np.asarray(cells.sum(axis=-1) % 2 == 1)


def nearness(points: Floats, skin: Skin, frame: Frame) -> Floats:
    """(h, w): how near what is seen of turned points (n, 3) lies to the viewer; nothing is infinitely far. `FINER` a pixel."""
    raster = _raster(points, skin, frame, None)
    near = raster.of_vertices(skin.triangles, points[:, 2:])[..., 0]
    return np.where(raster.is_covered, near, -np.inf)


def texture_square(mesh: Mesh, total_measure: float) -> float:
    """Side of a square of the texture in the target, from the area or volume of the source."""
    return float(total_measure ** (1.0 / mesh.dimension)) / SQUARES


def _raster(points: Floats, skin: Skin, frame: Frame, on_top: Booleans | None) -> Raster:
    width, height = (FINER * count for count in frame.pixels)
    left, right, bottom, top = frame.extent
    scale = np.array([width / (right - left), height / (top - bottom)])
    pixels = (points[:, :2] - [left, bottom]) * scale
    if points.shape[1] == 3:
        pixels = np.column_stack([pixels, points[:, 2]])
    return rasterise(pixels, skin.triangles, width, height, None if on_top is None else on_top.astype(np.int64))


def shades(points: Floats, skin: Skin) -> Floats:
    """(k,) in (0, 1]: how light falls on either side of each triangle."""
    p, q, r = points[skin.triangles].transpose(1, 0, 2)
    normal = np.cross(q - p, r - p)
    length = np.maximum(np.linalg.norm(normal, axis=1), 1e-300)
    normal *= (np.where(normal[:, 2] < 0, -1.0, 1.0) / length)[:, None]
    result: Floats = 0.62 + 0.38 * np.maximum(normal @ LIGHT, 0.0)
    return result


def blended(colours: Floats, amount: Floats, image: Floats) -> Floats:
    """A picture (h, w, 4) below a veil: its `colours` (3,) or (h, w, 3), and how much (h, w) of each pixel it covers."""
    below = image[..., 3] * (1.0 - amount)
    whole = np.maximum(amount + below, 1e-12)
    mixed = (amount[..., None] * colours + below[..., None] * image[..., :3]) / whole[..., None]
    return np.concatenate([mixed, (amount + below)[..., None]], axis=2)
