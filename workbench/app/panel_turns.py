"""Drawing the small panels in turns, so that they never hold up the main view."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QObject, QTimer
from PySide6.QtWidgets import QWidget

from workbench.app.views.mesh_view import MeshView

LEAST_REST = 0.016
"""Seconds between two turns at least."""
REST_FACTOR = 3.0
"""Rest after a turn, as a multiple of the time its drawing took: the main view comes first on large meshes."""
COMING_TO_REST = 60
"""Milliseconds without a new map after which panels that are still behind are drawn on their own."""

SOON = 1
"""Milliseconds from a picture of the main view to the panel's turn: the main view is painted first, by itself."""
BETWEEN = 15
"""Milliseconds between panels that catch up."""


@dataclass
class Panel:
    """One panel: `draw` brings it up to date; it is left alone while its widget is not to be seen."""

    widget: QWidget
    draw: Callable[[], None]
    cost: Callable[[], float]
    is_stale: bool = False


class PanelTurns(QObject):
    """After each picture of the main view one panel that is behind is drawn, in turn.

    A panel is drawn in a pass of its own: two short passes let the mouse and the timers in between.
    """

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self.panels: list[Panel] = []
        self.is_drawing = True
        self.rest_factor = REST_FACTOR
        self._next = 0
        self._not_before = 0.0
        self._is_due = False
        self._soon = QTimer(self)
        self._soon.setSingleShot(True)
        self._soon.setInterval(SOON)
        self._soon.timeout.connect(self._turn)
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.timeout.connect(self._catch_up)

    def add(self, widget: QWidget, draw: Callable[[], None], cost: Callable[[], float] = lambda: 0.0) -> None:
        """`cost` tells the seconds that the last drawing of the panel took."""
        self.panels.append(Panel(widget, draw, cost))

    def remove(self, widget: QWidget) -> None:
        """A panel is gone."""
        self.panels = [panel for panel in self.panels if panel.widget is not widget]

    def take_map(self) -> None:
        """A newer map goes to the main view: all panels are behind, one of them follows it."""
        for panel in self.panels:
            panel.is_stale = True
        self._is_due = True
        self._rest.start(COMING_TO_REST)

    def main_is_drawn(self) -> None:
        """The main view was painted: now a panel may follow."""
        if self._is_due and time.perf_counter() >= self._not_before:
            self._is_due = False
            self._soon.start()

    def all_stale(self) -> None:
        """Something but the map changed: draw all again when there is time."""
        for panel in self.panels:
            panel.is_stale = True
        self._rest.start(COMING_TO_REST)

    def draw_all(self) -> None:
        """Bring everything up to date now."""
        for panel in self.panels:
            panel.is_stale = False
            panel.draw()

    def stop(self) -> None:
        self._soon.stop()
        self._rest.stop()

    def _catch_up(self) -> None:
        self._turn()
        if self.is_drawing and any(panel.is_stale and panel.widget.isVisible() for panel in self.panels):
            self._rest.start(BETWEEN)

    def _turn(self) -> None:
        if not self.is_drawing:
            return
        count = len(self.panels)
        for offset in range(count):
            panel = self.panels[(self._next + offset) % count]
            if panel.is_stale and panel.widget.isVisible():
                self._next = (self._next + offset + 1) % count
                self._not_before = time.perf_counter() + max(LEAST_REST, self.rest_factor * panel.cost())
                panel.is_stale = False
                panel.draw()
                if isinstance(panel.widget, MeshView):
                    panel.widget.canvas.draw_now()
                return
