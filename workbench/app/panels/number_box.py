"""A spin box that takes any number of digits and any exponent."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

from PySide6.QtCore import QLocale
from PySide6.QtGui import QValidator
from PySide6.QtWidgets import QAbstractSpinBox, QDoubleSpinBox, QWidget

LARGE = 1e15
_BEGUN = re.compile(r"[+-]?(\d*\.?\d*([eE][+-]?\d*)?)?")


class NumberBox(QDoubleSpinBox):
    """Shows six significant digits; `step` says where a value is after so many small steps."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.step: Callable[[float, int], float] = lambda value, count: value + count
        self.setLocale(QLocale.c())
        self.setDecimals(15)  # Qt rounds to so many
        self.setRange(-LARGE, LARGE)
        self.setKeyboardTracking(False)
        self.setButtonSymbols(QAbstractSpinBox.ButtonSymbols.UpDownArrows)

    def textFromValue(self, value: float) -> str:
        return f"{value:.6g}"

    def valueFromText(self, text: str) -> float:
        try:
            number = float(text)
        except ValueError:
            return self.value()
        return number if math.isfinite(number) else self.value()

    def validate(self, text: str, position: int) -> object:
        try:
            number = float(text)
        except ValueError:
            begun = _BEGUN.fullmatch(text) is not None
            return (QValidator.State.Intermediate if begun else QValidator.State.Invalid, text, position)
        fits = _BEGUN.fullmatch(text) is not None and self.minimum() <= number <= self.maximum()
        return (QValidator.State.Acceptable if fits else QValidator.State.Intermediate, text, position)

    def stepBy(self, steps: int) -> None:
        self.setValue(self.step(self.value(), steps))
