"""The live curves of a race: energy, relative error to the best, gradient norm, inverted simplices."""

from __future__ import annotations

from typing import Any

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Qt, QTimer
from PySide6.QtWidgets import QVBoxLayout, QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.docks.convergence_plots import thinned
from workbench.app.docks.plots import LogarithmicAxis, calm, paint_axes
from workbench.app.docks.switch_marks import SwitchMarks
from workbench.app.document.switches import Switch
from workbench.app.race.contestant_pane import colour_of
from workbench.app.race.race_model import RaceModel
from workbench.app.race.race_record import relative_errors
from workbench.core.arrays import Floats
from workbench.engine.race_messages import Axis

PLOTS = (
    ("energy", "Energy"),
    ("error", "Relative error to the best"),
    ("gradient_norm", "Gradient norm"),
    ("inverted", "Inverted simplices"),
)
AXIS_LABELS: dict[Axis, str] = {"iteration": "iterations", "seconds": "seconds of its own"}
HEIGHTS = (5, 5, 5, 4)
"""Of the plots, to each other: the last is mostly a line at 0."""
THINNEST, WIDER = 1.5, 0.9
"""Width of the last contestant's curve in pixels, and how much wider each one before it is."""
INTERVAL = 400
"""Milliseconds between two pictures of the curves."""


class RaceCurves(QWidget):
    """Four plots with one abscissa; a standing curve and a row of markers for each contestant."""

    def __init__(self, model: RaceModel, theme: Theme, parent: QWidget) -> None:
        super().__init__(parent)
        self._model = model
        self.axis: Axis = "iteration"
        self.is_logarithmic = {"x": False, "y": True}
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        self.graphics = pg.GraphicsLayoutWidget(self)
        self.graphics.ci.layout.setContentsMargins(2, 2, 10, 2)
        self.graphics.ci.layout.setVerticalSpacing(2)
        layout.addWidget(self.graphics)
        self._plots: list[pg.PlotItem] = []
        self._cursors: list[pg.InfiniteLine] = []
        for row, (_, title) in enumerate(PLOTS):
            axes = {"left": LogarithmicAxis("left"), "bottom": LogarithmicAxis("bottom")}
            plot = self.graphics.addPlot(row=row, col=0, title=title, axisItems=axes)
            calm(plot, self)
            plot.getAxis("left").setWidth(52)
            plot.showGrid(x=False, y=True, alpha=0.2)
            cursor = pg.InfiniteLine(0.0, angle=90)
            cursor.hide()
            plot.addItem(cursor, ignoreBounds=True)
            self._plots.append(plot)
            self._cursors.append(cursor)
            self.graphics.ci.layout.setRowStretchFactor(row, HEIGHTS[row])
        self._name_axis()
        self.curves: dict[tuple[str, int], pg.PlotDataItem] = {}
        self.markers: dict[tuple[str, int], pg.PlotDataItem] = {}
        self._marks = SwitchMarks(self.graphics, self._plots)
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(INTERVAL)
        self._timer.timeout.connect(self.refresh)
        self.set_theme(theme)
        model.told.connect(lambda _: self.make_stale())
        model.seek_changed.connect(self._show_cursor)

    def make_curves(self) -> None:
        """As many as there are contestants now."""
        for item in (*self.curves.values(), *self.markers.values()):
            for plot in self._plots:
                plot.removeItem(item)
        self.curves, self.markers = {}, {}
        for plot, (name, _) in zip(self._plots, PLOTS, strict=True):
            count = len(self._model.records)
            for index in range(count):
                colour = colour_of(index)
                # where curves are one, those below show at the sides
                width = THINNEST + WIDER * (count - 1 - index)
                self.curves[name, index] = plot.plot([], [], pen=pg.mkPen(colour, width=width))
                self.markers[name, index] = plot.plot(
                    [], [], pen=None, symbol="d", symbolSize=11, symbolBrush=colour, symbolPen=pg.mkPen("w", width=1)
                )
        self._apply_log()

    def set_theme(self, theme: Theme) -> None:
        self._theme, self._error_title = theme, ""
        self.graphics.setBackground(theme.view)
        self._marks.set_theme(theme)
        for plot, cursor, (_, title) in zip(self._plots, self._cursors, PLOTS, strict=True):
            plot.setTitle(title, color=theme.text, size="9pt")
            paint_axes(plot, theme)
            cursor.setPen(pg.mkPen(theme.accent, width=1.2, style=Qt.PenStyle.DashLine))

    # ------------------------------------------------------------------------------------------ choices

    def show_axis(self, axis: Axis) -> None:
        self.axis = axis
        self._name_axis()
        self.refresh()

    def set_logarithmic(self, side: str, wanted: bool) -> None:
        """Of the sides `x` and `y`."""
        self.is_logarithmic[side] = wanted
        self._apply_log()
        self.refresh()

    def _name_axis(self) -> None:
        self._plots[-1].setLabel("bottom", AXIS_LABELS[self.axis])

    def _apply_log(self) -> None:
        for plot, (name, _) in zip(self._plots, PLOTS, strict=True):
            # a count may be 0 and has no logarithm
            plot.setLogMode(x=self.is_logarithmic["x"], y=self.is_logarithmic["y"] and name != "inverted")

    # ------------------------------------------------------------------------------------------ drawing

    def make_stale(self) -> None:
        if not self._timer.isActive():
            self._timer.start()

    def stop(self) -> None:
        self._timer.stop()

    def values(self, name: str) -> list[Floats]:
        """One of the plots: for each contestant a value for each row."""
        records = self._model.records
        if name == "error":
            return relative_errors(records, self._model.mesh, self._model.total_measure)
        return [record.history.column(name) for record in records]

    def refresh(self) -> None:
        """Draw what is known now."""
        if not self.curves or len(self.curves) != len(PLOTS) * len(self._model.records):
            return
        records = self._model.records
        abscissas = [record.history.column(self.axis) for record in records]
        for plot, (name, _) in zip(self._plots, PLOTS, strict=True):
            for index, (x, y) in enumerate(zip(abscissas, self.values(name), strict=True)):
                frame = records[index].frame
                marks = [marker.index for marker in frame.markers if marker.index < len(x)] if frame is not None else []
                self._set(self.curves[name, index], name, x, y, is_given=records[index].entrant.map is not None)
                self._set(self.markers[name, index], name, x[marks], y[marks])
            self._show_range(plot, name, abscissas)
        self._say_why_empty()
        self._show_cursor()
        # the lines know no logarithms
        self._marks.show([] if self.is_logarithmic["x"] else self._switches(), self.axis)

    def _say_why_empty(self) -> None:
        """The title of the errors, or why there are none to draw; short, since no plot is narrower than its title."""
        errors = self.values("error")
        known = [values[np.isfinite(values)] for values in errors]
        title = dict(PLOTS)["error"]
        if not any(len(values) for values in known):
            title = "Relative error: anchors not in place"
        elif self.is_logarithmic["y"] and not any((values > 0).any() for values in known):
            title = "Relative error: 0 for all so far"
        if title != self._error_title:
            self._error_title = title
            row = [name for name, _ in PLOTS].index("error")
            self._plots[row].setTitle(title, color=self._theme.text, size="9pt")

    def _switches(self) -> list[Switch]:
        """Whatever was switched, and by whom, in the order of the axis."""
        found = []
        for record in self._model.records:
            for marker in record.frame.markers if record.frame is not None else ():
                words = f"{record.label}: {marker.sentence}"
                found.append(Switch(marker.index, marker.iteration, marker.seconds, words))
        return sorted(found, key=lambda switch: float(getattr(switch, self.axis)))

    def _set(self, item: pg.PlotDataItem, name: str, x: Floats, y: Floats, *, is_given: bool = False) -> None:
        if is_given and len(x) == 1:  # a map from elsewhere is a level line
            end = max(self._end(), 1e-3)
            x, y = np.array([1e-6 * end if self.is_logarithmic["x"] else 0.0, end]), np.repeat(y, 2)
        good = np.isfinite(y)
        if self.is_logarithmic["y"] and name != "inverted":
            good &= y > 0
        if self.is_logarithmic["x"]:
            good &= x > 0
        x, y = x[good], y[good]
        item.setData(*(thinned(x, y) if len(x) else (x, y)))

    def _end(self) -> float:
        return self._model.end_of(self.axis)

    def _show_range(self, plot: Any, name: str, abscissas: list[Floats]) -> None:
        least = 1.0 if self.axis == "iteration" else 1e-3
        last = max(self._end(), least)
        if self.is_logarithmic["x"]:
            first = min((float(x[x > 0].min()) for x in abscissas if (x > 0).any()), default=0.1 * last)
            plot.setXRange(np.log10(min(first, 0.5 * last)), np.log10(last), padding=0.02)
        else:
            plot.setXRange(0.0, last, padding=0.02)
        if name in ("energy", "gradient_norm") and self.is_logarithmic["y"]:
            # a start at rest has rounding alone, beside which all else would be a line
            every = [values[np.isfinite(values) & (values > 0)] for values in self.values(name)]
            least = min((float(values[len(values) > 2 :].min()) for values in every if len(values)), default=0.0)
            most = max((float(values.max()) for values in every if len(values)), default=0.0)
            if least > 0:
                plot.setYRange(np.log10(least), np.log10(1.0001 * most), padding=0.06)
        if name == "inverted":
            most = max((float(values.max()) for values in self.values(name) if len(values)), default=0.0)
            plot.setYRange(0.0, max(most, 1.0), padding=0.06)
            plot.getAxis("left").setTickSpacing(levels=[(1.0, 0.0)] if most < 4 else None)

    def _show_cursor(self) -> None:
        seek = self._model.seek
        is_shown = not self._model.is_live and seek.axis == self.axis
        for cursor in self._cursors:
            cursor.setVisible(is_shown)
            if is_shown:
                cursor.setValue(np.log10(max(seek.place, 1e-12)) if self.is_logarithmic["x"] else seek.place)
