"""Plots side by side with one abscissa: each is one standing curve, with marks across all of them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np
import pyqtgraph as pg
from PySide6.QtWidgets import QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.docks.plots import LogarithmicAxis, calm, paint_axes
from workbench.app.docks.switch_marks import SwitchMarks
from workbench.app.document.switches import Switch
from workbench.core.arrays import Floats

MOST_BINS = 300
"""Of a curve; each keeps its least and its largest value."""


class ConvergencePlots(pg.GraphicsLayoutWidget):  # type: ignore[misc]
    """Of the columns with these titles, the last is a count."""

    def __init__(self, titles: Sequence[str], parent: QWidget) -> None:
        super().__init__(parent)
        self.ci.layout.setContentsMargins(2, 2, 8, 2)
        self.ci.layout.setHorizontalSpacing(6)
        self._titles = titles
        self._is_logarithmic = False
        self.plots: list[pg.PlotItem] = []
        self.curves: list[pg.PlotDataItem] = []
        for column, title in enumerate(titles):
            axis = LogarithmicAxis("left")
            plot = self.addPlot(row=0, col=column, title=title, axisItems={"left": axis})
            calm(plot, self)
            plot.showGrid(x=False, y=True, alpha=0.2)
            self.plots.append(plot)
            self.curves.append(plot.plot([], []))
        self.marks = SwitchMarks(self, self.plots)

    def set_theme(self, theme: Theme) -> None:
        self.setBackground(theme.view)
        for plot, curve, colour, title in zip(self.plots, self.curves, theme.curves, self._titles, strict=True):
            curve.setPen(pg.mkPen(colour, width=1.6))
            plot.setTitle(title, color=theme.text, size="9pt")
            paint_axes(plot, theme)
        self.marks.set_theme(theme)

    def set_logarithmic(self, wanted: bool) -> None:
        """All but the count, which may be 0 and has no logarithm."""
        self._is_logarithmic = wanted
        for plot in self.plots[:-1]:
            plot.setLogMode(x=False, y=wanted)

    def show_columns(self, abscissa: Floats, columns: Sequence[Floats], switches: Iterable[Switch], over: str) -> None:
        """Curves of `columns`, each (k,), over `abscissa` (k,), which is `over`: iteration or seconds."""
        for plot, curve, values in zip(self.plots, self.curves, columns, strict=True):
            good = np.isfinite(values)
            if self._is_logarithmic and plot is not self.plots[-1]:
                good &= values > 0
            curve.setData(*thinned(abscissa[good], values[good]))
        # one point alone has no width of its own
        last = float(abscissa[-1]) if len(abscissa) else 0.0
        least_width = 1.0 if over == "iteration" else 1e-3
        whole = [(1.0, 0.0)] if over == "iteration" and last < 4 else None
        for plot in self.plots:
            plot.getAxis("bottom").setTickSpacing(levels=whole)
            plot.setXRange(float(abscissa[0]) if len(abscissa) else 0.0, max(last, least_width), padding=0.02)
        counts = columns[-1]
        most = float(counts.max()) if len(counts) else 0.0
        self.plots[-1].setYRange(0.0, max(most, 1.0), padding=0.06)
        self.marks.show(switches, over)
        self._fit_plots()
        # a count has no halves
        self.plots[-1].getAxis("left").setTickSpacing(levels=[(1.0, 0.0)] if most < 4 else None)

    def _fit_plots(self) -> None:
        """Numbers of an axis that were wide once have pushed the plots out of a narrow view."""
        plots, room = self.ci, self.viewport().size()
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
