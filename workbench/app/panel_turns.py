"""Drawing the small panels in turns, so that they never hold up the main views."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QObject, QTimer
from PySide6.QtWidgets import QWidget

SHARE = 2.0
"""Rest after a panel's turn, as a multiple of the time it took."""
LEAST_REST = 8
MOST_REST = 400


@dataclass
class Panel:
    """One panel: the widget decides whether it is to be seen, `draw` brings it up to date."""

    widget: QWidget
    draw: Callable[[], None]
    is_stale: bool = False


class PanelTurns(QObject):
    """One stale and visible panel at a time, then a rest that grows with what drawing costs."""

    def __init__(self) -> None:
        super().__init__()
        self.panels: list[Panel] = []
        self._next = 0
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(self._turn)

    def add(self, widget: QWidget, draw: Callable[[], None]) -> None:
        self.panels.append(Panel(widget, draw))

    def all_stale(self) -> None:
        """A newer map is there."""
        for panel in self.panels:
            panel.is_stale = True
        if not self._timer.isActive():
            self._timer.start(LEAST_REST)

    def draw_all(self) -> None:
        """Bring everything up to date now: for screenshots."""
        for panel in self.panels:
            panel.is_stale = False
            panel.draw()

    def stop(self) -> None:
        self._timer.stop()

    def _turn(self) -> None:
        count = len(self.panels)
        for offset in range(count):
            panel = self.panels[(self._next + offset) % count]
            if panel.is_stale and panel.widget.isVisible():
                self._next = (self._next + offset + 1) % count
                panel.is_stale = False
                begin = time.perf_counter()
                panel.draw()
                # the drawing itself comes with the next turn of the event loop: its end is seen from there
                QTimer.singleShot(0, self, lambda since=begin: self._rest_after(since))
                return

    def _rest_after(self, begin: float) -> None:
        if any(panel.is_stale and panel.widget.isVisible() for panel in self.panels):
            spent = 1e3 * (time.perf_counter() - begin)
            self._timer.start(int(min(max(SHARE * spent, LEAST_REST), MOST_REST)))
