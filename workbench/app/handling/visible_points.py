"""Which points of a solid or a surface are seen, and which ones are hidden by it."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Floats, Integers

CHUNK = 2_000_000
"""Pairs of point and triangle that are compared at once."""
BEHIND = 1e-6
"""Of the depth of all points: what a point may lie behind a triangle and still be on it."""
FINEST = 512
"""Cells along the longer side of the candidates' box, at most."""


def visible_points(candidates: Integers, pixels: Floats, heights: Floats, triangles: Integers) -> Integers:
    """Those of `candidates` (c,) that no triangle hides.

    Parameters
    ----------
    pixels : (n, 2) float64, heights : (n,) float64     from `ViewCamera.project`
    triangles : (m, 3) int64

    Cost: for each point as many comparisons as there are triangles over its cell of a grid about as fine as they are.
    """
    if not len(candidates):
        return candidates
    places = pixels[candidates]
    low, high = places.min(axis=0), places.max(axis=0)
    corners = pixels[triangles]
    is_near = ((corners.min(axis=1) <= high) & (corners.max(axis=1) >= low)).all(axis=1)
    triangles, corners = triangles[is_near], corners[is_near]
    doubled = _cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    is_seen = np.abs(doubled) > 1e-9  # one that is seen on edge hides nothing
    triangles, corners, doubled = triangles[is_seen], corners[is_seen], doubled[is_seen]
    if not len(triangles):
        return candidates
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    cells = _Cells(low, high, corners)
    slack = BEHIND * (np.ptp(heights) or 1.0)
    hides = np.zeros(len(candidates), dtype=bool)
    for points, over in cells.pairs(places):
        p, chosen = places[points], doubled[over]
        u, v = _cross(c[over] - b[over], p - b[over]) / chosen, _cross(a[over] - c[over], p - c[over]) / chosen
        w = 1.0 - u - v
        covers = (u >= -1e-9) & (v >= -1e-9) & (w >= -1e-9)
        h = heights[triangles[over]]
        depth = u * h[:, 0] + v * h[:, 1] + w * h[:, 2]
        hides[points[covers & (depth > heights[candidates[points]] + slack)]] = True
    return candidates[~hides]


class _Cells:
    """Triangles by the cells of a grid that their boxes meet: `corners` (m, 3, 2), the grid between `low` and `high` (2,)."""

    def __init__(self, low: Floats, high: Floats, corners: Floats) -> None:
        extent = np.maximum(high - low, 1e-9)
        side = max(float(np.median(np.ptp(corners, axis=1).max(axis=1))), float(extent.max()) / FINEST)
        self._low, self._side = low, side
        self._shape = np.floor(extent / side).astype(np.int64) + 1
        first, last = self._cell_of(corners.min(axis=1)), self._cell_of(corners.max(axis=1))
        spans = last - first + 1
        counts = spans.prod(axis=1)
        owner = np.repeat(np.arange(len(corners)), counts)
        number = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
        rows = first[owner, 1] + number // spans[owner, 0]
        columns = first[owner, 0] + number % spans[owner, 0]
        cells = rows * self._shape[0] + columns
        order = np.argsort(cells, kind="stable")
        self._triangles = owner[order]
        self._starts = np.searchsorted(cells[order], np.arange(int(self._shape.prod()) + 1))

    def _cell_of(self, places: Floats) -> Integers:
        """(k, 2) column and row, the nearest ones for places outside the grid."""
        return np.clip(np.floor((places - self._low) / self._side).astype(np.int64), 0, self._shape - 1)

    def pairs(self, places: Floats):  # type: ignore[no-untyped-def]
        """Each of `places` (k, 2) with each triangle of its cell, as chunks of (points, triangles)."""
        columns, rows = self._cell_of(places).T
        cells = rows * self._shape[0] + columns
        begins, counts = self._starts[cells], self._starts[cells + 1] - self._starts[cells]
        ends = np.cumsum(counts)
        begin = 0
        while begin < len(places):
            done = ends[begin - 1] if begin else 0
            end = max(begin + 1, int(np.searchsorted(ends, done + CHUNK, side="right")))
            chosen = np.arange(begin, end)
            points = np.repeat(chosen, counts[chosen])
            number = np.arange(len(points)) - np.repeat(ends[chosen] - counts[chosen] - done, counts[chosen])
            yield points, self._triangles[begins[points] + number]
            begin = end


def _cross(u: Floats, v: Floats) -> Floats:
    return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])
