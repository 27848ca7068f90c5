"""Level lines of a sampled function, as unconnected pieces."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Floats

# corners of a cell, counted round it: (0, 0), (1, 0), (1, 1), (0, 1)
CORNERS = ((0, 0), (1, 0), (1, 1), (0, 1))
SIDES = ((0, 1), (1, 2), (2, 3), (3, 0))


def level_lines(values: Floats, level: float) -> Floats:
    """Where a function on a grid passes a level.

    Parameters
    ----------
    values : (a, b) float64    samples at whole places; cells with a value that is not finite are left out
    level : float

    Returns
    -------
    (k, 2, 2) float64   ends of straight pieces, in units of the grid

    Where a cell is passed twice, the mean of its corners decides which corners belong together.
    """
    corners = np.stack([values[i : values.shape[0] - 1 + i, j : values.shape[1] - 1 + j] for i, j in CORNERS])
    is_finite = np.isfinite(corners).all(axis=0)
    with np.errstate(invalid="ignore"):
        above = corners >= level
    count = above.sum(axis=0)
    rows, columns = np.nonzero(is_finite & (count > 0) & (count < 4))
    if not len(rows):
        return np.empty((0, 2, 2))
    corners, above = corners[:, rows, columns], above[:, rows, columns]
    origin = np.stack([rows, columns], axis=1).astype(np.float64)
    crossings = np.full((4, len(rows), 2), np.nan)
    for side, (first, second) in enumerate(SIDES):
        is_passed = above[first] != above[second]
        a, b = corners[first, is_passed], corners[second, is_passed]
        share = ((level - a) / (b - a))[:, None]
        begin, end = np.array(CORNERS[first]), np.array(CORNERS[second])
        crossings[side, is_passed] = origin[is_passed] + begin + share * (end - begin)
    return np.concatenate([_single(crossings, above), _double(crossings, corners, above, level)])


def _single(crossings: Floats, above: np.ndarray) -> Floats:
    """Pieces of cells that are passed once: between their two sides."""
    passed = np.isfinite(crossings[..., 0])
    chosen = np.flatnonzero(passed.sum(axis=0) == 2)
    first = passed[:, chosen].argmax(axis=0)
    last = 3 - passed[::-1, chosen].argmax(axis=0)
    return np.stack([crossings[first, chosen], crossings[last, chosen]], axis=1)


def _double(crossings: Floats, corners: Floats, above: np.ndarray, level: float) -> Floats:
    """Pieces of saddles, two each: they cut off the corners that differ from the middle."""
    chosen = np.flatnonzero(np.isfinite(crossings[..., 0]).all(axis=0))
    middle_is_above = corners[:, chosen].mean(axis=0) >= level
    cuts_first = above[0, chosen] != middle_is_above  # corner 0 lies between sides 3 and 0
    pieces = []
    for cut, sides in ((cuts_first, ((3, 0), (1, 2))), (~cuts_first, ((0, 1), (2, 3)))):
        cells = chosen[cut]
        pieces += [np.stack([crossings[a, cells], crossings[b, cells]], axis=1) for a, b in sides]
    return np.concatenate(pieces)
