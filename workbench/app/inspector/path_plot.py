"""A plot of energies along a path, with a marker that can be dragged."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QWidget

from workbench.app.appearance.theme import LIGHT, Theme
from workbench.app.docks.plots import LogarithmicAxis, calm, paint_axes
from workbench.core.arrays import Floats

DECADES = 6.0
"""In sight at most: what leads to infinity is cut off."""


class PathPlot(pg.PlotWidget):  # type: ignore[misc]
    """Standing curves over one abscissa; `moved` carries the marker's new place."""

    moved = Signal(float)

    def __init__(self, abscissa: str, ordinate: str, names: tuple[str, ...], parent: QWidget | None = None) -> None:
        super().__init__(parent, axisItems={"left": LogarithmicAxis("left")})
        self.theme: Theme = LIGHT
        self._labels = (abscissa, ordinate)
        self.setMinimumSize(200, 130)
        item = self.getPlotItem()
        calm(item, self)
        item.showGrid(x=False, y=True, alpha=0.15)
        self._legend = item.addLegend(offset=(8, 4), labelTextSize="8pt", verSpacing=-4)
        self._legend.setZValue(20)
        self.curves = [item.plot([], [], name=name) for name in names]
        for depth, curve in enumerate(reversed(self.curves)):
            curve.setZValue(depth)  # the first lies above: where all are one it is the one to be seen
        self.marker = pg.InfiniteLine(0.0, angle=90, movable=True)
        self.dots = pg.ScatterPlotItem(size=8)
        self.addItem(self.marker, ignoreBounds=True)
        self.addItem(self.dots, ignoreBounds=True)
        self.marker.sigDragged.connect(lambda line: self.moved.emit(float(line.value())))
        self.scene().sigMouseClicked.connect(self._click)

    def set_theme(self, theme: Theme, colours: tuple[str, ...]) -> None:
        self.theme = theme
        self.setBackground(theme.view)
        item = self.getPlotItem()
        paint_axes(item, theme)
        item.setLabel("bottom", self._labels[0], color=theme.text)
        item.setLabel("left", self._labels[1], color=theme.text)
        self._legend.setLabelTextColor(theme.text)
        paper = QColor(theme.view)
        paper.setAlpha(215)
        self._legend.setBrush(paper)
        for curve, colour in zip(self.curves, colours, strict=True):
            curve.setPen(pg.mkPen(colour, width=2))
        for sample, label in self._legend.items:
            label.setText(label.text, color=theme.text)
            sample.update()
        self.marker.setPen(pg.mkPen(theme.text, width=1.5))
        self.marker.setHoverPen(pg.mkPen(theme.accent, width=3))
        self.dots.setPen(pg.mkPen(theme.view, width=1))
        self.dots.setBrush(pg.mkBrush(theme.text))

    def show_curves(self, x: Floats, ys: tuple[Floats, ...], is_logarithmic: bool) -> None:
        """Draw each curve (k,); what is not finite, or has no logarithm, is left out."""
        self.getPlotItem().setLogMode(x=False, y=is_logarithmic)
        seen = []
        for curve, y in zip(self.curves, ys, strict=True):
            good = np.isfinite(y) & ((y > 0) if is_logarithmic else True)
            curve.setData(x, np.where(good, y, np.nan), connect="finite")
            seen.append(y[good])
        values = np.concatenate(seen)
        if len(values):
            top = np.quantile(values, 0.99) if np.isinf(np.concatenate(ys)).any() else values.max()
            ends = np.array([values.min(), max(top, values.min())])
            if is_logarithmic:
                ends = np.log10(ends)
                ends[1] = min(ends[1], ends[0] + DECADES)
            self.setYRange(ends[0], ends[1] + max(1e-3, 0.05 * abs(ends[1])), padding=0.06)
        self.setXRange(float(x[0]), float(x[-1]), padding=0.02)
        self.marker.setBounds((float(x[0]), float(x[-1])))

    def mark(self, x: float, values: tuple[float, ...], is_logarithmic: bool) -> None:
        """Put the marker at `x`, and a dot on each curve that has a value there."""
        self.marker.setValue(x)
        good = [v for v in values if np.isfinite(v) and (v > 0 or not is_logarithmic)]
        self.dots.setData([x] * len(good), np.log10(good) if is_logarithmic and good else good)

    def _click(self, event: object) -> None:
        where = event.scenePos()  # type: ignore[attr-defined]
        box = self.getPlotItem().vb
        if box.sceneBoundingRect().contains(where):
            low, high = self.marker.bounds()
            self.moved.emit(min(max(float(box.mapSceneToView(where).x()), low), high))
