"""A live colour map on the target: one quantity, its colour bar, its mean and largest value."""

from __future__ import annotations

import numpy as np
from PySide6.QtWidgets import QDockWidget, QLabel, QVBoxLayout, QWidget

from workbench.app.anchor_tool import NavigationTool
from workbench.app.colour_bar import ColourBar
from workbench.app.quantities import ColourRange
from workbench.app.theme import Theme
from workbench.app.views.geometry import Geometry
from workbench.app.views.mesh_view import MeshView
from workbench.engine.messages import Snapshot


class ColourMapDock(QDockWidget):
    """Shows `Snapshot.fields[quantity]` on the target's own geometry."""

    def __init__(self, colour_range: ColourRange, theme: Theme, parent: QWidget | None = None) -> None:
        quantity = colour_range.quantity
        super().__init__(f"{quantity.label} {quantity.equation}", parent)
        self.setObjectName(f"map-{quantity.id}")
        self.setToolTip(quantity.formula)
        self.colour_range = colour_range
        self._edges = False
        body = QWidget(self)
        layout = QVBoxLayout(body)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        self.view = MeshView(theme, body)
        self.tool = NavigationTool(self.view)
        self.bar = ColourBar(colour_range, body)
        self.numbers = QLabel("", body)
        self.numbers.setContentsMargins(10, 0, 10, 3)
        self.numbers.setAutoFillBackground(True)
        layout.addWidget(self.view, 1)
        layout.addWidget(self.bar)
        layout.addWidget(self.numbers)
        self.setWidget(body)
        self.set_theme(theme)
        colour_range.changed.connect(self._apply_range)

    def set_theme(self, theme: Theme) -> None:
        self.view.set_theme(theme)
        self.bar.set_theme(theme)
        self.numbers.setStyleSheet(f"background: {theme.view}; color: {theme.faint};")

    def show_geometry(self, geometry: Geometry) -> None:
        self.view.show_geometry(geometry, edges=False)
        self.colour_range.forget()
        self._apply_range()

    def cost(self) -> float:
        """Seconds that drawing the view took last."""
        return self.view.canvas.seconds

    def clear(self) -> None:
        self.view.clear()
        self.numbers.setText("")

    def _apply_range(self) -> None:
        if self.view.surface is not None:
            self.view.surface.show_range(self.colour_range.low, self.colour_range.high)
            self.view.refresh()

    def show_snapshot(self, snapshot: Snapshot) -> None:
        """Take the colours of a map; the points were written already."""
        values = snapshot.fields.get(self.colour_range.quantity.id)
        if self.view.surface is None or values is None:
            return
        self.view.points_changed()
        self.view.fit_if_it_left(0.75 if snapshot.phase == "finished" else 0.45)
        self.view.surface.set_values(values, snapshot.inverted)
        finite = values[np.isfinite(values)] if not np.isfinite(values).all() else values
        if len(finite):
            least, mean, most = float(finite.min()), float(finite.mean(dtype=np.float64)), float(finite.max())
            self.numbers.setText(f"min {shown(least)}   mean {shown(mean)}   max {shown(most)}")
        self.view.refresh()


def shown(value: float) -> str:
    """Four digits; the largest numbers of single precision stand for infinity."""
    return "∞" if value > 1e30 else f"{value:.4g}"
