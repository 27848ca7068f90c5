"""A live colour map on the target: a quantity that is chosen in its title, its colour bar, some numbers."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QDockWidget, QVBoxLayout, QWidget

from workbench.app.anchor_tool import NavigationTool
from workbench.app.colour_legend import ColourLegend
from workbench.app.docks.dock_title import DockTitle
from workbench.app.quantity_book import QuantityBook
from workbench.app.quantity_chooser import QuantityChooser
from workbench.app.theme import Theme
from workbench.app.views.geometry import Geometry
from workbench.app.views.mesh_view import MeshView
from workbench.engine.messages import Snapshot


class ColourMapDock(QDockWidget):
    """Shows `Snapshot.fields[quantity]` on the target's own geometry; `quantity_changed` tells that it is another one."""

    quantity_changed = Signal()

    def __init__(self, book: QuantityBook, quantity: str, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName(f"map-{quantity}")
        self._book = book
        self.range = book.range_of(quantity)
        body = QWidget(self)
        layout = QVBoxLayout(body)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        self.view = MeshView(theme, body)
        self.tool = NavigationTool(self.view)
        self.legend = ColourLegend(self.range, body)
        layout.addWidget(self.view, 1)
        layout.addWidget(self.legend)
        self.setWidget(body)
        self.chooser = QuantityChooser(book, quantity, parent=self)
        self.chooser.chosen.connect(self.show_quantity)
        self.setTitleBarWidget(DockTitle(self, self.chooser))
        self.setWindowTitle(self.range.quantity.title)
        self.set_theme(theme)
        book.range_changed.connect(self._range_changed)

    @property
    def quantity(self) -> str:
        """Id of what is shown."""
        return self.range.quantity.id

    def show_quantity(self, id: str) -> None:
        """Colour by another quantity; its values come with the next snapshot."""
        self.range = self._book.range_of(id)
        self.chooser.show_choice(id)
        self.setWindowTitle(self.range.quantity.title)
        self.legend.clear()
        self._apply_range()
        self.quantity_changed.emit()

    def set_theme(self, theme: Theme) -> None:
        self.view.set_theme(theme)
        self.legend.set_theme(theme)

    def show_geometry(self, geometry: Geometry) -> None:
        self.view.show_geometry(geometry, edges=False)
        self._apply_range()

    def cost(self) -> float:
        """Seconds that drawing the view took last."""
        return self.view.canvas.seconds

    def clear(self) -> None:
        self.view.clear()
        self.legend.clear()

    def _range_changed(self, id: str) -> None:
        if id == self.quantity:
            self.setWindowTitle(self.range.quantity.title)
            self._apply_range()

    def _apply_range(self) -> None:
        self.legend.show_range(self.range)
        if self.view.surface is not None:
            self.view.surface.show_range(self.range)
            self.view.refresh()

    def show_snapshot(self, snapshot: Snapshot) -> None:
        """Take the colours of a map; the points were written already."""
        values = snapshot.fields.get(self.range.quantity.field)
        if self.view.surface is None or values is None:
            return
        self.view.points_changed()
        self.view.fit_if_it_left(0.75 if snapshot.phase == "finished" else 0.45)
        self.view.surface.set_values(values, snapshot.inverted)
        self.legend.show_values(values)
        self.view.refresh()
