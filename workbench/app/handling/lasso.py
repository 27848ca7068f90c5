"""Which points lie inside an outline that was drawn by hand."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Booleans, Floats


def in_outline(points: Floats, outline: Floats) -> Booleans:
    """(n,) whether points (n, 2) lie inside a closed polygon (p, 2) by the even-odd law: loops of it cut holes.

    Cost: O(p) comparisons for each point in the box round the outline.
    """
    inside = np.zeros(len(points), dtype=bool)
    if len(outline) < 3:
        return inside
    near = np.flatnonzero(((points >= outline.min(axis=0)) & (points <= outline.max(axis=0))).all(axis=1))
    x, y = points[near].T
    odd = np.zeros(len(near), dtype=bool)
    for (ax, ay), (bx, by) in zip(outline.tolist(), np.roll(outline, -1, axis=0).tolist(), strict=True):
        if ay != by:  # a ray to the right crosses this edge
            odd ^= ((ay > y) != (by > y)) & (x < ax + (y - ay) * ((bx - ax) / (by - ay)))
    inside[near] = odd
    return inside


def box_outline(begin: Floats, end: Floats) -> Floats:
    """Corners (4, 2) of the box between two of them."""
    (a, b), (c, d) = begin, end
    return np.array([[a, b], [c, b], [c, d], [a, d]])
