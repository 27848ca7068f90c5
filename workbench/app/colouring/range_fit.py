"""Round ends of a colour range that suit some values."""

from __future__ import annotations

import numpy as np

from workbench.app.quantities.quantities import Quantity
from workbench.core.arrays import Floats

STEPS = (1.0, 2.0, 5.0)
FACTORS = (1.05, 1.1, 1.2, 1.5, 2.0)
"""Factors up to which a range about 1 reaches, where small ones suffice."""
LEFT_OUT = 0.01
"""Part of the values beyond each end where a range is fitted to nearly all."""


def rounded_up(span: float) -> float:
    """The next of ..., 0.1, 0.2, 0.5, 1, 2, 5, 10, ... at or above `span`."""
    if not np.isfinite(span) or span <= 0:
        return 0.1
    decade = 10.0 ** np.floor(np.log10(span))
    for step in (*STEPS, 10.0):
        if span <= step * decade * (1 + 1e-9):
            return float(step * decade)
    return float(10.0 * decade)


def rounded_down(value: float) -> float:
    """The next of ..., 0.1, 0.2, 0.5, 1, ... at or below a positive `value`."""
    return 1.0 / rounded_up(1.0 / value)


def rounded_factor(factor: float) -> float:
    """The next of 1.05, 1.1, 1.2, 1.5, 2, 5, 10, ... at or above `factor`."""
    return next((step for step in FACTORS if factor <= step * (1 + 1e-9)), None) or rounded_up(factor)


def fitted_ends(quantity: Quantity, values: Floats, *, logarithmic: bool, whole: bool) -> tuple[float, float] | None:
    """Ends for the finite ones of `values` (m,): nearly all of them lie between, or all where `whole`; None for no values.

    About a centre both sides reach equally far, in differences or, for a logarithmic scale, in factors.
    """
    values = values[np.isfinite(values) & (np.abs(values) < 1e30)]
    if logarithmic:
        values = values[values > 0]
    if not len(values):
        return None
    low, high = _ends(values, whole)
    centre = quantity.centre
    if centre is not None and logarithmic and centre > 0:
        factor = rounded_factor(max(high / centre, centre / low))
        return centre / factor, centre * factor
    if centre is not None and not logarithmic:
        reach = max(rounded_up(max(high - centre, centre - low)), 0.5 * quantity.least_span)
        return centre - reach, centre + reach
    if logarithmic:
        least = quantity.least if quantity.least is not None and quantity.least > 0 else rounded_down(low)
        return least, max(rounded_up(high), least * (1.0 + quantity.least_span))
    if quantity.least is not None:
        return quantity.least, quantity.least + max(rounded_up(high - quantity.least), quantity.least_span)
    step = rounded_up(max(high - low, 0.01 * max(abs(low), abs(high)), 1e-12) / 5)
    return float(np.floor(low / step) * step), float((np.floor(high / step) + 1) * step)


def _ends(values: Floats, whole: bool) -> tuple[float, float]:
    if whole:
        return float(values.min()), float(values.max())
    low, high = np.quantile(values, (LEFT_OUT, 1.0 - LEFT_OUT))
    return float(low), float(high)
