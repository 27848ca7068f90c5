"""Which vertex is meant by a pointer: plain geometry of the projected mesh, no graphics card asked."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from workbench.core.arrays import Floats, Integers


def nearest_pixel(pixels: Floats, at: tuple[float, float], reach: float) -> int:
    """Row of `pixels` (n, 2) nearest to `at` within `reach` pixels; -1 where there is none."""
    if not len(pixels):
        return -1
    offset = pixels - np.asarray(at)
    square = np.einsum("ij,ij->i", offset, offset)
    best = int(np.argmin(square))
    return best if square[best] <= reach * reach else -1


def segment_distances(segments: Floats, point: Floats) -> Floats:
    """(k,) distances of a point (2,) from segments (k, 2, 2)."""
    begin, step = segments[:, 0], segments[:, 1] - segments[:, 0]
    square = np.maximum(np.einsum("ij,ij->i", step, step), 1e-12)
    along = np.clip(np.einsum("ij,ij->i", point - begin, step) / square, 0.0, 1.0)
    return np.asarray(np.linalg.norm(begin + along[:, None] * step - point, axis=1))


class ScreenTriangles:
    """Triangles as they lie in a widget, prepared for many questions at one camera.

    Parameters
    ----------
    pixels : (n, 2) float64, heights : (n,) float64    from `ViewCamera.project`
    triangles : (m, 3) int64
    """

    def __init__(self, pixels: Floats, heights: Floats, triangles: Integers) -> None:
        self.pixels = pixels
        self.heights = heights
        self.triangles = triangles
        corners = pixels[triangles]
        self._low = corners.min(axis=1)
        self._high = corners.max(axis=1)

    @cached_property
    def _corners(self) -> Integers:
        """Points of triangles: of a solid, those inside cannot be meant."""
        is_corner = np.zeros(len(self.pixels), dtype=bool)
        is_corner[self.triangles] = True
        return np.flatnonzero(is_corner)

    def triangle_at(self, at: tuple[float, float]) -> int:
        """Triangle in front at a pixel; -1 where the background is. Cost: O(m) comparisons."""
        x, y = at
        low, high = self._low, self._high
        near = np.flatnonzero((low[:, 0] <= x) & (high[:, 0] >= x) & (low[:, 1] <= y) & (high[:, 1] >= y))
        if not len(near):
            return -1
        corners = self.pixels[self.triangles[near]]
        a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
        point = np.array([x, y])
        areas = np.stack([_doubled(b, c, point), _doubled(c, a, point), _doubled(a, b, point)], axis=1)
        total = areas.sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            weights = areas / total[:, None]
        hit = (np.abs(total) > 0) & (weights >= -1e-9).all(axis=1)
        if not hit.any():
            return -1
        depth = np.einsum("ij,ij->i", weights[hit], self.heights[self.triangles[near[hit]]])
        return int(near[hit][np.argmax(depth)])

    def vertex_at(self, at: tuple[float, float], reach: float, reach_inside: float) -> int:
        """Point meant at a pixel: the nearest corner of the triangle in front, else the nearest corner of any.

        `reach_inside` is the reach in pixels over the mesh, `reach` over the background.
        """
        triangle = self.triangle_at(at)
        if triangle < 0:
            row = nearest_pixel(self.pixels[self._corners], at, reach)
            return int(self._corners[row]) if row >= 0 else -1
        corners = self.triangles[triangle]
        row = nearest_pixel(self.pixels[corners], at, reach_inside)
        return int(corners[row]) if row >= 0 else -1


def _doubled(a: Floats, b: Floats, p: Floats) -> Floats:
    """Twice the signed areas of the triangles (a, b, p)."""
    return np.asarray((b[:, 0] - a[:, 0]) * (p[1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (p[0] - a[:, 0]))
