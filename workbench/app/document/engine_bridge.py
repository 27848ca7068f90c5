"""From the engine's worker thread to the window: reports become Qt signals of the GUI thread."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import Any, Protocol

from PySide6.QtCore import QObject, Qt, QTimer, Signal

from workbench.engine.head_start import BegunEngine
from workbench.engine.messages import (
    Command,
    Dissected,
    Failure,
    LegBegun,
    Loaded,
    LogLine,
    Progress,
    Ready,
    Refused,
    Report,
    Restarted,
    Snapshot,
)


class Worker(Protocol):
    """What the window needs of `workbench.engine.worker.EngineWorker`."""

    def start(self) -> None: ...
    def post(self, command: Command) -> None: ...
    def take(self) -> list[Report]: ...
    def stop(self) -> None: ...
    def close(self) -> None: ...


WorkerMaker = Callable[[Callable[[], None]], Worker]


def engine_worker(wake: Callable[[], None], begun: BegunEngine | None = None) -> Worker:
    """The real one: solving runs in a process of its own, which may have begun already."""
    from workbench.engine.worker import EngineWorker  # late: it is not needed for the first frame

    return EngineWorker(wake, gives_way=True, begun=begun)


class ReportBridge(QObject):
    """Owner of a worker. Each report becomes a signal in the GUI thread; they are taken at most once in 12 ms."""

    _woken = Signal()

    def __init__(self, make_worker: WorkerMaker) -> None:
        super().__init__()
        self._is_pending = False
        self._is_closed = False
        self._woken.connect(self._schedule, Qt.ConnectionType.QueuedConnection)
        self._pause = QTimer(self)
        self._pause.setSingleShot(True)
        self._pause.setInterval(12)
        self._pause.timeout.connect(self._rested)
        self._waits = False
        self._signals = self._signal_of_report()
        self._worker = make_worker(self._wake)

    def _signal_of_report(self) -> dict[type[Report], Any]:
        """The signal for each class of report; the others are dropped."""
        raise NotImplementedError

    def start(self) -> None:
        self._worker.start()

    def post(self, command: Command) -> None:
        if not self._is_closed:
            self._worker.post(command)

    def stop(self) -> None:
        """End whatever goes on in the process."""
        self._worker.stop()

    def close(self) -> None:
        if not self._is_closed:
            self._is_closed = True
            self._pause.stop()
            self._worker.close()

    # ------------------------------------------------------------------------------------------

    def _wake(self) -> None:
        """On the worker's thread. One queued signal for any number of reports."""
        if not self._is_pending and not self._is_closed:
            self._is_pending = True
            with suppress(RuntimeError):  # the window is gone, and a worker that took long to end is not
                self._woken.emit()

    def _schedule(self) -> None:
        if self._is_closed:
            return
        if self._pause.isActive():
            self._waits = True
        else:
            self._drain()

    def _rested(self) -> None:
        if self._waits:
            self._waits = False
            self._drain()

    def _drain(self) -> None:
        self._is_pending = False  # before taking: a report that comes meanwhile wakes again
        self._pause.start()
        for report in self._worker.take():
            signal = self._signals.get(type(report))
            if signal is not None and not self._is_closed:
                signal.emit(report)


class EngineBridge(ReportBridge):
    """Owner of the engine's worker; after `stop` it goes on from the last good map."""

    ready = Signal(object)
    progress = Signal(object)
    loaded = Signal(object)
    refused = Signal(object)
    failure = Signal(object)
    restarted = Signal(object)
    snapshot = Signal(object)
    dissected = Signal(object)
    leg_begun = Signal(object)
    log_line = Signal(object)

    def __init__(self, make_worker: WorkerMaker = engine_worker) -> None:
        super().__init__(make_worker)

    def _signal_of_report(self) -> dict[type[Report], Any]:
        return {
            Ready: self.ready,
            Progress: self.progress,
            Loaded: self.loaded,
            Refused: self.refused,
            Failure: self.failure,
            Restarted: self.restarted,
            Snapshot: self.snapshot,
            Dissected: self.dissected,
            LegBegun: self.leg_begun,
            LogLine: self.log_line,
        }
