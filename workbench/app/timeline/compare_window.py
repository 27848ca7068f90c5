"""Two moments against each other: flipped in place, or as a difference with a colour bar of its own."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QKeyEvent, QResizeEvent
from PySide6.QtWidgets import QCheckBox, QComboBox, QDialog, QHBoxLayout, QLabel, QPushButton, QVBoxLayout, QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.colouring.colour_legend import ColourLegend
from workbench.app.colouring.colour_range import ColourRange
from workbench.app.handling.navigation_tool import NavigationTool
from workbench.app.quantities.quantities import Quantity
from workbench.app.quantities.quantity_book import QuantityBook
from workbench.app.quantities.quantity_chooser import QuantityChooser
from workbench.app.race.difference import difference_to, displacement_from
from workbench.app.timeline.comparison import Comparison
from workbench.app.views.arrow_layer import ArrowLayer
from workbench.app.views.geometry import Geometry
from workbench.app.views.mesh_view import MeshView
from workbench.core.arrays import Integers

MODES = {"maps": "A or B, flipped", "difference": "Difference, B less A", "displacement": "Displacement from A"}


class CompareWindow(QDialog):
    """Shows a `Comparison`; `wanted` tells that another quantity is asked for, or the moments anew."""

    wanted = Signal()

    def __init__(self, book: QuantityBook, quantity: str, theme: Theme, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Two moments")
        self.setWindowFlag(Qt.WindowType.WindowMinMaxButtonsHint)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.resize(760, 680)
        self._book = book
        self._is_closed = False
        self._geometry: Geometry | None = None
        self._simplices: Integers | None = None
        self.comparison: Comparison | None = None
        self.view = MeshView(theme, self)
        self._own_camera = self.view.camera
        self.tool = NavigationTool(self.view)
        self.arrows = ArrowLayer(self.view)
        self.chooser = QuantityChooser(book, quantity, parent=self)
        self.chooser.chosen.connect(self._choose)
        self.mode = QComboBox(self)
        for id, text in MODES.items():
            self.mode.addItem(text, id)
        self.mode.setCurrentIndex(1)
        self.mode.currentIndexChanged.connect(lambda _: self._show())
        self.flip = QPushButton("Flip", self)
        self.flip.setCheckable(True)
        self.flip.setAutoDefault(False)
        self.flip.setToolTip("The map of A, or that of B (X)")
        self.flip.toggled.connect(lambda _: self._show())
        self.with_arrows = QCheckBox("Arrows", self)
        self.with_arrows.setToolTip("From where A has the vertices to where B has them")
        self.with_arrows.toggled.connect(lambda _: self._show_arrows())
        self.range = ColourRange(book[quantity])
        self.legend = ColourLegend(self.range, self)
        self.words = QLabel("Measuring…", self)
        self.words.setWordWrap(True)
        self.words.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self._lay_out()
        self.set_theme(theme)

    def _lay_out(self) -> None:
        row = QHBoxLayout()
        for part in (QLabel("Colour by", self), self.chooser, self.mode, self.flip, self.with_arrows):
            row.addWidget(part)
        layout = QVBoxLayout(self)
        layout.addLayout(row)
        layout.addWidget(self.view, 1)
        layout.addWidget(self.legend)
        layout.addWidget(self.words)

    def set_theme(self, theme: Theme) -> None:
        self.view.set_theme(theme)
        self.legend.set_theme(theme)

    @property
    def quantity(self) -> Quantity:
        return self._book[self.chooser.current]

    def _choose(self, id: str) -> None:
        self.chooser.show_choice(id)
        self.wanted.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if event.key() == Qt.Key.Key_X:
            self.flip.toggle()
        else:
            super().keyPressEvent(event)

    # ------------------------------------------------------------------------------------------ showing

    def show_comparison(self, comparison: Comparison, simplices: Integers) -> None:
        """Take two moments; a camera that somebody moved stays where it is while they are of the same mesh."""
        self.comparison = comparison
        if self._geometry is None or self._simplices is not simplices:
            self._geometry, self._simplices = Geometry(comparison.maps[0], simplices), simplices
            self.view.show_geometry(self._geometry, edges=False)
            self._own_camera = self.view.camera
        self.words.setText(comparison.sentence)
        self._show()
        if self.view.camera is self._own_camera:
            self._fit_both()

    def _fit_both(self) -> None:
        """Both maps fit: flipped, neither leaves the view, and it does not move."""
        assert self.comparison is not None and self._geometry is not None
        points = np.concatenate([self._geometry.frame.to_display(positions) for positions in self.comparison.maps])
        self._own_camera = self.view.camera.fitted(points, self.view.size_in_pixels)
        self.view.set_camera(self._own_camera)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        if self._geometry is not None and self.view.camera is self._own_camera:
            self._fit_both()

    def _show(self) -> None:
        """Map, colours and bar of the mode; of a difference the map of B is coloured unless it is flipped."""
        comparison, geometry, surface = self.comparison, self._geometry, self.view.surface
        if comparison is None or geometry is None or surface is None:
            return
        mode = str(self.mode.currentData())
        which = 0 if self.flip.isChecked() else 1
        if mode == "maps":
            quantity, values = self.quantity, comparison.values[which]
            fitted = np.concatenate(comparison.values)
        elif mode == "difference":
            quantity, values = difference_to("A", self.quantity), comparison.difference
            fitted = values
        else:
            quantity, values = displacement_from("A"), comparison.distances
            fitted = values
        self.range = ColourRange(quantity)
        self.range.take(fitted[np.isfinite(fitted)])
        geometry.write(comparison.maps[which])
        self.view.points_changed()
        surface.show_range(self.range)
        surface.set_values(values, comparison.inverted[which])
        self.legend.show_range(self.range)
        self.legend.show_values(values)
        self.setWindowTitle(f"Two moments: {'AB'[which]}, {quantity.title}")
        self._show_arrows()
        self.view.refresh()

    def _show_arrows(self) -> None:
        comparison, geometry = self.comparison, self._geometry
        if comparison is None or geometry is None or not self.with_arrows.isChecked():
            self.arrows.show_arrows(np.empty((0, 3)), np.empty((0, 3)))
            return
        begins, ends = (geometry.frame.to_display(positions) for positions in comparison.maps)
        self.arrows.show_arrows(begins, ends - begins)

    def done(self, result: int) -> None:
        self.close_view()
        super().done(result)

    def close_view(self) -> None:
        """Give the graphics memory back."""
        if not self._is_closed:
            self._is_closed = True
            self.view.close_view()
