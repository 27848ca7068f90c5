"""What the colour maps show, and their colour ranges: one for each quantity, shared by every view."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QObject, Signal

from workbench.core.arrays import Floats
from workbench.core.measure import Measure


@dataclass(frozen=True)
class Quantity:
    """A field that snapshots carry: id in `Snapshot.fields`, words for the title, smallest possible value.

    `least_span` is the narrowest range of colours: below it differences are not worth a colour.
    """

    id: str
    label: str
    equation: str
    formula: str
    least: float
    least_span: float = 0.1
    parameters: tuple[tuple[str, float], ...] = ()
    text: str = ""

    @property
    def measure(self) -> Measure:
        """What the engine computes for it."""
        return Measure(self.text or self.id, self.parameters)


LIVE_QUANTITIES: tuple[Quantity, ...] = (
    Quantity("dirichlet", "Dirichlet", "(25)", "σ₁² + σ₂²", 0.0, least_span=5.0),
    Quantity("condition-number", "Condition number", "(29)", "σ₁ / σ₂", 1.0),
    Quantity("symmetric-dirichlet", "Symmetric Dirichlet", "(32)", "σ₁² + σ₂² + σ₁⁻² + σ₂⁻²", 4.0),
)

CONFORMAL_FACTOR = Quantity("average-singular-value", "Average singular value", "(78)", "(σ₁ + σ₂) / 2", 0.0)

STEPS = (1.0, 2.0, 5.0)


def rounded_up(span: float) -> float:
    """The next of ..., 0.1, 0.2, 0.5, 1, 2, 5, 10, ... at or above `span`."""
    if not np.isfinite(span) or span <= 0:
        return 0.1
    decade = 10.0 ** np.floor(np.log10(span))
    for step in (*STEPS, 10.0):
        if span <= step * decade * (1 + 1e-9):
            return float(step * decade)
    return float(10.0 * decade)


class ColourRange(QObject):
    """Range of one quantity; `changed` tells all views that show it.

    The upper end is a round number above nearly all values. It rises at once and falls only when the values
    have fallen far below it, so that colours keep their meaning while a map moves.
    """

    changed = Signal()

    def __init__(self, quantity: Quantity) -> None:
        super().__init__()
        self.quantity = quantity
        self.low = quantity.least
        self.high = quantity.least + 1.0
        self.is_locked = False
        self._is_fresh = True

    def forget(self) -> None:
        """Start anew, for another mesh."""
        self._is_fresh = True

    def take(self, values: Floats) -> None:
        """Fit the range to the values (m,) of a snapshot; those that are not finite do not count."""
        if self.is_locked:
            return
        # a sample is enough for a round number, and keeps large meshes cheap
        sample = values[:: max(1, len(values) // 20000)]
        sample = sample[np.isfinite(sample)]
        if not len(sample):
            return
        wanted = float(np.quantile(sample, 0.99)) - self.low
        span = self.high - self.low
        if self._is_fresh or wanted > span or wanted < 0.15 * span:
            self._is_fresh = False
            self.set_high(self.low + max(rounded_up(wanted), self.quantity.least_span))

    def set_high(self, high: float) -> None:
        if high != self.high and high > self.low:
            self.high = high
            self.changed.emit()
