"""What our pyqtgraph plots have in common."""

from __future__ import annotations

import math
import re
from typing import Any

import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtWidgets import QWidget

from workbench.app.range_fit import rounded_up
from workbench.app.theme import Theme

OVERHANG = 16
"""Pixels by which the numbers of an axis may stand out beyond its ends."""


class LogarithmicAxis(pg.AxisItem):  # type: ignore[misc]
    """An axis whose marks stand at powers of ten, or at 1, 2, 5 times them where few powers are in sight."""

    def tickValues(self, low: float, high: float, size: float) -> list[tuple[float, list[float]]]:
        if not self.logMode:
            return list(super().tickValues(low, high, size))
        room = 28 if self.orientation in ("left", "right") else 52
        most = max(int(size / room), 2)
        return [(1.0, decade_marks(low, high, most))]

    def tickStrings(self, values: list[float], scale: float, spacing: float) -> list[str]:
        if not self.logMode:
            return list(super().tickStrings(values, scale, spacing))
        return distinct_numbers([10.0**value for value in values])


def decade_marks(low: float, high: float, most: int) -> list[float]:
    """Logarithms of at most `most` round numbers between 10**low and 10**high."""
    if not (math.isfinite(low) and math.isfinite(high)) or high <= low:
        return []
    decades = [float(d) for d in range(math.ceil(low), math.floor(high) + 1)]
    if len(decades) >= 2:
        return decades[:: math.ceil(len(decades) / most)]
    start = math.floor(low)
    marks = [start + d + math.log10(f) for d in (0, 1) for f in (1, 2, 5)]
    marks = [mark for mark in marks if low <= mark <= high]
    if len(marks) >= 2:
        return marks[:: math.ceil(len(marks) / most)]
    # less than a factor of five in sight: the axis is nearly linear
    least, greatest = 10.0**low, 10.0**high
    step = rounded_up((greatest - least) / most)
    first, last = math.ceil(least / step), math.floor(greatest / step)
    return [math.log10(k * step) for k in range(first, last + 1) if k > 0]


def distinct_numbers(values: list[float]) -> list[str]:
    """Numbers as short as they may be and still differ, on an axis that shows a narrow range."""
    for digits in (1, 2, 3):
        texts = [short_number(value, digits) for value in values]
        if len(set(texts)) == len(texts):
            break
    return texts


def short_number(value: float, digits: int = 1) -> str:
    """Four digits (`digits` + 3) where the number is of ordinary size, else a power of ten with `digits` after the point."""
    if 1e-3 <= value < 1e4:
        return f"{value:.{digits + 3}g}"
    text = f"{value:.{digits}e}".replace("e+0", "e").replace("e-0", "e-").replace("e+", "e")
    return re.sub(r"\.?0+e", "e", text)


def calm(plot: pg.PlotItem, owner: QWidget) -> None:
    """No menus, no dragging: the plot shows what there is. Its menu gets an owner, or it would outlive the window."""
    plot.setMenuEnabled(False)
    plot.hideButtons()
    plot.setMouseEnabled(False, False)
    plot.setContentsMargins(0, 0, OVERHANG, 0)
    for menu in (plot.ctrlMenu, plot.getViewBox().menu):
        if menu is not None:
            menu.setParent(owner, Qt.WindowType.Popup)


def paint_axes(plot: pg.PlotItem, theme: Theme) -> None:
    """Axes and their numbers in the colours of a theme."""
    for side in ("bottom", "left"):
        axis: Any = plot.getAxis(side)
        axis.enableAutoSIPrefix(False)
        axis.setPen(theme.faint)
        axis.setTextPen(theme.text)
        if side == "bottom":
            axis.setTickDensity(0.7)
        # a number at the very end may stand out as far as half of it
        axis.setStyle(tickLength=4, maxTickLevel=0, hideOverlappingLabels=OVERHANG)
