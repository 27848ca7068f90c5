"""What our pyqtgraph plots have in common."""

from __future__ import annotations

from typing import Any

import pyqtgraph as pg
from PySide6.QtCore import QRectF, Qt
from PySide6.QtWidgets import QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.docks.axis_numbers import decade_marks, distinct_numbers

OVERHANG = 16
"""Pixels by which the numbers of an axis may stand out beyond its ends."""


class LogarithmicAxis(pg.AxisItem):  # type: ignore[misc]
    """An axis whose marks stand at powers of ten, or at 1, 2, 5 times them where few powers are in sight."""

    def boundingRect(self) -> QRectF:
        """With room for half a number beyond its ends: an axis with a grid would leave out one that stands there."""
        rect: QRectF = super().boundingRect()
        return rect if self.grid is False else rect.adjusted(0.0, -OVERHANG, 0.0, OVERHANG)

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
