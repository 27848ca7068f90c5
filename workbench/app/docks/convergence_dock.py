"""Live convergence curves: energy, gradient norm, inverted count, over iterations or seconds; marks of switches."""

from __future__ import annotations

import numpy as np
import pyqtgraph as pg
from PySide6.QtWidgets import QCheckBox, QComboBox, QDockWidget, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from workbench.app.docks.dock_title import DockTitle
from workbench.app.docks.plots import LogarithmicAxis, calm, paint_axes
from workbench.app.docks.switch_marks import SwitchMarks
from workbench.app.history import History
from workbench.app.switches import Switches
from workbench.app.theme import Theme
from workbench.core.arrays import Floats

CURVES = (("energy", "Energy"), ("gradient_norm", "Gradient"), ("inverted", "Inverted"))


MOST_BINS = 300
"""Of a curve; each keeps its least and its largest value."""


class ConvergenceDock(QDockWidget):
    """Three plots side by side with one abscissa; each is one standing curve, with a mark where something was switched."""

    def __init__(self, history: History, switches: Switches, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__("Convergence", parent)
        self.setObjectName("convergence")
        self.setTitleBarWidget(DockTitle(self, QLabel(self.windowTitle(), self)))
        self._history = history
        self._switches = switches
        body = QWidget(self)
        layout = QVBoxLayout(body)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        bar = QHBoxLayout()
        bar.setContentsMargins(8, 3, 8, 3)
        self.abscissa = QComboBox(body)
        self.abscissa.addItem("iterations", "iteration")
        self.abscissa.addItem("seconds", "seconds")
        self.abscissa.currentIndexChanged.connect(lambda _: self.refresh())
        self.logarithmic = QCheckBox("logarithmic", body)
        self.logarithmic.setChecked(True)
        self.logarithmic.toggled.connect(self._set_logarithmic)
        bar.setSpacing(6)
        bar.addWidget(QLabel("over ", body))
        bar.addWidget(self.abscissa)
        bar.addWidget(self.logarithmic)
        bar.addStretch(1)
        layout.addLayout(bar)
        self.graphics = pg.GraphicsLayoutWidget(body)
        self.graphics.setMinimumSize(290, 110)
        self.graphics.ci.layout.setContentsMargins(2, 2, 8, 2)
        self.graphics.ci.layout.setHorizontalSpacing(6)
        layout.addWidget(self.graphics, 1)
        self.setWidget(body)
        self._plots: list[pg.PlotItem] = []
        self.curves: list[pg.PlotDataItem] = []
        for column, (_, title) in enumerate(CURVES):
            axis = LogarithmicAxis("left")
            plot = self.graphics.addPlot(row=0, col=column, title=title, axisItems={"left": axis})
            calm(plot, self)
            plot.showGrid(x=False, y=True, alpha=0.2)
            curve = plot.plot([], [])
            self._plots.append(plot)
            self.curves.append(curve)
        self.marks = SwitchMarks(self.graphics, self._plots)
        self._set_logarithmic(True)
        self.set_theme(theme)

    def set_theme(self, theme: Theme) -> None:
        self.graphics.setBackground(theme.view)
        for plot, curve, colour, (_, title) in zip(self._plots, self.curves, theme.curves, CURVES, strict=True):
            curve.setPen(pg.mkPen(colour, width=1.6))
            plot.setTitle(title, color=theme.text, size="9pt")
            paint_axes(plot, theme)
        self.marks.set_theme(theme)

    def _set_logarithmic(self, wanted: bool) -> None:
        # a count may be 0 and has no logarithm
        for plot in self._plots[:2]:
            plot.setLogMode(x=False, y=wanted)
        self.refresh()

    def refresh(self) -> None:
        """Draw what the history holds now."""
        abscissa = self._history.column(self.abscissa.currentData())
        for curve, (name, _) in zip(self.curves, CURVES, strict=True):
            values = self._history.column(name)
            good = np.isfinite(values)
            if self.logarithmic.isChecked() and name != "inverted":
                good &= values > 0
            curve.setData(*thinned(abscissa[good], values[good]))
        # one point alone has no width of its own
        last = float(abscissa[-1]) if len(abscissa) else 0.0
        least_width = 1.0 if self.abscissa.currentData() == "iteration" else 1e-3
        whole = [(1.0, 0.0)] if self.abscissa.currentData() == "iteration" and last < 4 else None
        for plot in self._plots:
            plot.getAxis("bottom").setTickSpacing(levels=whole)
            plot.setXRange(float(abscissa[0]) if len(abscissa) else 0.0, max(last, least_width), padding=0.02)
        counts = self._history.column("inverted")
        most = float(counts.max()) if len(counts) else 0.0
        self._plots[2].setYRange(0.0, max(most, 1.0), padding=0.06)
        self.marks.show(self._switches, self.abscissa.currentData())
        self._fit_plots()
        # a count has no halves
        self._plots[2].getAxis("left").setTickSpacing(levels=[(1.0, 0.0)] if most < 4 else None)

    def _fit_plots(self) -> None:
        """Numbers of an axis that were wide once have pushed the plots out of a narrow view."""
        plots, room = self.graphics.ci, self.graphics.viewport().size()
        if plots.size().width() > room.width():
            plots.resize(room)


def thinned(abscissa: Floats, values: Floats) -> tuple[Floats, Floats]:
    """A curve (k,), (k,) with at most about two points a bin, its peaks kept.

    pyqtgraph's own thinning works once more at every change of the visible range.
    """
    width = -(-len(values) // MOST_BINS)
    if width <= 2:
        return abscissa, values
    whole = len(values) // width * width
    bins = values[:whole].reshape(-1, width)
    first = np.arange(0, whole, width)
    ends = np.sort(np.stack([first + bins.argmin(axis=1), first + bins.argmax(axis=1)], axis=1), axis=1).ravel()
    kept = np.concatenate([ends, np.arange(whole, len(values))])
    if kept[-1] != len(values) - 1:
        kept = np.append(kept, len(values) - 1)
    return abscissa[kept], values[kept]
