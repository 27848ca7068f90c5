"""Where a slider ends, and how its positions become values."""

from __future__ import annotations

import math
from dataclasses import dataclass

from workbench.core.method import Parameter

TICKS = 1000
"""Positions of a slider, beside the first."""
DECADES = 100.0
"""Ratio of the ends from which a slider is logarithmic unless told otherwise."""
DIGITS = 4


@dataclass(frozen=True)
class ParameterRange:
    """From `low` to `high`; logarithmic sliders need both above 0, whole ones step through the integers."""

    low: float
    high: float
    is_log: bool = False
    is_whole: bool = False

    def __post_init__(self) -> None:
        if not (math.isfinite(self.low) and math.isfinite(self.high) and self.low < self.high):
            raise ValueError("The range is empty: its end must be above its beginning.")
        if self.is_log and self.low <= 0:
            raise ValueError("A logarithmic range begins above 0.")

    @property
    def ticks(self) -> int:
        return min(round(self.high - self.low), TICKS) if self.is_whole else TICKS

    def value_at(self, tick: int) -> float:
        """The value of a position, rounded to what the slider can tell apart; the ends are exact."""
        part = tick / self.ticks
        if part <= 0:
            return self.low
        if part >= 1:
            return self.high
        if self.is_log:
            value = self.low * (self.high / self.low) ** part
            return _rounded(value, value)
        value = self.low + part * (self.high - self.low)
        return float(round(value)) if self.is_whole else _rounded(value, self.high - self.low)

    def tick_of(self, value: float) -> int:
        """The nearest position; values beyond an end are at that end."""
        if value <= self.low:
            return 0
        if value >= self.high:
            return self.ticks
        if self.is_log:
            return round(self.ticks * math.log(value / self.low) / math.log(self.high / self.low))
        return round(self.ticks * (value - self.low) / (self.high - self.low))

    def step_from(self, value: float, count: int) -> float:
        """The value `count` small steps on: a twentieth of a decade, a hundredth of the range, or one."""
        if self.is_log:
            moved = max(value, self.low) * 10.0 ** (count / 20)
            return _rounded(moved, moved)
        if self.is_whole:
            return value + count
        span = self.high - self.low
        return _rounded(value + count * span / 100, span)

    def with_value(self, value: float) -> ParameterRange:
        """Widened so that the value lies in it."""
        low, high = min(self.low, value), max(self.high, value)
        return ParameterRange(low, high, self.is_log and low > 0, self.is_whole)

    @staticmethod
    def of(parameter: Parameter, value: float) -> ParameterRange:
        """The declared range; where an end is open, one that leaves room around the value."""
        is_whole = parameter.type in (int, bool)
        room = max(abs(value), 1.0)
        low, high = parameter.minimum, parameter.maximum
        if parameter.type is bool:
            low, high = 0.0, 1.0
        if low is None:
            low = value / 10 if value > 0 and not is_whole else value - 10 * room
        if high is None:
            high = max(10 * value, low + room) if value > 0 else value + 10 * room
        low, high = float(low), float(high)
        if not low < high:
            high = low + 1.0
        is_log = not is_whole and low > 0 and high / low >= DECADES
        return ParameterRange(low, high, is_log, is_whole).with_value(value)


def _rounded(value: float, scale: float) -> float:
    """To so many digits of `scale`."""
    if value == 0 or not math.isfinite(value):
        return value
    return round(value, DIGITS - 1 - math.floor(math.log10(abs(scale))))
