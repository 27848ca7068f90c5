"""The energy along a step: the curve, the trials of the line search, the slope, the bound."""

from __future__ import annotations

import math

import numpy as np
import pyqtgraph as pg
from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QWidget

from workbench.app.appearance.theme import LIMITING, Theme
from workbench.app.docks.plots import calm, paint_axes
from workbench.core.dissection import Dissection

REACH = 1.1
"""Part of the curve that fits into the plot, in its longest trial: barriers go up for ever."""
MOST_NUMBERED = 12
"""Trials up to which each carries its number."""
MOST_ABOVE = 1.5
"""How far above the maps before and after the plot reaches, in what lies below them."""


class EnergyPlot(pg.PlotWidget):  # type: ignore[misc]
    """E(x + t d) over t; `place_chosen` carries the t under a dragged marker."""

    place_chosen = Signal(float)

    def __init__(self, theme: Theme, parent: QWidget) -> None:
        super().__init__(parent)
        self.setMinimumSize(320, 240)
        calm(self.getPlotItem(), self)
        self.setLabel("bottom", "t")
        self.setLabel("left", "E(x + t d)")
        self.curve = self.plot([], [])
        self.tangent = self.plot([], [])
        self.trials = self.plot([], [], pen=None, symbol="o", symbolSize=9)
        self.elsewhere = self.plot([], [], pen=None, symbol="o", symbolSize=8)
        self.accepted = self.plot([], [], pen=None, symbol="star", symbolSize=16)
        # its words stand along the line, on its left: the line is at the right end of the curve
        words = {"position": 0.45, "rotateAxis": (1, 0), "anchors": [(0.5, 1.0), (0.5, 1.0)], "movable": False}
        self.bound = pg.InfiniteLine(0.0, angle=90, label="a simplex inverts at t = {value:.4g}", labelOpts=words)
        self.marker = pg.InfiniteLine(0.0, angle=90, movable=True)
        for line in (self.bound, self.marker):
            self.addItem(line, ignoreBounds=True)
            line.hide()
        self.marker.sigPositionChanged.connect(lambda line: self.place_chosen.emit(float(line.value())))
        self._numbers: list[pg.TextItem] = []
        self._theme = theme
        self.legend = self.getPlotItem().addLegend(offset=(-8, 8), labelTextSize="8pt")
        self._named = {
            self.curve: "energy",
            self.tangent: "its slope at t = 0",
            self.trials: "trials, in their order",
            self.elsewhere: "trials off the line",
            self.accepted: "step taken",
        }
        self.set_theme(theme)

    def set_theme(self, theme: Theme) -> None:
        self._theme = theme
        self.setBackground(theme.view)
        paint_axes(self.getPlotItem(), theme)
        self.curve.setPen(pg.mkPen(theme.accent, width=2))
        self.tangent.setPen(pg.mkPen(theme.faint, width=1.2, style=Qt.PenStyle.DashLine))
        self.trials.setSymbolBrush(theme.curves[1])
        self.trials.setSymbolPen(theme.text)
        self.elsewhere.setSymbolBrush(theme.view)
        self.elsewhere.setSymbolPen(pg.mkPen(theme.curves[1], width=1.6))
        self.accepted.setSymbolBrush(theme.curves[2])
        self.accepted.setSymbolPen(theme.text)
        self.bound.setPen(pg.mkPen(LIMITING, width=2))
        self.bound.label.setColor(LIMITING)
        self.marker.setPen(pg.mkPen(theme.text, width=1.4, style=Qt.PenStyle.DotLine))
        self.marker.setHoverPen(pg.mkPen(theme.accent, width=3))
        paper = QColor(theme.view)
        paper.setAlpha(215)
        self.legend.setBrush(paper)  # above the curve where the two meet
        self._show_legend()
        for number in self._numbers:
            number.setColor(theme.text)

    def _show_legend(self) -> None:
        """Name what there is in this step."""
        self.legend.clear()
        for item, name in self._named.items():
            if len(item.getOriginalDataset()[0] if item.getOriginalDataset()[0] is not None else ()):
                self.legend.addItem(item, name)
                self.legend.items[-1][1].setText(name, color=self._theme.text, size="8pt")

    def _number_trials(self, step: Dissection) -> None:
        """1, 2, 3 … beside the trials, in the order in which they were made."""
        for number in self._numbers:
            self.removeItem(number)
        self._numbers = []
        if not 1 < len(step.trial_sizes) <= MOST_NUMBERED:
            return
        for row in np.flatnonzero(np.isfinite(step.trial_energies)).tolist():
            number = pg.TextItem(str(row + 1), color=self._theme.text, anchor=(-0.4, 0.5))
            number.setPos(step.trial_sizes[row], step.trial_energies[row])
            self.addItem(number, ignoreBounds=True)
            self._numbers.append(number)

    def show_step(self, step: Dissection) -> None:
        """Draw a step; the marker stands where it ends."""
        sizes, energies = step.curve_sizes, step.curve_energies
        good = np.isfinite(energies)
        self.curve.setData(sizes[good], energies[good])
        first = step.before.energy
        falls = np.array([0.0, sizes[-1]])
        self.tangent.setData(falls, first + step.slope * falls)
        on, finite = step.trial_on_line, np.isfinite(step.trial_energies)
        for item, rows in ((self.trials, on & finite), (self.elsewhere, ~on & finite)):
            item.setData(step.trial_sizes[rows], step.trial_energies[rows])
        taken = [step.step_size] if step.step_size > 0 else []
        self.accepted.setData(taken, [step.after.energy] * len(taken))
        self._number_trials(step)
        self._show_legend()
        has_bound = math.isfinite(step.bound) and step.bound <= 1.05 * float(sizes[-1])
        self.bound.setVisible(has_bound)
        if has_bound:
            self.bound.setValue(step.bound)
        self.setXRange(0.0, float(sizes[-1]), padding=0.03)
        self._fit_height(step, good)
        self.marker.show()
        self.marker.setBounds((0.0, float(sizes[-1])))
        self.marker.setValue(step.step_size)

    def _fit_height(self, step: Dissection, good: np.ndarray) -> None:
        longest = max(step.step_size, float(step.trial_sizes[step.trial_on_line].max(initial=0.0)))
        walked = step.curve_energies[good & (step.curve_sizes <= REACH * longest)]
        seen = np.concatenate([[step.before.energy, step.after.energy], walked])
        low, top = float(seen.min()), float(seen.max())
        level = max(step.before.energy, step.after.energy)
        if level > low:
            top = min(top, level + MOST_ABOVE * (level - low))
        span = max(top - low, 1e-9 * abs(low), 1e-300)
        self.setYRange(low - 0.08 * span, top + 0.08 * span, padding=0.0)
