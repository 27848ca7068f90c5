"""Work on a thread of which only the newest piece matters."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QObject, Signal

from workbench.app.background import Background


class Latest(QObject):
    """Runs one piece of work at a time; what was asked for meanwhile is replaced by what is asked for later.

    `done` carries each result, `failed` each exception, in the GUI thread.
    """

    done = Signal(object)
    failed = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._running: Background | None = None
        self._waiting: Callable[[], Any] | None = None

    @property
    def is_busy(self) -> bool:
        return self._running is not None

    def ask(self, work: Callable[[], Any]) -> None:
        """Run `work` as soon as the piece under way is done."""
        if self._running is not None:
            self._waiting = work
            return
        self._running = Background(work, self)
        self._running.finished.connect(self._finish)
        self._running.failed.connect(self._fail)
        self._running.start()

    def wait(self) -> None:
        """Drop what waits and let the thread end, before the window does."""
        self._waiting = None
        if self._running is not None:
            self._running.wait()

    def _finish(self, result: Any) -> None:
        self._go_on()
        self.done.emit(result)

    def _fail(self, error: Exception) -> None:
        self._go_on()
        self.failed.emit(error)

    def _go_on(self) -> None:
        if self._running is not None:
            self._running.deleteLater()
        self._running = None
        work, self._waiting = self._waiting, None
        if work is not None:
            self.ask(work)
