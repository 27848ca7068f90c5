"""A live colour map on the target: a quantity that is chosen in its title, its colour bar, some numbers."""

from __future__ import annotations

from PySide6.QtWidgets import QVBoxLayout, QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.colouring.colour_legend import ColourLegend
from workbench.app.docks.quantity_dock import QuantityDock
from workbench.app.handling.navigation_tool import NavigationTool
from workbench.app.quantities.quantity_book import QuantityBook
from workbench.app.views.geometry import Geometry
from workbench.app.views.mesh_view import MeshView
from workbench.engine.messages import Snapshot


class ColourMapDock(QuantityDock):
    """Shows the quantity on the target's own geometry."""

    def __init__(self, book: QuantityBook, quantity: str, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(book, quantity, parent=parent)
        self.setObjectName(f"map-{quantity}")
        body = QWidget(self)
        layout = QVBoxLayout(body)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        self.view = MeshView(theme, body)
        self.tool = NavigationTool(self.view)
        self.legend = ColourLegend(self.range, body)
        self.legend.bar.own_wanted.connect(self.set_own)
        layout.addWidget(self.view, 1)
        layout.addWidget(self.legend)
        self.setWidget(body)
        self.set_theme(theme)

    def set_theme(self, theme: Theme) -> None:
        self.view.set_theme(theme)
        self.legend.set_theme(theme)

    def show_geometry(self, geometry: Geometry) -> None:
        self.view.show_geometry(geometry, edges=False)
        self._show_range()

    def cost(self) -> float:
        """Seconds that drawing the view took last."""
        return self.view.canvas.seconds

    def clear(self) -> None:
        self.view.clear()
        self.legend.clear()

    def forget_values(self) -> None:
        self.legend.clear()

    def _show_range(self) -> None:
        self.legend.show_range(self.range)
        self.legend.bar.is_own = self.own_range is not None
        if self.view.surface is not None:
            self.view.surface.show_range(self.range)
            self.view.refresh()

    def show_snapshot(self, snapshot: Snapshot) -> None:
        """Take the colours of a map; the points were written already."""
        values = self.values_in(snapshot)
        if self.view.surface is None or values is None:
            return
        self.view.points_changed()
        self.view.fit_if_it_left(snapshot.phase)
        self.view.surface.set_values(values, snapshot.inverted)
        self.legend.show_values(values)
        self.view.refresh()
