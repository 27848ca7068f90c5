"""Colour ranges: one for each quantity, shared by every view that shows it."""

from __future__ import annotations

import math

import numpy as np
from PySide6.QtCore import QObject, Signal

from workbench.app.colouring.range_fit import fitted_ends
from workbench.app.quantities.quantities import Quantity
from workbench.core.arrays import Floats

SAMPLE = 20_000
"""Values that a range is fitted to: enough for round numbers, and cheap on large meshes."""
SHRINKS_BELOW = 0.15
"""Part of the range below which it follows values that have become small."""
SHRINKS_BELOW_IN_FACTORS = 0.5
"""The same on a logarithmic scale, where ranges are alike in length for values that are far apart."""
SHRINKS_BELOW_AT_REST = 0.6
"""The same where nothing runs: what is looked at then is the map, and most of the scale has to be in use."""


class ColourRange(QObject):
    """Range, scale and colours of one quantity; `changed` tells all views that show it.

    The ends are round numbers beyond nearly all values. They move outwards at once and inwards only when the values
    have shrunk far, or to half where a run stops, so that colours keep their meaning while a map moves; `is_locked`
    holds them. Beyond the ends the
    colours of the ends go on, or, where `is_clipped`, two others stand.
    """

    changed = Signal()

    def __init__(self, quantity: Quantity) -> None:
        super().__init__()
        self.quantity = quantity
        self.is_locked = False
        self.is_whole = False
        self.is_logarithmic = quantity.is_logarithmic
        self.is_reversed = False
        self.is_clipped = False
        self.share_below = 0.0
        self.share_above = 0.0
        self._values: Floats | None = None
        self._is_fresh = True
        self.low, self.high = self._first_ends()

    def _first_ends(self) -> tuple[float, float]:
        """Before there are values."""
        least = self.quantity.least if self.quantity.least is not None else 0.0
        return (0.5, 2.0) if self.is_logarithmic else (least, least + 1.0)

    # ------------------------------------------------------------------------------------------ values

    def forget(self) -> None:
        """Start anew, for another mesh."""
        self._is_fresh = True
        self._values = None

    def take(self, values: Floats, *, at_rest: bool = False) -> None:
        """Fit the range to the values (m,) of a snapshot, `at_rest` where nothing runs; infinite ones do not count."""
        if values is self._values and not at_rest:
            return
        self._values = values
        self._fit(at_rest)
        self._count()

    def _fit(self, at_rest: bool = False) -> None:
        if self.is_locked or self._values is None:
            return
        values = self._values if self.is_whole else self._values[:: max(1, len(self._values) // SAMPLE)]
        ends = fitted_ends(self.quantity, values, logarithmic=self.is_logarithmic, whole=self.is_whole)
        if ends is None:
            return
        low, high = (self.scaled(end) for end in ends)
        old_low, old_high = self.scaled(self.low), self.scaled(self.high)
        slack = 1e-9 * (old_high - old_low)
        has_outgrown = low < old_low - slack or high > old_high + slack
        least_part = SHRINKS_BELOW_IN_FACTORS if self.is_logarithmic else SHRINKS_BELOW_AT_REST if at_rest else SHRINKS_BELOW
        if self._is_fresh or has_outgrown or high - low < least_part * (old_high - old_low):
            self._is_fresh = False
            self._set(*ends)

    def _count(self) -> None:
        """How much lies beyond the ends, for the note on the bar."""
        values = self._values
        if values is None or not len(values):
            self.share_below = self.share_above = 0.0
            return
        reach = 1e-6 * (self.high - self.low)
        self.share_above = np.count_nonzero(values > self.high + reach) / len(values)
        self.share_below = np.count_nonzero(values < self.low - reach) / len(values)

    # ------------------------------------------------------------------------------------------ choices

    def set_ends(self, low: float, high: float) -> None:
        """Hold these ends. Raises `ValueError` with a sentence for ends that are none."""
        if not (math.isfinite(low) and math.isfinite(high) and low < high):
            raise ValueError("The lower end must be a number below the upper end.")
        if self.is_logarithmic and low <= 0:
            raise ValueError("A logarithmic scale begins above 0; choose a linear scale for this range.")
        self.is_locked = True
        self._set(low, high)
        self._count()
        self.changed.emit()

    def hold(self, locked: bool) -> None:
        """Keep the ends as they are, or let them follow the values again."""
        self.is_locked = locked
        self._refit()

    def fit(self, *, whole: bool) -> None:
        """Follow nearly all values, or all of them where `whole`."""
        self.is_whole, self.is_locked = whole, False
        self._refit()

    def set_logarithmic(self, logarithmic: bool) -> None:
        """A scale of factors, or of differences; ends that it cannot have are fitted anew."""
        self.is_logarithmic = logarithmic
        if logarithmic and self.low <= 0:
            self.is_locked = False
            self.low, self.high = self._first_ends()
        self._refit()

    def set_reversed(self, is_reversed: bool) -> None:
        self.is_reversed = is_reversed
        self.changed.emit()

    def set_clipped(self, is_clipped: bool) -> None:
        """Draw what lies beyond the ends in colours that are none of the scale."""
        self.is_clipped = is_clipped
        self.changed.emit()

    def copy(self, parent: QObject) -> ColourRange:
        """Another range of the same quantity, as this one is now."""
        made = ColourRange(self.quantity)
        made.setParent(parent)
        made.take_from(self)
        return made

    def take_from(self, other: ColourRange) -> None:
        """Be as another range of the same quantity is now."""
        for name in ("is_locked", "is_whole", "is_logarithmic", "is_reversed", "is_clipped", "low", "high", "_is_fresh"):
            setattr(self, name, getattr(other, name))
        self._values = other._values
        self._count()
        self.changed.emit()

    def _refit(self) -> None:
        self._is_fresh = True
        self._fit()
        self._count()
        self.changed.emit()

    def _set(self, low: float, high: float) -> None:
        if (low, high) != (self.low, self.high) and high > low:
            self.low, self.high = low, high
            self.changed.emit()

    # ------------------------------------------------------------------------------------------ colours

    @property
    def centre(self) -> float | None:
        """Value in the middle of two colours; None where one scale runs through, as on a scale that cannot hold it."""
        centre = self.quantity.centre
        return None if centre is None or (self.is_logarithmic and centre <= 0) else centre

    def scaled(self, value: float) -> float:
        """A value on the scale of the colours."""
        return math.log(max(value, 1e-300)) if self.is_logarithmic else value

    def value_at(self, share: float) -> float:
        """The value at a part of the bar, 0 at its lower end, 1 at its upper."""
        low, high = self.scaled(self.low), self.scaled(self.high)
        place = low + share * (high - low)
        return math.exp(place) if self.is_logarithmic else place

    def share_of(self, value: float) -> float:
        """Where on the bar a value stands."""
        low, high = self.scaled(self.low), self.scaled(self.high)
        return (self.scaled(value) - low) / (high - low)

    def colours(self, count: int = 256) -> Floats:
        """Colours (count, 3) in [0, 1] at equal steps of the scale from the lower end to the upper.

        Equal steps away from the centre have equally strong colours on both sides, also where one side is longer.
        """
        from workbench.app.views.colours import distortion_colours, diverging_colours

        if self.centre is None:
            table, places = distortion_colours(), np.linspace(0.0, 1.0, count)
        else:
            middle = self.share_of(self.centre)
            reach = max(abs(middle), abs(1.0 - middle))
            table = diverging_colours()
            places = 0.5 + 0.5 * (np.linspace(0.0, 1.0, count) - middle) / reach
        if self.is_reversed:
            places = 1.0 - places
        return table[np.clip(np.rint(places * (len(table) - 1)), 0, len(table) - 1).astype(np.int64)]
