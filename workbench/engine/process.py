"""The engine process: maps go out through shared memory, the small rest through the pipe."""

from __future__ import annotations

import gc
import os
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from multiprocessing.connection import Connection, wait

import numpy as np

from workbench.engine.child import begin_child
from workbench.engine.log_file import FaultWatch
from workbench.engine.log_lines import LogLines
from workbench.engine.loop import EngineLoop, MapReport
from workbench.engine.messages import Progress, Ready, Report
from workbench.engine.priority import give_way
from workbench.engine.service import Inbox
from workbench.engine.shared_positions import PositionRing

FIRST_START = "First start: kernels are being compiled for this machine, about half a minute; later starts find them ready …"
PUBLISH_INTERVAL = 0.004
"""Seconds; quicker maps than this are not worth a message unless they are news of an anchor or of the end."""
NAP = 0.010
NOWHERE = np.empty((0, 2))


class _Publisher:
    """Sends reports; positions go through shared memory, the small rest through the pipe."""

    def __init__(self, connection: Connection, gives_way: bool = False) -> None:
        self._connection = connection
        self._gives_way = gives_way
        self._is_first = True
        self._lines = LogLines()
        self._ring: PositionRing | None = None
        self._held: MapReport | None = None
        self._last_sent = 0.0
        self._last_serial = -1

    def __call__(self, report: Report) -> None:
        if not isinstance(report, MapReport):
            self.flush()
            self._connection.send(report)
            return
        if self._held is not None:
            report = replace(report, rows=self._held.rows + report.rows)
        self._held = report
        is_news = report.anchor_serial != self._last_serial or report.phase in ("idle", "finished")
        if is_news or time.perf_counter() - self._last_sent >= PUBLISH_INTERVAL:
            self.flush()

    def flush(self) -> None:
        """Send the map that is held back, if there is one, and what was logged."""
        for line in self._lines.take():
            self._connection.send(line)
        report, self._held = self._held, None
        if report is None:
            return
        shape = (report.positions.shape[0], report.positions.shape[1])
        if self._ring is None or self._ring.shape != shape:
            if self._ring is not None:
                self._ring.close()
            self._ring = PositionRing(shape)
            self._connection.send((self._ring.name, shape))
        self._ring.write(report.number, report.positions)
        self._connection.send(replace(report, positions=NOWHERE, seconds_published=time.perf_counter()))
        self._last_sent, self._last_serial = time.perf_counter(), report.anchor_serial
        if self._is_first:
            self._is_first = False
            gc.freeze()
            gc.enable()
            if self._gives_way:
                give_way()


def engine_main(
    connection: Connection,
    corrector: Connection,
    spawned_at: float,
    threads: int,
    gives_way: bool = False,
    ahead: str = "",
) -> None:
    """Body of the child process; ends with `Quit`, or when the pipe breaks.

    `ahead` is a source that will be asked for: what can be made of it before is made, once the kernels are ready.
    """
    gc.disable()  # until the first map: what is made before stays
    begin_child(threads)
    watch = FaultWatch()
    watch.begin(takes_left=False)
    inbox = Inbox(connection)
    publisher = _Publisher(connection, gives_way)
    loop = EngineLoop(publisher, inbox.is_urgent, corrector)

    def begin() -> None:
        warm_up(lambda: publisher(Progress(FIRST_START)))
        publisher(Ready(time.time() - spawned_at))
        prepare(ahead)

    def rest() -> None:
        publisher.flush()
        loop.tend()
        wait([connection, *loop.waits_for], NAP if loop.is_active else None)

    inbox.serve(loop, begin, rest, watch.end)


def prepare(ahead: str) -> None:
    """Find the methods, and make the sample that will be asked for; whatever is wrong will be said when it is."""
    from workbench.core.registry import registry
    from workbench.core.samples import sample_info
    from workbench.io.opening import SAMPLE

    with suppress(Exception, SystemExit):
        registry()
        if ahead.startswith(SAMPLE):
            sample_info(ahead.removeprefix(SAMPLE))


def warm_up(tell: Callable[[], None]) -> None:
    """Load (or, the first time ever, compile) every kernel on one simplex, so that no drag waits for it."""
    from workbench.core.anchor_steps import approach_anchors
    from workbench.core.constraints import Anchors
    from workbench.core.distortion import Distortion
    from workbench.core.jacobians import determinants, signed_singular_values
    from workbench.core.line_search import largest_step
    from workbench.core.mesh import Mesh
    from workbench.core.problem import Problem
    from workbench.core.solver import never
    from workbench.core.state import State
    from workbench.core.tape import run_tape

    if not is_cached(run_tape):
        tell()
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    mesh = Mesh(corners, np.array([[0, 1, 2], [1, 3, 2]]))
    distortion = Distortion("warm", "warm", "sum(sigma^2 + 1/sigma^2)")
    problem = Problem.create(mesh, "plane", distortion, Anchors(np.array([0]), np.array([[0.0, -0.1]])))
    approach_anchors(problem, State(corners, anchor_error=0.1), never)
    problem.energy(corners)
    largest_step(corners, corners[::-1].copy(), mesh.simplices)
    determinants(problem.elements, corners)
    signed_singular_values(problem.elements, corners)


def is_cached(kernel: object) -> bool:
    """Whether a kernel was compiled in an earlier run (numba keeps an index file beside its cache)."""
    cache = getattr(kernel, "_cache", None)
    path = getattr(getattr(cache, "_cache_file", None), "_index_path", "")
    return bool(path) and os.path.exists(path)
