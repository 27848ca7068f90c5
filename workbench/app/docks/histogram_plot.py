"""The bars of a histogram: all simplices in the colours of their values, and before them the brushed ones."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import pyqtgraph as pg
from PySide6.QtCore import Qt
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QWidget

from workbench.app.appearance.theme import BRUSH, Theme
from workbench.app.docks.bin_brush import BinBrush
from workbench.app.docks.plots import LogarithmicAxis, calm, paint_axes
from workbench.core.arrays import Floats


class HistogramPlot(pg.PlotWidget):  # type: ignore[misc]
    """Draws; what is counted, and what a drag across it means, is the dock's business."""

    def __init__(self, parent: QWidget) -> None:
        axes: dict[str, Any] = {side: LogarithmicAxis(side) for side in ("bottom", "left")}
        super().__init__(parent, axisItems=axes)
        calm(self.getPlotItem(), self)
        self.setToolTip("Drag across bars to mark their simplices in every view; click to unmark.")
        self.bars = pg.BarGraphItem(x0=[0.0], x1=[1.0], y0=0.0, height=[0.0])
        self._marked = pg.BarGraphItem(x0=[0.0], x1=[1.0], y0=0.0, height=[0.0])
        self._centre = pg.InfiniteLine(1.0, angle=90)
        for item in (self.bars, self._marked, self._centre):
            self.addItem(item)
        self.brush = BinBrush(self)

    def set_theme(self, theme: Theme) -> None:
        self.setBackground(theme.view)
        paint_axes(self.getPlotItem(), theme)
        self._centre.setPen(pg.mkPen(theme.faint, width=1, style=Qt.PenStyle.DashLine))
        self.bars.setOpts(pen=pg.mkPen(theme.faint, width=0.6))
        marked = QColor.fromRgbF(*BRUSH)
        self._marked.setOpts(pen=pg.mkPen(None), brush=marked if theme.is_dark else marked.darker(210))
        self.brush.set_theme(theme)

    def show_nothing(self) -> None:
        for item in (self.bars, self._marked):
            item.setOpts(x0=[0.0], x1=[1.0], height=[0.0])

    def set_logarithmic(self, bottom: bool, left: bool) -> None:
        """Which axes have logarithms for places."""
        for side, is_logarithmic in (("bottom", bottom), ("left", left)):
            self.getPlotItem().getAxis(side).setLogMode(is_logarithmic)

    def show_bars(self, edges: Floats, tops: Floats, bottom: float, colours: Sequence[QColor]) -> None:
        """Bars between `edges` (k + 1,) from `bottom` to `tops` (k,); the whole of them is in sight afterwards."""
        self.bars.setOpts(x0=edges[:-1], x1=edges[1:], y0=bottom, height=tops - bottom, brushes=colours)
        self._marked.setOpts(x0=edges[:-1], x1=edges[1:])
        self.setXRange(float(edges[0]), float(edges[-1]), padding=0.01)
        top = float(tops.max())
        self.setYRange(bottom, top if top > bottom else bottom + 1.0, padding=0.04)

    def show_marked(self, tops: Floats | None, bottom: float) -> None:
        """The brushed part of each bar, None where nothing is brushed."""
        self._marked.setVisible(tops is not None)
        if tops is not None:
            self._marked.setOpts(y0=bottom, height=tops - bottom)

    def show_centre(self, place: float | None) -> None:
        """A line where the colours meet, None where they do not."""
        self._centre.setVisible(place is not None)
        if place is not None:
            self._centre.setValue(place)
