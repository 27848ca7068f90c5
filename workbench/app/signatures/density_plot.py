"""Normalised histograms of several maps over each other."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.docks.plots import LogarithmicAxis, calm, paint_axes
from workbench.app.signatures.comparison import Comparison


class DensityPlot(pg.PlotWidget):  # type: ignore[misc]
    """One outline a map, lightly filled, in the map's colour; a line at 1, which keeps lengths."""

    def __init__(self, parent: QWidget) -> None:
        axis: Any = LogarithmicAxis("bottom")
        super().__init__(parent, axisItems={"bottom": axis})
        self._axis = axis
        calm(self.getPlotItem(), self)
        self.setLabel("left", "density")
        self._unit = pg.InfiniteLine(1.0, angle=90)
        self.addItem(self._unit)
        self.curves: list[pg.PlotDataItem] = []

    def set_theme(self, theme: Theme) -> None:
        self.setBackground(theme.view)
        paint_axes(self.getPlotItem(), theme)
        self._unit.setPen(pg.mkPen(theme.faint, width=1, style=Qt.PenStyle.DashLine))

    def show_comparison(self, comparison: Comparison | None, colours: list[QColor]) -> None:
        """Draw the maps in their colours, in order; None clears."""
        for curve in self.curves:
            self.removeItem(curve)
        self.curves = []
        if comparison is None:
            return
        choices, edges = comparison.choices, comparison.edges
        self._axis.setLogMode(choices.is_logarithmic)
        self.setLabel("left", "density per decade" if choices.is_logarithmic else "density")
        self.setLabel("bottom", "average singular value (78)" + (", mean 1" if choices.is_normalised else ""))
        places = np.log10(edges) if choices.is_logarithmic else edges
        for height, colour in zip(comparison.heights, colours, strict=True):
            fill = QColor(colour)
            fill.setAlpha(40)
            # stepMode draws one level between each two edges
            curve = pg.PlotDataItem(
                places, height, stepMode="center", fillLevel=0, fillBrush=fill, pen=pg.mkPen(colour, width=2)
            )
            self.addItem(curve)
            self.curves.append(curve)
        self.setXRange(float(places[0]), float(places[-1]), padding=0.02)
        self.setYRange(0.0, max(float(height.max()) for height in comparison.heights), padding=0.05)
