"""The process of a race: a ring of maps for each contestant, the small rest through the pipe."""

from __future__ import annotations

from dataclasses import replace
from multiprocessing.connection import Connection, wait

from workbench.engine.child import begin_child
from workbench.engine.messages import Progress, Report
from workbench.engine.process import warm_up
from workbench.engine.race_loop import RaceLoop
from workbench.engine.race_messages import RaceFrame, RaceStarted
from workbench.engine.service import Inbox
from workbench.engine.shared_positions import PositionRing


class _Publisher:
    """Sends reports; maps go through a ring of shared memory for each contestant, the small rest through the pipe."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._rings: dict[int, PositionRing] = {}

    def __call__(self, report: Report) -> None:
        if isinstance(report, RaceStarted):
            for ring in self._rings.values():
                ring.close()
            self._rings = {}
        elif isinstance(report, RaceFrame) and report.positions is not None:
            positions = report.positions
            if report.index not in self._rings:
                ring = self._rings[report.index] = PositionRing((positions.shape[0], positions.shape[1]))
                self._connection.send((report.serial, report.index, ring.name, ring.shape))
            self._rings[report.index].write(report.number, positions)
            report = replace(report, positions=None)
        self._connection.send(report)


def race_main(connection: Connection, threads: int) -> None:
    """Body of the child process; ends with `Quit`, or when the pipe breaks."""
    begin_child(threads)
    inbox = Inbox(connection)
    publisher = _Publisher(connection)
    loop = RaceLoop(publisher, inbox.is_urgent)

    def rest() -> None:
        wait([connection])

    inbox.serve(loop, lambda: warm_up(lambda: publisher(Progress("Compiling the kernels, once for good …"))), rest)
