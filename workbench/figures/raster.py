"""Triangles as pixels: which triangle is seen where; pictures of dense meshes stay small and look the same everywhere."""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np

from workbench.core.arrays import Booleans, Floats, Integers


@dataclass(frozen=True, eq=False)
class Raster:
    """What each pixel shows.

    `triangle` : (h, w) int64, -1 where there is none;  `weights` : (h, w, 3) barycentric coordinates in it
    """

    triangle: Integers
    weights: Floats

    @property
    def is_covered(self) -> Booleans:
        """(h, w) whether a triangle is there."""
        covered: Booleans = self.triangle >= 0
        return covered

    def of_triangles(self, values: Floats) -> Floats:
        """(h, w, ...) values at the pixels from one value (m, ...) a triangle; any where no triangle is."""
        result: Floats = values[np.maximum(self.triangle, 0)]
        return result

    def of_vertices(self, triangles: Integers, values: Floats) -> Floats:
        """(h, w, c) values at the pixels, linear in each triangle, from values (n, c) at the vertices; 0 where none is."""
        result = np.zeros((*self.triangle.shape, values.shape[1]))
        _interpolate(self.triangle, self.weights, triangles, np.ascontiguousarray(values), result)
        return result

    def averaged(self, image: Floats, finer: int) -> Floats:
        """(h / finer, w / finer, 4) from an image (h, w, 3): mean colour of what is covered, and how much of a pixel is."""
        height, width = self.triangle.shape
        result = np.zeros((height // finer, width // finer, 4))
        _average(np.ascontiguousarray(image), self.triangle, finer, result)
        return result


def rasterise(points: Floats, triangles: Integers, width: int, height: int, layers: Integers | None = None) -> Raster:
    """The triangles that are seen at the centres of pixels.

    Parameters
    ----------
    points : (n, 2|3) float64     in pixels, x to the right, y up from the lower edge; a third column is nearness
    layers : (m,) int64           triangles of a higher layer cover those of lower ones, however near

    The nearest triangle covers the others; among equals the later one does. Row 0 is the lowest.
    """
    seen = np.full((height, width), -1, dtype=np.int64)
    weights = np.zeros((height, width, 3))
    places = np.zeros((len(points), 3))
    places[:, : points.shape[1]] = points
    order = np.arange(len(triangles)) if layers is None else np.argsort(layers, kind="stable")
    levels = np.zeros(len(triangles), dtype=np.int64) if layers is None else layers
    _fill(places, triangles, order, levels, seen, weights, np.full((height, width), -np.inf))
    return Raster(seen, weights)


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _fill(points, triangles, order, layers, seen, weights, nearness):  # type: ignore[no-untyped-def]
    height, width = seen.shape
    for t in order:
        i, j, k = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        x0, y0, x1, y1, x2, y2 = points[i, 0], points[i, 1], points[j, 0], points[j, 1], points[k, 0], points[k, 1]
        det = (x1 - x0) * (y2 - y0) - (y1 - y0) * (x2 - x0)
        if not abs(det) > 0.0:
            continue
        left, right = max(0.0, np.floor(min(x0, x1, x2) - 0.5)), min(width - 1.0, np.ceil(max(x0, x1, x2)))
        low, high = max(0.0, np.floor(min(y0, y1, y2) - 0.5)), min(height - 1.0, np.ceil(max(y0, y1, y2)))
        for row in range(int(low), int(high) + 1):
            for column in range(int(left), int(right) + 1):
                x, y = column + 0.5 - x0, row + 0.5 - y0
                b = (x * (y2 - y0) - y * (x2 - x0)) / det
                c = (y * (x1 - x0) - x * (y1 - y0)) / det
                a = 1.0 - b - c
                if min(a, b, c) < -1e-9:
                    continue
                near = a * points[i, 2] + b * points[j, 2] + c * points[k, 2]
                before = seen[row, column]
                if before < 0 or layers[before] < layers[t] or near >= nearness[row, column]:
                    seen[row, column], nearness[row, column] = t, near
                    weights[row, column, 0], weights[row, column, 1], weights[row, column, 2] = a, b, c


@numba.njit(nogil=True, cache=True)
def _interpolate(seen, weights, triangles, values, result):  # type: ignore[no-untyped-def]
    height, width, columns = result.shape
    for row in range(height):
        for column in range(width):
            t = seen[row, column]
            if t < 0:
                continue
            for corner in range(3):
                vertex, part = triangles[t, corner], weights[row, column, corner]
                for c in range(columns):
                    result[row, column, c] += part * values[vertex, c]


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _average(image, seen, finer, result):  # type: ignore[no-untyped-def]
    height, width = result.shape[:2]
    for row in range(height):
        for column in range(width):
            covered = 0
            for i in range(row * finer, (row + 1) * finer):
                for j in range(column * finer, (column + 1) * finer):
                    if seen[i, j] < 0:
                        continue
                    covered += 1
                    for c in range(3):
                        result[row, column, c] += image[i, j, c]
            if covered:
                for c in range(3):
                    result[row, column, c] /= covered
            result[row, column, 3] = covered / finer**2
