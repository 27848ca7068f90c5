"""Some of many points, spread evenly."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Floats, Integers

HALVINGS = 10
"""Of the interval of cell sizes that are tried."""
MOST = 10_000
"""Points that are looked at: of more, every second, third and so on is as good."""


def even_sample(points: Floats, count: int) -> Integers:
    """Rows of at most `count` points, nearly as many where there are enough: one of each cell of a grid that just does.

    Parameters
    ----------
    points : (k, d) float     finite
    count : int               at least 1

    Returns
    -------
    (c,) int64     ascending; of a cell the point that is nearest to its middle. Cost: some sorts of k numbers.
    """
    if len(points) <= count:
        return np.arange(len(points))
    step = max(1, len(points) // max(MOST, 4 * count))
    points = points[::step]
    low = points.min(axis=0)
    reach = float((points.max(axis=0) - low).max())
    if not reach > 0:
        return np.arange(1)
    coarse, fine = 1.001, 0.5 / count  # cell sizes, of the reach: one of the first holds all, of the second a part of a line
    for _ in range(HALVINGS):
        middle = (coarse * fine) ** 0.5
        if len(np.unique(_cells(points, low, middle * reach)[0])) > count:
            fine = middle
        else:
            coarse = middle
    keys, distance = _cells(points, low, coarse * reach)
    order = np.lexsort((distance, keys))
    first = np.ones(len(order), dtype=bool)
    first[1:] = keys[order[1:]] != keys[order[:-1]]
    return np.sort(order[first]) * step


def _cells(points: Floats, low: Floats, size: float) -> tuple[Integers, Floats]:
    """The cell (k,) of each point, as one number, and how far it lies from the middle of it."""
    places = (points - low) / size
    corners = np.floor(places)
    counts = corners.max(axis=0) + 1.0
    keys = np.zeros(len(points), dtype=np.int64)
    for axis in range(points.shape[1]):
        keys = keys * int(counts[axis]) + corners[:, axis].astype(np.int64)
    return keys, ((places - corners - 0.5) ** 2).sum(axis=1)
