"""The engine's own loop in place of a process: what is asked for is there at once, and is the same each time."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace

from PySide6.QtCore import QCoreApplication, QEvent

from workbench.engine.loop import EngineLoop
from workbench.engine.messages import Command, MapReport, Ready, Report, SetAnchors, Snapshot, Step


@contextmanager
def garbage_of_this_thread() -> Iterator[None]:
    """Within it nothing is collected, and all at its end: on the thread that packs maps Qt's objects must not end."""
    gc.disable()
    try:
        yield
    finally:
        QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
        gc.collect()
        gc.enable()


class LoopWorker:
    """The engine itself on this thread; of the maps that nobody has read the newest is handed over, with all their rows."""

    def __init__(self, wake: Callable[[], None]) -> None:
        self._wake = wake
        self._reports: list[Report] = []
        self.loop = EngineLoop(self._take)

    def start(self) -> None:
        self._take(Ready(0.1))

    def post(self, command: Command) -> None:
        self.loop.handle(command)
        while isinstance(command, Step | SetAnchors) and self.loop.advance():
            pass

    def _take(self, report: Report) -> None:
        if isinstance(report, MapReport):
            snapshot = Snapshot(
                *(report.generation, report.number, report.positions, report.phase, report.status, report.rows[-1]),
                *(report.inverted, {}, report.anchor_serial),
                rows=report.rows,
            )
            last = self._reports[-1] if self._reports else None
            if isinstance(last, Snapshot) and last.generation == snapshot.generation:
                self._reports[-1] = replace(snapshot, rows=last.rows + snapshot.rows)
            else:
                self._reports.append(snapshot)
        else:
            self._reports.append(report)
        self._wake()

    def take(self) -> list[Report]:
        taken, self._reports = self._reports, []
        return taken

    def stop(self) -> None: ...

    def close(self) -> None: ...
