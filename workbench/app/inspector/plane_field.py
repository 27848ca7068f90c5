"""A distortion over the plane of two singular values: samples, colours, level lines. No drawing here."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from workbench.app.colouring.range_fit import rounded_up
from workbench.app.inspector.level_lines import level_lines
from workbench.core.arrays import Floats
from workbench.core.distortion import Distortion

LEVELS = 10
"""About as many lines as are drawn."""
BELOW, ABOVE = 1e-4, 1e4
"""Ends of a logarithmic colour scale at most, as multiples of D at the isometry; what lies beyond has the last colour."""


@dataclass(frozen=True)
class Region:
    """Part of the plane in the plot's own coordinates: log10 of singular values where `is_logarithmic`."""

    left: float
    right: float
    bottom: float
    top: float
    is_logarithmic: bool = True


@dataclass(frozen=True)
class PlaneStyle:
    """How D is shown: `is_logarithmic` colours, and whether the half sigma_1 < sigma_n is filled by symmetry."""

    is_logarithmic: bool = True
    is_mirrored: bool = False


@dataclass(frozen=True, eq=False)
class PlaneField:
    """D over a region.

    `values` (columns, rows), NaN where D is not shown; `low` and `high` end the colour scale; `levels` (k,) and the
    pieces `lines` (p, 2, 2) of their lines, in coordinates of the plot.
    """

    region: Region
    style: PlaneStyle
    values: Floats
    low: float
    high: float
    levels: Floats
    lines: Floats

    def shares(self, values: Floats) -> Floats:
        """Places in [0, 1] of values on the colour scale; NaN stays NaN."""
        return scale_shares(values, self.low, self.high, self.style.is_logarithmic)


def to_sigma(places: Floats, is_logarithmic: bool) -> Floats:
    """Coordinates of the plot -> singular values."""
    return np.power(10.0, np.clip(places, -300.0, 300.0)) if is_logarithmic else np.asarray(places, dtype=np.float64)


def to_places(sigma: Floats, is_logarithmic: bool) -> Floats:
    """Singular values >= 0 -> coordinates of the plot; 0 lies far away on a logarithmic one."""
    return np.log10(np.maximum(sigma, 1e-30)) if is_logarithmic else np.asarray(sigma, dtype=np.float64)


def with_middle(first: Floats, last: Floats, dimension: int) -> Floats:
    """Singular values (m, n) of which the first and the last are given; the one between is their geometric mean."""
    columns = [first, last] if dimension == 2 else [first, np.sqrt(np.maximum(first * last, 0.0)), last]
    return np.stack(columns, axis=1)


def sample_plane(
    distortion: Distortion, dimension: int, region: Region, style: PlaneStyle, columns: int, rows: int
) -> PlaneField:
    """D at the middles of `columns` x `rows` cells of a region, its colour scale and its level lines."""
    x = _middles(region.left, region.right, columns)
    y = _middles(region.bottom, region.top, rows)
    first, last = np.meshgrid(to_sigma(x, region.is_logarithmic), to_sigma(y, region.is_logarithmic), indexing="ij")
    shown = (last > 0) & (first > 0) if style.is_mirrored else (last > 0) & (first >= last)
    values = np.full(first.shape, np.nan)
    high, low = np.maximum(first, last)[shown], np.minimum(first, last)[shown]
    if len(high):
        values[shown] = distortion.value(with_middle(high, low, dimension))
    isometry = float(distortion.value(np.ones((1, dimension)))[0])
    bottom, top = colour_ends(values, style.is_logarithmic, isometry)
    levels = round_levels(bottom, top, style.is_logarithmic)
    pieces = [_in_plot(level_lines(values, float(level)), x, y) for level in levels]
    lines = np.concatenate(pieces) if pieces else np.empty((0, 2, 2))
    return PlaneField(region, style, values, bottom, top, levels, lines)


def _middles(low: float, high: float, count: int) -> Floats:
    return np.asarray(low + (np.arange(count) + 0.5) * ((high - low) / count), dtype=np.float64)


def _in_plot(pieces: Floats, x: Floats, y: Floats) -> Floats:
    """From units of the grid to coordinates of the plot."""
    scale = np.array([x[1] - x[0], y[1] - y[0]])
    return np.asarray(pieces * scale + np.array([x[0], y[0]]))


def colour_ends(values: Floats, is_logarithmic: bool, usual: float = 0.0) -> tuple[float, float]:
    """Ends of a colour scale for these values: the least one, and one that most lie below.

    `usual` is a positive value that a logarithmic scale shall not go too far away from; 0 where there is none.
    """
    finite = values[np.isfinite(values)]
    if is_logarithmic:
        finite = finite[finite > 0]
    if not len(finite):
        return (0.1, 1.0) if is_logarithmic else (0.0, 1.0)
    low, high = float(finite.min()), float(np.quantile(finite, 0.99 if is_logarithmic else 0.8))
    if is_logarithmic:
        if 0.0 < usual < math.inf:
            high = min(high, max(ABOVE * usual, 10.0 * low))
            low = max(low, min(BELOW * usual, 0.1 * high))
        low = max(low, BELOW * high)
        return low, max(high, low * 1.05)
    return low, max(high, low + 1e-3 * max(abs(low), 1e-3))


def scale_shares(values: Floats, low: float, high: float, is_logarithmic: bool) -> Floats:
    """Places in [0, 1] of values on a scale from `low` to `high`; infinity is 1, NaN stays NaN."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        if is_logarithmic:
            values = np.log(np.maximum(values, 1e-300))
            low, high = math.log(low), math.log(high)
        return np.clip((values - low) / (high - low), 0.0, 1.0)


def round_levels(low: float, high: float, is_logarithmic: bool) -> Floats:
    """About ten round numbers between the ends, and on a logarithmic scale a few above."""
    if not is_logarithmic or high < 5 * low:
        step = rounded_up((high - low) / LEVELS)
        return np.arange(math.floor(low / step) + 1, math.floor(high / step) + 1) * step
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    levels = np.array([factor * 10.0**d for d in decades for factor in (1, 2, 5)])
    levels = levels[(levels > low) & (levels < high * 10)]
    return levels[:: max(1, math.ceil(len(levels) / (2 * LEVELS)))]
