"""The background thread that owns the engine process: the window posts commands and takes reports, and never waits."""

from __future__ import annotations

import multiprocessing
import multiprocessing.connection
import time
from collections.abc import Callable
from dataclasses import replace
from multiprocessing.connection import Connection
from typing import TYPE_CHECKING, Any

import numpy as np

from workbench.core.errors import WorkbenchError
from workbench.engine.child import WithoutMainModule, exit_words
from workbench.engine.head_start import NAME, BegunEngine, begin_engine
from workbench.engine.messages import (
    Command,
    Load,
    Loaded,
    MapReport,
    Pause,
    Ready,
    Refused,
    Report,
    Reset,
    Restarted,
    Restore,
    Run,
    SetAnchors,
    SetProblem,
    SetSolver,
    Snapshot,
    Step,
    TakeUp,
    Watch,
)
from workbench.engine.priority import run_child
from workbench.engine.process_owner import ProcessOwner
from workbench.engine.shared_positions import PositionRing

if TYPE_CHECKING:
    from workbench.engine.live import LiveColours

CRASHES_IN_A_ROW = 3
"""Deaths after which a new process is given the default methods, and does not run; after twice as many there is no new one."""
STEADY = 10.0
"""Seconds after which a process that publishes maps counts as sound again."""


class EngineWorker(ProcessOwner):
    """Runs the engine process and keeps it alive."""

    name = NAME
    trouble = "The engine's owner failed: {}. Restart the program."

    def __init__(
        self,
        wake: Callable[[], None],
        *,
        threads: int = 0,
        on_snapshot: Callable[[Snapshot], None] | None = None,
        with_fields: bool = True,
        gives_way: bool = False,
        begun: BegunEngine | None = None,
    ) -> None:
        """As in `ProcessOwner`; `begun` is a first process with these settings that runs already.

        `on_snapshot` (tests, benchmarks) is told every map that is read, on the worker's thread; `with_fields` false leaves
        out all that is watched.
        """
        super().__init__(wake, threads=threads, gives_way=gives_way)
        self._begun = begun
        self._on_snapshot = on_snapshot
        self._with_fields = with_fields
        self._snapshot: Snapshot | None = None
        self._stopped: list[Command] = []
        # What the thread alone touches:
        self._corrector: Any = None
        self._correctors_end: Connection | None = None
        self._spawned_at = 0.0
        self._ring: PositionRing | None = None
        self._colours: LiveColours | None = None
        self._loaded: Loaded | None = None
        self._loading: Load | None = None
        self._loaded_by: Load | None = None
        self._last_map: MapReport | None = None
        self._settings: dict[type[Command], Command] = {}
        self._running: Run | None = None
        self._crashes = 0
        self._unread_rows: tuple[Any, ...] = ()
        self._watch = Watch()

    # ------------------------------------------------------------------------- called by the window's thread

    def take(self) -> list[Report]:
        """Every report since the last call; of snapshots only the newest, its `rows` are all since then."""
        with self._lock:
            reports, self._reports = self._reports, []
            if self._snapshot is not None:
                reports.append(self._snapshot)
                self._snapshot = None
        return reports

    def stop(self) -> None:
        """End whatever the engine does, a step that hangs included: the child is killed and restarted on the last good map."""
        with self._lock:
            self._stop_asked = True
            self._stopped += self._outbox.take_all()
        self._ring_bell()

    # ----------------------------------------------------------------------------------- the thread's own

    @property
    def _generation(self) -> int:
        return self._loaded.generation if self._loaded else 0

    def _turn(self) -> None:
        assert self._connection is not None and self._process is not None
        ready = multiprocessing.connection.wait([self._bell, self._connection, self._process.sentinel])
        if self._bell in ready:
            while self._bell.poll():
                self._bell.recv_bytes()
        with self._lock:
            stop_asked, self._stop_asked = self._stop_asked, False
            stopped, self._stopped = self._stopped, []
        if stop_asked and not self._closing:
            for command in stopped:  # choices stay choices, though what was asked for is not done
                self._remember(command)
            self._restart("Stopped: the engine was restarted on the last good map.", resume=False)
            return
        if self._connection in ready and not self._receive():
            self._crashed()
            return
        if self._process.sentinel in ready and not self._connection.poll():
            self._crashed()
            return
        self._send_commands()

    def _send_commands(self) -> None:
        with self._lock:
            commands = self._outbox.take_all()
        for command in commands:
            self._remember(command)
        for_child = [command for command in commands if not isinstance(command, Watch)]
        if for_child:
            self._send(*for_child)

    def _remember(self, command: Command) -> None:
        """Keep what a new process must be told to go on like the old one."""
        if isinstance(command, SetProblem | SetSolver | SetAnchors | Reset):
            self._settings[type(command)] = command
        elif isinstance(command, TakeUp):
            self._settings |= {type(part): part for part in (command.problem, command.solver, command.anchors)}
            self._running = None
        elif isinstance(command, Run):
            self._running = command
        elif isinstance(command, Pause | Step):
            self._running = None
        elif isinstance(command, Load):
            self._loading = command
        elif isinstance(command, Watch):
            self._watch = command
            self._begin_to_watch()

    def _begin_to_watch(self) -> None:
        """Snapshots carry what is watched, beginning with the map that is there."""
        if self._colours is None:
            return
        for sentence in self._colours.watch(self._watch.measures, self._watch.singular_values):
            self._report(Refused(self._generation, "Watch", sentence))
        if self._last_map is not None:
            self._publish(self._last_map, is_news=False)

    # ------------------------------------------------------------------------------------------ reports

    def _receive(self) -> bool:
        """Take everything from the pipe; false when it is broken."""
        assert self._connection is not None
        newest: MapReport | None = None
        alive = True
        try:
            while self._connection.poll():
                message = self._connection.recv()
                if isinstance(message, MapReport):
                    self._unread_rows += message.rows
                    newest = message
                elif isinstance(message, tuple):
                    self._flush(newest)
                    newest = None
                    self._attach(*message)
                else:
                    self._flush(newest)
                    newest = None
                    self._take_report(message)
        except (EOFError, OSError):
            alive = False
        self._flush(newest)
        return alive

    def _attach(self, name: str, shape: tuple[int, int]) -> None:
        if self._ring is not None:
            self._ring.close()
        self._ring = PositionRing(shape, name)
        self._ring.unlink()

    def _take_report(self, report: Report) -> None:
        if isinstance(report, Loaded):
            self._loaded, self._loaded_by, self._last_map = report, self._loading, None
            self._loading, self._running = None, None
            for kind in (SetAnchors, Reset):
                self._settings.pop(kind, None)
            from workbench.core.jacobians import build_elements
            from workbench.engine.live import LiveColours

            self._colours = LiveColours(build_elements(report.mesh))
            self._begin_to_watch()
            self._start_corrector()
            with self._lock:
                self._snapshot = None
            self._unread_rows = ()
        elif isinstance(report, Ready):
            import workbench.engine.live  # noqa: F401  what the first map needs, while the child reads its mesh
        elif isinstance(report, Refused) and report.command == "Load":
            self._loading = None
        elif isinstance(report, Refused) and report.kept is not None:
            sent = self._settings.get(SetProblem)
            if isinstance(sent, SetProblem) and sent.serial == report.serial:
                self._settings[SetProblem] = report.kept  # a new process shall not be told what this one refused
        self._report(report)

    def _flush(self, report: MapReport | None) -> None:
        """Turn the newest map into a snapshot for the window."""
        if report is None or self._ring is None or self._loaded is None or self._colours is None:
            return
        positions = self._ring.read(report.number)
        if positions is None:
            return  # overwritten meanwhile: a newer one is on its way
        positions.flags.writeable = False
        self._last_map = replace(report, positions=positions)
        if time.monotonic() - self._spawned_at > STEADY:
            self._crashes = 0
        self._publish(self._last_map)

    def _publish(self, report: MapReport, *, is_news: bool = True) -> None:
        """Hand a map to the window with all that is watched; `is_news` is false for one that was handed over before."""
        assert self._loaded is not None and self._colours is not None
        positions = report.positions
        moving = report.phase in ("dragging", "running")
        live = self._colours.of(positions, inverted=report.inverted, moving=moving) if self._with_fields else None
        rows: tuple[Any, ...] = ()
        if is_news:
            rows, self._unread_rows = self._unread_rows, ()
        snapshot = Snapshot(
            generation=report.generation,
            number=report.number,
            positions=positions,
            phase=report.phase,
            status=report.status,
            row=report.rows[-1],
            inverted=live.inverted if live else np.zeros(self._loaded.mesh.simplex_count, dtype=bool),
            fields=live.fields if live else {},
            singular_values=live.singular_values if live else None,
            anchor_serial=report.anchor_serial,
            limiting_simplex=report.limiting_simplex,
            seconds_published=report.seconds_published,
            timing=report.timing,
            solver=report.solver,
            distortion=report.distortion,
            rows=rows,
            leg=report.leg,
        )
        if self._on_snapshot is not None:
            self._on_snapshot(snapshot)
        with self._lock:
            if self._snapshot is not None:
                snapshot = replace(snapshot, rows=self._snapshot.rows + snapshot.rows)
            self._snapshot = snapshot
        self._wake()
        if moving and self._with_fields:
            self._colours.catch_up(positions)

    # ---------------------------------------------------------------------------------------- the child

    def _spawn(self) -> None:
        begun, self._begun = self._begun, None
        begun = begun or begin_engine(threads=self._threads, gives_way=self._gives_way)
        self._correctors_end, self._spawned_at = begun.corrector, begun.at
        self._adopt(begun.process, begun.connection)

    def _start_corrector(self) -> None:
        """The second process, once a mesh is large enough for it to help; a restart of the engine ends it."""
        from workbench.engine.corrector import SMALLEST, corrector_main

        if self._correctors_end is None or self._loaded is None or self._loaded.mesh.simplex_count < SMALLEST:
            return
        with WithoutMainModule():
            context = multiprocessing.get_context("spawn")
            self._corrector = context.Process(
                target=run_child,
                args=(self._gives_way, corrector_main, self._correctors_end),
                name="workbench-corrector",
                daemon=True,
            )
            self._corrector.start()
        self._correctors_end.close()
        self._correctors_end = None

    def _crashed(self) -> None:
        self._crashes += 1
        code = self._process.exitcode if self._process is not None else None
        if self._loading is not None:
            load, self._loading = self._loading, None
            sentence = (
                f"Reading {load.source} ended the engine process ({exit_words(code)}); the file may be too large or damaged."
            )
            self._report(Refused(load.generation, "Load", sentence))
        if self._crashes > 2 * CRASHES_IN_A_ROW:
            raise WorkbenchError(f"its process ended {self._crashes} times in a row ({exit_words(code)})")
        if self._crashes > CRASHES_IN_A_ROW:
            for kind in (SetProblem, SetSolver, Reset):
                self._settings.pop(kind, None)
            self._running = None
        sentence = f"The engine process ended unexpectedly ({exit_words(code)}); it was restarted on the last good map."
        self._restart(sentence, resume=True)

    def _restart(self, sentence: str, *, resume: bool) -> None:
        self._end_process(kill=True)
        if self._loading is not None:
            self._report(Refused(self._loading.generation, "Load", "Reading the file was cancelled."))
            self._loading = None
        if not resume:
            self._running = None
        self._report(Restarted(sentence))
        self._spawn()
        self._start_corrector()
        for kind in (SetProblem, SetSolver, Reset):
            if kind in self._settings:
                self._send(self._settings[kind])
        if self._loaded is not None and self._last_map is not None:
            last, loaded = self._last_map, self._loaded
            iteration, number = last.rows[-1].iteration, last.number + 1
            self._send(Restore(loaded.generation, loaded.mesh, loaded.kind, last.positions, iteration, number))
            if SetAnchors in self._settings:
                self._send(self._settings[SetAnchors])
            if self._running is not None:
                self._send(self._running)
        elif self._loaded_by is not None:
            self._send(self._loaded_by)

    def _end_process(self, *, kill: bool = False) -> None:
        corrector, self._corrector = self._corrector, None
        if corrector is not None:
            corrector.kill()
            corrector.join(timeout=5.0)
            corrector.close()
        if self._correctors_end is not None:
            self._correctors_end.close()
            self._correctors_end = None
        super()._end_process(kill=kill)
        if self._ring is not None:
            self._ring.close()
            self._ring = None
