"""One view of the grid: a contestant's map below its name and how it stands."""

from __future__ import annotations

import math

import numpy as np
from PySide6.QtCore import Signal
from PySide6.QtGui import QColor, QPainter, QPixmap
from PySide6.QtWidgets import QHBoxLayout, QLabel, QMenu, QToolButton, QVBoxLayout, QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.handling.navigation_tool import NavigationTool
from workbench.app.race.race_record import RaceRecord
from workbench.app.signatures.map_list import COLOURS
from workbench.app.status.status_line import ElidedLabel
from workbench.app.views.geometry import Geometry
from workbench.app.views.mesh_view import MeshView
from workbench.core.arrays import Floats
from workbench.engine.messages import SetAnchors

FAILED = "#d6332a"
"""Colour of words about what went wrong, on light and dark alike."""


def colour_of(index: int) -> QColor:
    """Colour of a contestant: of its swatch and its curves."""
    return QColor(COLOURS[index % len(COLOURS)])


def swatch_of(index: int) -> QPixmap:
    """The colour on a light rim, so that it is seen on every background."""
    swatch = QPixmap(12, 12)
    swatch.fill("white")
    painter = QPainter(swatch)
    painter.fillRect(1, 1, 10, 10, colour_of(index))
    painter.end()
    return swatch


class LinkedTool(NavigationTool):
    """Looks about in one view for all: what fits this one fits all."""

    fit_wanted = Signal()

    def double_click(self, event) -> None:  # type: ignore[no-untyped-def]
        self.fit_wanted.emit()


class ContestantPane(QWidget):
    """Title, view, and a menu of what can be done with the contestant."""

    switch_wanted = Signal(int)
    take_wanted = Signal(int)

    def __init__(self, index: int, theme: Theme, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("contestant")
        self.shown = index
        self.is_flipped = False
        self.is_reference = False
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        header = QHBoxLayout()
        header.setContentsMargins(8, 3, 4, 0)
        header.setSpacing(6)
        self.swatch = QLabel(self)
        self.name = ElidedLabel(self)
        font = self.name.font()
        font.setBold(True)
        self.name.setFont(font)
        self.phase = QLabel(self)
        self.menu_button = QToolButton(self)
        self.menu_button.setText("⋯")
        self.menu_button.setAutoRaise(True)
        self.menu_button.setPopupMode(QToolButton.ToolButtonPopupMode.InstantPopup)
        self.menu_button.setStyleSheet("QToolButton::menu-indicator { image: none; }")
        self.menu_button.setToolTip("Change this contestant, or keep its map")
        menu = QMenu(self.menu_button)
        self.switch_action = menu.addAction("Change solver or distortion…")
        self.switch_action.triggered.connect(lambda: self.switch_wanted.emit(self.shown))
        self.take_action = menu.addAction("Take this map")
        self.take_action.setToolTip("The document goes on from this map")
        self.take_action.triggered.connect(lambda: self.take_wanted.emit(self.shown))
        self.menu_button.setMenu(menu)
        header.addWidget(self.swatch)
        header.addWidget(self.name, 1)
        header.addWidget(self.phase)
        header.addWidget(self.menu_button)
        layout.addLayout(header)
        self.numbers = ElidedLabel(self)
        below = QHBoxLayout()
        below.setContentsMargins(8, 0, 6, 3)
        below.addWidget(self.numbers)
        layout.addLayout(below)
        self.view = MeshView(theme, self)
        self.view.paint_flat_maps()
        self.tool = LinkedTool(self.view)
        layout.addWidget(self.view, 1)
        self.geometry_shown: Geometry | None = None

    def set_theme(self, theme: Theme) -> None:
        self.view.set_theme(theme)
        self.numbers.setStyleSheet(f"color: {theme.faint};")

    # ------------------------------------------------------------------------------------------ content

    def show_mesh(self, geometry: Geometry, anchors: SetAnchors) -> None:
        """Another race: its start, in the frame that all views share."""
        self.geometry_shown = geometry
        self.view.show_geometry(self.geometry_shown)
        self._show_anchors(anchors)

    def _show_anchors(self, anchors: SetAnchors) -> None:
        """Discs at the targets of the map that is drawn, and where their vertices are."""
        assert self.geometry_shown is not None
        scene = self.view.overlay.scene
        scene.anchor_vertices = anchors.vertices
        scene.anchor_points = self.geometry_shown.frame.to_display(anchors.targets) if len(anchors.vertices) else _NOWHERE
        scene.vertex_points = self.geometry_shown.points[scene.anchor_vertices]

    def show_map(self, record: RaceRecord, values: Floats | None) -> None:
        """Draw the contestant's newest map now."""
        frame, surface = record.frame, self.view.surface
        if frame is None or frame.positions is None or surface is None or self.geometry_shown is None:
            return
        self.geometry_shown.write(frame.positions)
        self._show_anchors(record.anchors)
        self.view.points_changed()
        inverted = frame.inverted if frame.inverted is not None else np.zeros(len(self.geometry_shown.simplices), dtype=bool)
        surface.set_values(values, inverted)
        self.view.refresh()
        self.view.canvas.draw_now()

    def show_record(self, record: RaceRecord, is_running: bool) -> None:
        """Name, numbers and how it stands; whether the race runs now."""
        frame = record.frame
        self.swatch.setPixmap(swatch_of(self.shown))
        notes = {"flipped": self.is_flipped, "A, the reference": self.is_reference}
        said = "; ".join(note for note, holds in notes.items() if holds)
        self.name.setText(f"{record.label}  ({said})" if said else record.label)
        self.switch_action.setEnabled(frame is not None)
        self.take_action.setEnabled(frame is not None)
        if frame is None:
            self.phase.setText("")
            self.numbers.setText("")
            return
        self.phase.setText(_ending(frame.status) if frame.phase == "finished" else _phase(frame.phase, is_running))
        self.phase.setToolTip(frame.message)
        self.phase.setStyleSheet(f"color: {FAILED};" if frame.phase == "failed" else "")
        if frame.phase == "failed":
            self.numbers.setText(frame.message)
            return
        means, steps = record.history.column("mean_distortion"), record.history.column("iteration")
        place = min(int(np.searchsorted(steps, frame.iteration, side="right")), len(steps)) - 1
        mean = float(means[place]) if len(means) else math.nan
        inverted = f" · {frame.inverted_count} inverted" if frame.inverted_count else ""
        shown = f"{mean:.6g}" if math.isfinite(mean) else "∞"
        # a map of an earlier moment, beside how its solver stands now
        iteration = f"{frame.iteration} of {record.iterations}" if frame.iteration < record.iterations else f"{frame.iteration}"
        spent = f"iteration {iteration} · {frame.seconds:.2f} s · " if frame.phase != "given" else ""
        self.numbers.setText(f"{spent}mean {shown}{inverted}")


_NOWHERE = np.empty((0, 3))


def _phase(phase: str, is_running: bool) -> str:
    return "given map" if phase == "given" else "waiting" if phase == "running" and not is_running else phase


def _ending(status: str) -> str:
    return status.lower().replace("_", " ")
