"""One function on a thread of its own, its result in the GUI thread."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QObject, Qt, Signal


class Background(QObject):
    """Runs `work` once; `finished` carries what it returned, `failed` the exception."""

    finished = Signal(object)
    failed = Signal(object)
    _arrived = Signal(object, object)

    def __init__(self, work: Callable[[], Any], parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._work = work
        self._is_silent = self._takes_too_long = False
        self._arrived.connect(self._report, Qt.ConnectionType.QueuedConnection)
        self._thread = threading.Thread(target=self._run, daemon=True)

    def start(self) -> None:
        """Begin, unless the part of the window that wanted it was closed meanwhile."""
        if not self._is_silent:
            self._thread.start()

    def wait(self, seconds: float = 10.0) -> None:
        """Let the thread end; one that was waited for in vain is not waited for again by whoever asks next."""
        if self._thread.is_alive() and not self._takes_too_long:
            self._thread.join(seconds)
            self._takes_too_long = self._thread.is_alive()

    def silence(self) -> None:
        """Let the thread end, and report nothing any more, not even what is on its way: what would show it is going."""
        self._is_silent = True  # a queued signal comes even where it was disconnected meanwhile
        self.wait()

    def _run(self) -> None:
        result: Any = None
        error: BaseException | None = None
        try:
            result = self._work()
        except (Exception, SystemExit) as caught:  # nobody above a thread: the window shows it; libraries exit, too
            error = caught
        try:
            self._arrived.emit(result, error)
        except RuntimeError:
            pass  # the window was closed meanwhile

    def _report(self, result: Any, error: BaseException | None) -> None:
        if self._is_silent:
            return
        if error is None:
            self.finished.emit(result)
        else:
            self.failed.emit(error)


class Backgrounds(QObject):
    """Works on threads that belong to one part of the window; its length is the number that has not ended."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._works: list[Background] = []

    def __len__(self) -> int:
        return len(self._works)

    def start(self, work: Callable[[], Any], done: Callable[[Any], None], fail: Callable[[Exception], None]) -> None:
        """Run `work`; then, in the GUI thread, `done` with what it returned or `fail` with what it raised."""
        background = Background(work, self)
        self._works.append(background)

        def end(finish: Callable[[Any], None], outcome: Any) -> None:
            self._works.remove(background)
            background.deleteLater()
            finish(outcome)

        background.finished.connect(lambda result: end(done, result))
        background.failed.connect(lambda error: end(fail, error))
        background.start()

    def wait(self) -> None:
        """Let the threads end before the window does."""
        for work in self._works:
            work.wait()


def silence_all(owner: QObject) -> None:
    """End the works of a part of the window, and of all its parts, before it is destroyed."""
    for work in owner.findChildren(Background):
        work.silence()
