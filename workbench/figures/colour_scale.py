"""Colours of values on white paper, on one scale for all that share it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Floats

if TYPE_CHECKING:
    from matplotlib.cm import ScalarMappable

TRIMMED = 60
"""Entries of the colour table left out at its pale end, which would be lost on white paper."""
INVERTED = (1.0, 0.83, 0.0)
"""Colour of inverted simplices."""
CLIPPED_BELOW, CLIPPED_ABOVE = (0.40, 0.76, 0.40), (0.0, 0.36, 0.17)
"""Colours of what lies beyond the ends of a scale that marks it: none of any scale, nor that of inverted simplices."""
LEAST_SPAN = 1e-3
"""Of the colour scale, as a part of its lower end: below it nothing differs but by rounding."""
LOGARITHMIC = 8.0
"""Factor between the ends of a scale beyond which it is logarithmic."""
LEAST_FACTOR = 1.02
"""Of a scale about a centre, from there to its ends."""
LOWEST = 1e-3
"""A scale about a centre reaches no further below it than to this part of it."""


def colour_scale(values: Floats, limits: tuple[float, float] | None = None, logarithmic: bool | None = None) -> ScalarMappable:
    """From the least of finite values (k,) to all but the worst hundredth, or between `limits`.

    Where nothing is said of `logarithmic`, it is so where it spans much. Where nearly all are at the least, the worst are
    what there is to see.
    """
    import colorcet
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, LogNorm, Normalize

    low, high = limits or _fitted(values)
    wanted = high > LOGARITHMIC * low if logarithmic is None else logarithmic
    norm = LogNorm(low, high) if low > 0 and wanted else Normalize(low, high)
    return ScalarMappable(norm, ListedColormap(colorcet.palette["CET_L19"][TRIMMED:]))


def centred_scale(
    values: Floats, centre: float, limits: tuple[float, float] | None = None, logarithmic: bool | None = None
) -> ScalarMappable:
    """Factors about a positive `centre`: half and twice are as far from it, with other colours on its two sides.

    Where `limits` are not as far from it on both sides, equal steps still have equally strong colours.
    """
    import colorcet
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import ListedColormap, LogNorm, Normalize

    if limits is None:
        within = values[values > 0]
        ends = np.quantile(within, (0.01, 0.99)) if len(within) else np.array([centre, centre])
        factor = min(max(float(np.exp(np.abs(np.log(ends / centre)).max())), LEAST_FACTOR), 1 / LOWEST)
        limits = centre / factor, centre * factor
    norm = LogNorm(*limits) if limits[0] > 0 and logarithmic is not False else Normalize(*limits)
    table, middle = colorcet.palette["CET_D1"], float(norm(centre))
    reach = max(abs(middle), abs(1.0 - middle))
    places = 0.5 + 0.5 * (np.linspace(0.0, 1.0, len(table)) - middle) / reach
    entries = np.clip(np.rint(places * (len(table) - 1)), 0, len(table) - 1).astype(np.int64)
    return ScalarMappable(norm, ListedColormap([table[entry] for entry in entries]))


def in_the_way_of(scale: ScalarMappable, *, is_reversed: bool, is_clipped: bool) -> ScalarMappable:
    """The scale with its colours the other way round, and with marks beyond its ends, where that is wanted."""
    if is_reversed:
        scale.set_cmap(scale.cmap.reversed())
    if is_clipped:
        scale.set_cmap(scale.cmap.with_extremes(under=CLIPPED_BELOW, over=CLIPPED_ABOVE))
    return scale


def _fitted(values: Floats) -> tuple[float, float]:
    low, high = (float(values.min()), float(np.quantile(values, 0.99))) if len(values) else (0.0, 1.0)
    least_span = LEAST_SPAN * abs(low) + 1e-12
    if len(values) and high < low + least_span:
        high = float(values.max())
    return low, max(high, low + least_span)
