"""Stars of vertices in the plane that overlap themselves though every triangle is positively oriented (Fig. 13)."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Booleans, Floats, Integers
from workbench.core.predicates import orientation

_DOUBTFUL = 1e-6
"""Angle sums of boundary stars this close to a full turn are decided exactly."""


def overlapping_stars(triangles: Integers, has_twin: Booleans, positions: Floats) -> Integers:
    """Vertices (k,) whose triangles overlap each other.

    An inner vertex is passed when its star winds round it once: that is counted exactly, by the triangles that the
    horizontal ray from the vertex enters. A boundary vertex is passed when the angles of its star sum up to less than
    a full turn; sums close to that are decided by the exact orientation of the first and the last side.

    Parameters
    ----------
    triangles : (m, 3) int64        counter-clockwise in the map, every directed side once
    has_twin : (m, 3) bool          whether a triangle lies across the side from each corner to the next
    positions : (n, 2) float64
    """
    vertex_count = len(positions)
    centre = triangles.T.ravel()
    first, last = triangles[:, [1, 2, 0]].T.ravel(), triangles[:, [2, 0, 1]].T.ravel()
    y = positions[:, 1]
    enters = (y[first] <= y[centre]) & (y[centre] < y[last])
    # the ray to the right runs into a counter-clockwise triangle c f l where f is not above it and l is
    turns = np.bincount(centre[enters], minlength=vertex_count)

    towards, away = positions[first] - positions[centre], positions[last] - positions[centre]
    cross = towards[:, 0] * away[:, 1] - towards[:, 1] * away[:, 0]
    dot = np.einsum("ij,ij->i", towards, away)
    angles = np.bincount(centre, np.abs(np.arctan2(cross, dot)), vertex_count)

    opening = ~has_twin.T.ravel()  # corners that no other triangle of the star comes before
    closing = ~has_twin[:, [2, 0, 1]].T.ravel()
    fans = np.bincount(centre[opening], minlength=vertex_count)
    overlaps = (fans == 0) & (turns > 1)
    overlaps |= (fans > 0) & (angles > 2.0 * np.pi + _DOUBTFUL)

    doubtful = (fans == 1) & (np.abs(angles - 2.0 * np.pi) <= _DOUBTFUL)
    if doubtful.any():
        start, end = np.full(vertex_count, -1), np.full(vertex_count, -1)
        start[centre[opening]], end[centre[closing]] = first[opening], last[closing]
        rows = np.flatnonzero(doubtful)
        # less than a full turn: the last side is still to the right of the first
        overlaps[rows] = orientation(positions[rows], positions[start[rows]], positions[end[rows]]) >= 0
    return np.flatnonzero(overlaps)
