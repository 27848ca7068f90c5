"""From the worker of a race to the window."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

from PySide6.QtCore import Signal

from workbench.app.document.engine_bridge import ReportBridge, Worker, WorkerMaker
from workbench.engine.messages import Failure, Progress, Refused, Report
from workbench.engine.race_messages import RaceEnded, RaceFrame, RacePhase, RaceStarted, TablesSaved


def race_worker(wake: Callable[[], None]) -> Worker:
    """The real one: the race runs in a process of its own, and leaves a core to the drawing of its many views."""
    from workbench.engine.race_worker import RaceWorker

    return RaceWorker(wake, threads=max((os.cpu_count() or 2) - 1, 1), gives_way=True)


class RaceBridge(ReportBridge):
    """Owner of the worker of a race."""

    progress = Signal(object)
    started = Signal(object)
    frame = Signal(object)
    phase = Signal(object)
    refused = Signal(object)
    failure = Signal(object)
    ended = Signal(object)
    saved = Signal(object)

    def __init__(self, make_worker: WorkerMaker = race_worker) -> None:
        super().__init__(make_worker)

    def _signal_of_report(self) -> dict[type[Report], Any]:
        return {
            Progress: self.progress,
            RaceStarted: self.started,
            RaceFrame: self.frame,
            RacePhase: self.phase,
            Refused: self.refused,
            Failure: self.failure,
            RaceEnded: self.ended,
            TablesSaved: self.saved,
        }
