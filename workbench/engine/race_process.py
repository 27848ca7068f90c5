"""The process of a race: drain the pipe, take a turn, publish; spawned, never forked."""

from __future__ import annotations

import os
from dataclasses import replace
from multiprocessing.connection import Connection, wait

from workbench.engine.child import begin_child
from workbench.engine.command_box import CommandBox
from workbench.engine.messages import Progress, Report
from workbench.engine.process import warm_up
from workbench.engine.race_loop import RaceLoop
from workbench.engine.race_messages import RaceFrame, RaceStarted
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
    box = CommandBox()

    def drain() -> None:
        while connection.poll():
            box.put(connection.recv())

    def pending() -> bool:
        drain()
        return box.interrupts

    publisher = _Publisher(connection)
    loop = RaceLoop(publisher, pending)
    try:
        warm_up(lambda: publisher(Progress("Compiling the kernels, once for good …")))
        while not loop.has_quit:
            drain()
            for command in box.take_all():
                loop.handle(command)
            if not loop.advance() and not box:
                wait([connection])
    except (EOFError, BrokenPipeError, ConnectionResetError):
        pass
    finally:
        connection.close()
        os._exit(0)  # threads of a plugin or of BLAS shall not keep the process
