"""Python's garbage collection, kept in the GUI thread."""

from __future__ import annotations

import gc

from PySide6.QtCore import QObject, QTimer

INTERVAL = 500
YOUNG = 700
MIDDLE = 20


class GuiGarbage(QObject):
    """Collects on a timer of the GUI thread, and nowhere else.

    The collector runs in whatever thread happens to allocate; Qt objects that it ends in the engine's thread crash the
    program. What exists at the start is frozen, so that a full collection stays short.
    """

    def __init__(self) -> None:
        super().__init__()
        gc.freeze()
        gc.disable()
        self._young = 0
        self._timer = QTimer(self)
        self._timer.setInterval(INTERVAL)
        self._timer.timeout.connect(self._collect)
        self._timer.start()

    def _collect(self) -> None:
        if gc.get_count()[0] < YOUNG:
            return
        self._young += 1
        gc.collect(1 if self._young % MIDDLE else 2)

    def end(self) -> None:
        """Back to Python's own ways."""
        self._timer.stop()
        gc.enable()
        gc.unfreeze()
