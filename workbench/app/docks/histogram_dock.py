"""Live histogram of a quantity: how many simplices, or how much area, has which value; and a brush over its bins."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import Signal
from PySide6.QtGui import QColor
from PySide6.QtWidgets import QMenu, QToolButton, QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.colouring.range_menu import fill_range_menu
from workbench.app.docks.plot_place import PlotPlace
from workbench.app.docks.quantity_dock import QuantityDock
from workbench.app.quantities.quantities import CONFORMAL_FACTOR
from workbench.app.quantities.quantity_book import QuantityBook
from workbench.app.simplex_brush import SimplexBrush
from workbench.core.arrays import Floats, Integers
from workbench.core.histogram import bin_edges, bin_of, weight_in_bins
from workbench.core.mesh import Mesh
from workbench.engine.messages import Snapshot

if TYPE_CHECKING:
    from workbench.app.docks.histogram_plot import HistogramPlot

BINS = 64
ORIGIN = "histogram"
SMALLEST_PART = 0.3
"""Where counts are logarithmic the axis begins at this part of the smallest bar that there can be."""


class HistogramDock(QuantityDock):
    """Bars over the quantity's colour range, in its colours; the part of the brushed simplices in that of the brush.

    `redraw_wanted` tells that something but the map changed.
    """

    redraw_wanted = Signal()

    def __init__(self, book: QuantityBook, brush: SimplexBrush, theme: Theme, parent: QWidget | None = None) -> None:
        self._menu = QToolButton()
        super().__init__(book, CONFORMAL_FACTOR.id, (self._menu,), parent)
        self.setObjectName("histogram")
        self._brush = brush
        self.is_weighted = False
        self.has_logarithmic_counts = False
        self.counts = np.zeros(0)
        self.brushed_counts = np.zeros(0)
        self._bins: Integers = np.zeros(0, np.int64)
        self._mesh: Mesh | None = None
        self._areas: Floats | None = None
        self.place = PlotPlace(self._make_plot, (200, 120), self)
        self.place.made.connect(self.redraw_wanted)
        self.setWidget(self.place)
        self._make_menu()
        brush.changed.connect(self._show_brush)
        self.clear()
        self.set_theme(theme)

    def _make_plot(self, parent: QWidget) -> HistogramPlot:
        from workbench.app.docks.histogram_plot import HistogramPlot

        plot = HistogramPlot(parent)
        plot.brush.dragged.connect(self._brush_between)
        plot.brush.clicked.connect(self._brush.clear)
        return plot

    @property
    def plot(self) -> HistogramPlot:
        """The bars, made when they are first asked for."""
        plot: HistogramPlot = self.place.plot
        return plot

    def _make_menu(self) -> None:
        button = self._menu
        button.setText("⋯")
        button.setToolTip("Weights, scales and range of the histogram")
        button.setAutoRaise(True)
        button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        menu = QMenu(button)
        menu.aboutToShow.connect(partial(self._fill_menu, menu))
        button.setMenu(menu)
        button.setStyleSheet("QToolButton::menu-indicator { image: none; }")

    def _fill_menu(self, menu: QMenu) -> None:
        menu.clear()
        for text, is_on, deed in (
            (f"Weighted by {self._measured} of the source", self.is_weighted, self.set_weighted),
            ("Logarithmic counts", self.has_logarithmic_counts, self.set_logarithmic_counts),
        ):
            action = menu.addAction(text)
            action.setCheckable(True)
            action.setChecked(is_on)
            action.toggled.connect(deed)
        menu.addSeparator()
        fill_range_menu(menu, self.range, self)

    # ------------------------------------------------------------------------------------------ choices

    def set_weighted(self, weighted: bool) -> None:
        """Weigh simplices by their measure in the source, or count them."""
        self.is_weighted = weighted
        self.redraw_wanted.emit()

    def set_logarithmic_counts(self, logarithmic: bool) -> None:
        self.has_logarithmic_counts = logarithmic
        self.redraw_wanted.emit()

    def set_mesh(self, mesh: Mesh | None) -> None:
        """Take the source whose simplices are weighed."""
        self._mesh, self._areas = mesh, None

    def set_theme(self, theme: Theme) -> None:
        self.place.set_theme(theme)

    # ------------------------------------------------------------------------------------------ showing

    def clear(self) -> None:
        self.counts = self.brushed_counts = np.zeros(0)
        self._bins = np.zeros(0, np.int64)
        if self.place.is_made:
            self.plot.show_nothing()

    def show_snapshot(self, snapshot: Snapshot) -> None:
        values = self.values_in(snapshot)
        if values is None or not len(values):
            return
        low, high, logarithmic = self.range.low, self.range.high, self.range.is_logarithmic
        self._bins = bin_of(values, low, high, BINS, logarithmic=logarithmic)
        self.counts = weight_in_bins(self._bins, BINS, self._weights())
        if self.place.is_made:
            self._draw()

    def _draw(self) -> None:
        """The bars of what is counted."""
        logarithmic, plot = self.range.is_logarithmic, self.plot
        edges = bin_edges(self.range.low, self.range.high, BINS, logarithmic=logarithmic)
        if logarithmic:
            edges = np.log10(edges)
        plot.set_logarithmic(logarithmic, self.has_logarithmic_counts)
        colours = (self.range.colours(BINS) * 255).astype(int)
        plot.show_bars(edges, self._heights(self.counts), self._bottom(), [QColor(*colour) for colour in colours.tolist()])
        self._show_brush()
        centre = self.range.centre
        plot.show_centre(None if centre is None else float(np.log10(centre)) if logarithmic else centre)
        plot.getPlotItem().setLabel("left", self._measured if self.is_weighted else "simplices")

    @property
    def _measured(self) -> str:
        """What simplices are weighed by."""
        return "volume" if self._mesh is not None and self._mesh.dimension == 3 else "area"

    def _weights(self) -> Floats | None:
        if not self.is_weighted or self._mesh is None or self._mesh.simplex_count != len(self._bins):
            return None
        if self._areas is None:
            from workbench.core.jacobians import simplex_measures

            self._areas = simplex_measures(self._mesh)
        return self._areas

    def _heights(self, counts: Floats) -> Floats:
        """Heights on the axis: logarithms, where counts are shown so; empty bins stand at the bottom."""
        if not self.has_logarithmic_counts:
            return counts
        return np.log10(np.maximum(counts, 10.0 ** self._bottom()))

    def _bottom(self) -> float:
        if not self.has_logarithmic_counts:
            return 0.0
        weights = self._weights()
        smallest = 1.0 if weights is None else float(weights.min())
        return float(np.log10(SMALLEST_PART * max(smallest, 1e-300)))

    def forget_values(self) -> None:
        self.clear()

    def _show_range(self) -> None:
        self.redraw_wanted.emit()

    def _set_title(self) -> None:
        self.setWindowTitle(f"Histogram: {self.range.quantity.title}")

    # ------------------------------------------------------------------------------------------ brush

    def _show_brush(self) -> None:
        """The part of each bar that belongs to brushed simplices."""
        chosen = self._brush.simplices
        chosen = chosen[chosen < len(self._bins)]
        weights = self._weights()
        self.brushed_counts = weight_in_bins(self._bins[chosen], BINS, None if weights is None else weights[chosen])
        if self.place.is_made and len(self._bins):
            self.plot.show_marked(self._heights(self.brushed_counts) if len(chosen) else None, self._bottom())

    def _brush_between(self, begin: float, end: float) -> None:
        """Brush the simplices of the bins from one place of the axis to another."""
        if not len(self._bins):
            return
        scale = np.array([self.range.scaled(self.range.low), self.range.scaled(self.range.high)])
        places = np.array([begin, end]) * (np.log(10.0) if self.range.is_logarithmic else 1.0)
        first, last = np.clip((places - scale[0]) * (BINS / (scale[1] - scale[0])), 0, BINS - 1).astype(int)
        self._brush.brush(np.flatnonzero((self._bins >= first) & (self._bins <= last)), ORIGIN)
