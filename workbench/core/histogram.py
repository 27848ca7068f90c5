"""Histograms of a number a simplex: bins, what lies in them, how much it weighs."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Floats, Integers


def bin_edges(low: float, high: float, count: int, *, logarithmic: bool = False) -> Floats:
    """`count` + 1 edges (count + 1,) from `low` to `high`: equal steps, or equal factors (`low` is positive then)."""
    if logarithmic:
        return np.geomspace(low, high, count + 1)
    return np.linspace(low, high, count + 1)


def bin_of(values: Floats, low: float, high: float, count: int, *, logarithmic: bool = False) -> Integers:
    """Which of `count` bins between `low` and `high` each value lies in.

    Parameters
    ----------
    values : (m,) float     infinities and all that lies outside belong to the bins at the ends
    logarithmic : bool      bins of equal factors; values up to 0 then lie in the first

    Returns
    -------
    (m,) int64     0 .. count - 1; -1 where the value is not a number
    """
    places = np.asarray(values, dtype=np.float64)
    missing = np.isnan(places)
    if logarithmic:
        places = np.log(np.maximum(places, np.finfo(np.float64).tiny))
        low, high = np.log(low), np.log(high)
    with np.errstate(invalid="ignore", over="ignore"):
        places = np.clip((places - low) * (count / (high - low)), 0, count - 1)
    if missing.any():
        places[missing] = -1
    return places.astype(np.int64)


def weight_in_bins(bins: Integers, count: int, weights: Floats | None = None) -> Floats:
    """How many values (or how much of `weights` (m,)) each of `count` bins holds: (count,) float64."""
    inside = bins >= 0
    found = np.bincount(bins[inside], weights=None if weights is None else weights[inside], minlength=count)
    return found.astype(np.float64)
