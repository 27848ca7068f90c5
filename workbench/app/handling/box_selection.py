"""Which vertices lie in a box that was drawn over a view."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Booleans, Floats, Integers

CHUNK = 4_000_000
"""Pairs of point and triangle that are compared at once."""
BEHIND = 1e-6
"""Of the depth of all points: what a point may lie behind a triangle and still be on it."""


def in_box(pixels: Floats, low: Floats, high: Floats) -> Booleans:
    """(n,) whether points (n, 2) lie between the corners `low` and `high` (2,)."""
    return np.asarray(((pixels >= low) & (pixels <= high)).all(axis=1))


def visible_points(candidates: Integers, pixels: Floats, heights: Floats, triangles: Integers) -> Integers:
    """Those of `candidates` (c,) that no triangle hides.

    Parameters
    ----------
    pixels : (n, 2) float64, heights : (n,) float64     from `ViewCamera.project`
    triangles : (m, 3) int64

    Cost: O(c m') comparisons, m' the triangles over the box round the candidates.
    """
    if not len(candidates):
        return candidates
    places = pixels[candidates]
    low, high = places.min(axis=0), places.max(axis=0)
    corners = pixels[triangles]
    is_near = ((corners.min(axis=1) <= high) & (corners.max(axis=1) >= low)).all(axis=1)
    triangles, corners = triangles[is_near], corners[is_near]
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    doubled = _cross(b - a, c - a)
    is_seen = np.abs(doubled) > 1e-9  # one that is seen on edge hides nothing
    triangles, a, b, c, doubled = triangles[is_seen], a[is_seen], b[is_seen], c[is_seen], doubled[is_seen]
    slack = BEHIND * (np.ptp(heights) or 1.0)
    is_hidden = np.zeros(len(candidates), dtype=bool)
    step = max(1, CHUNK // max(len(triangles), 1))
    for begin in range(0, len(candidates), step):
        rows = candidates[begin : begin + step]
        p = pixels[rows][:, None, :]
        u, v = _cross(c - b, p - b) / doubled, _cross(a - c, p - c) / doubled
        w = 1.0 - u - v
        covers = (u >= -1e-9) & (v >= -1e-9) & (w >= -1e-9)
        h = heights[triangles]
        depth = u * h[:, 0] + v * h[:, 1] + w * h[:, 2]
        is_hidden[begin : begin + step] = (covers & (depth > heights[rows][:, None] + slack)).any(axis=1)
    return candidates[~is_hidden]


def _cross(u: Floats, v: Floats) -> Floats:
    return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])
