"""The background thread that owns the process of a race: the window posts commands and takes reports, and never waits."""

from __future__ import annotations

import contextlib
import multiprocessing
import multiprocessing.connection
import threading
import traceback
from collections.abc import Callable
from dataclasses import replace
from multiprocessing.connection import Connection
from typing import Any

from workbench.core.jacobians import Elements, build_elements
from workbench.engine.child import WithoutMainModule, exit_words
from workbench.engine.command_box import CommandBox
from workbench.engine.command_sender import CommandSender
from workbench.engine.live import LiveColours
from workbench.engine.messages import Command, Failure, Quit, Refused, Report, Watch
from workbench.engine.priority import run_child
from workbench.engine.race_messages import RaceEnded, RaceFrame, StartRace
from workbench.engine.race_process import race_main
from workbench.engine.shared_positions import PositionRing

QUIT_PATIENCE = 0.5
"""Seconds that the child has to leave by itself when the race is closed."""


class RaceWorker:
    """Runs the process of a race; where it dies, says so and has a new one ready for the next `StartRace`."""

    def __init__(self, wake: Callable[[], None], *, threads: int = 0, gives_way: bool = False) -> None:
        """`wake` is called on the worker's thread when reports wait; the rest as in `EngineWorker`."""
        self._wake = wake
        self._threads = threads
        self._gives_way = gives_way
        self._lock = threading.Lock()
        self._outbox = CommandBox()
        self._reports: list[Report] = []
        self._frames: dict[int, RaceFrame] = {}
        self._bell, self._rope = multiprocessing.Pipe(duplex=False)
        self._stop_asked = False
        self._closing = False
        self._thread = threading.Thread(target=self._main, name="race-worker", daemon=True)
        # What the thread alone touches:
        self._process: Any = None
        self._connection: Connection | None = None
        self._sender: CommandSender | None = None
        self._serial = 0
        self._elements: Elements | None = None
        self._rings: dict[int, PositionRing] = {}
        self._colours: dict[int, LiveColours] = {}
        self._shown: dict[int, RaceFrame] = {}
        self._watch = Watch()
        self._said: set[str] = set()

    # ------------------------------------------------------------------------- called by the window's thread

    def start(self) -> None:
        """Spawn the child process and the thread that owns it."""
        self._thread.start()

    def post(self, command: Command) -> None:
        """Queue a command; returns at once. Newest of its slot wins."""
        with self._lock:
            self._outbox.put(command)
        self._ring_bell()

    def take(self) -> list[Report]:
        """Every report since the last call; of each contestant one frame, the newest, with all rows since then."""
        with self._lock:
            reports, self._reports = self._reports, []
            reports += self._frames.values()
            self._frames = {}
        return reports

    def stop(self) -> None:
        """End whatever goes on, a step that hangs included."""
        self._stop_asked = True
        self._ring_bell()

    def close(self) -> None:
        """Quit the child and join the thread."""
        if self._closing:
            return
        self._closing = True
        self._ring_bell()
        if self._thread.ident is not None:
            self._thread.join(timeout=10.0)

    @property
    def process_id(self) -> int | None:
        """Of the child process, None while there is none."""
        process = self._process
        return process.pid if process is not None and process.is_alive() else None

    def _ring_bell(self) -> None:
        with contextlib.suppress(OSError):
            self._rope.send_bytes(b"!")

    # ----------------------------------------------------------------------------------- the thread's own

    def _main(self) -> None:
        try:
            self._spawn()
            while not self._closing:
                self._turn()
        except Exception as error:
            sentence = f"The owner of the race failed: {error}. Close the race and begin another."
            self._report(Failure(self._serial, sentence, traceback.format_exc()))
        finally:
            self._end_process(kill=False)

    def _turn(self) -> None:
        assert self._connection is not None and self._process is not None
        ready = multiprocessing.connection.wait([self._bell, self._connection, self._process.sentinel])
        while self._bell.poll():
            self._bell.recv_bytes()
        if self._stop_asked and not self._closing:
            self._stop_asked = False
            self._begin_anew("Stopped. Restart begins the race anew.")
            return
        alive = self._receive() if self._connection in ready else True
        if not alive or (self._process.sentinel in ready and not self._connection.poll()):
            self._died()
        else:
            self._send_commands()

    def _died(self) -> None:
        self._process.join(timeout=1.0)
        words = exit_words(self._process.exitcode)
        self._begin_anew(f"The process of the race ended unexpectedly ({words}). Restart begins the race anew.")

    def _begin_anew(self, sentence: str) -> None:
        self._end_process(kill=True)
        self._spawn()
        self._report(RaceEnded(sentence))

    def _send_commands(self) -> None:
        with self._lock:
            commands = self._outbox.take_all()
        for command in commands:
            if isinstance(command, StartRace):
                self._serial, self._elements = command.serial, build_elements(command.mesh)
                self._colours, self._shown = {}, {}
            elif isinstance(command, Watch):
                self._watch = command
                self._begin_to_watch()
        for_child = [command for command in commands if not isinstance(command, Watch)]
        if for_child:
            assert self._sender is not None
            self._sender.send(for_child)

    # ------------------------------------------------------------------------------------------ reports

    def _receive(self) -> bool:
        """Take everything from the pipe; false when it is broken."""
        assert self._connection is not None
        newest: dict[int, RaceFrame] = {}
        alive = True
        try:
            while self._connection.poll():
                message = self._connection.recv()
                if isinstance(message, RaceFrame):
                    newest[message.index] = message.after(newest.get(message.index))
                elif isinstance(message, tuple):
                    self._attach(*message)
                else:
                    self._report(message)
        except (EOFError, OSError):
            alive = False
        for frame in newest.values():
            self._take_frame(frame)
        return alive

    def _attach(self, serial: int, index: int, name: str, shape: tuple[int, int]) -> None:
        if index in self._rings:
            self._rings[index].close()
        self._rings[index] = PositionRing(shape, name)
        self._rings[index].unlink()

    def _take_frame(self, frame: RaceFrame) -> None:
        if frame.serial != self._serial:
            return
        if frame.number:
            positions = self._rings[frame.index].read(frame.number)
            if positions is None:
                frame = replace(frame, number=0)  # overwritten meanwhile: a newer one is on its way
            else:
                positions.flags.writeable = False
                frame = self._coloured(replace(frame, positions=positions))
                self._shown[frame.index] = frame
        self._publish(frame)

    def _coloured(self, frame: RaceFrame) -> RaceFrame:
        assert frame.positions is not None and self._elements is not None
        colours = self._colours.get(frame.index)
        if colours is None:
            colours = self._colours[frame.index] = LiveColours(self._elements)
            self._watch_with(colours)
        live = colours.of(frame.positions, inverted=frame.inverted_count, moving=False)
        return replace(frame, fields=live.fields, inverted=live.inverted)

    def _watch_with(self, colours: LiveColours) -> None:
        for sentence in colours.watch(self._watch.measures, False):
            if sentence not in self._said:
                self._said.add(sentence)
                self._report(Refused(self._serial, "Watch", sentence))

    def _begin_to_watch(self) -> None:
        self._said.clear()
        for index, colours in self._colours.items():
            self._watch_with(colours)
            if index in self._shown:
                shown = self._shown[index] = self._coloured(self._shown[index])
                self._publish(replace(shown, rows=(), terms=()))

    def _publish(self, frame: RaceFrame) -> None:
        with self._lock:
            self._frames[frame.index] = frame.after(self._frames.get(frame.index))
        self._wake()

    def _report(self, report: Report) -> None:
        with self._lock:
            self._reports.append(report)
        self._wake()

    # ---------------------------------------------------------------------------------------- the child

    def _spawn(self) -> None:
        context = multiprocessing.get_context("spawn")
        self._connection, theirs = context.Pipe(duplex=True)
        with WithoutMainModule():
            self._process = context.Process(
                target=run_child, args=(self._gives_way, race_main, theirs, self._threads), name="workbench-race", daemon=True
            )
            self._process.start()
        theirs.close()
        self._sender = CommandSender(self._connection)

    def _end_process(self, *, kill: bool) -> None:
        process, self._process = self._process, None
        if process is None:
            return
        assert self._sender is not None and self._connection is not None
        if not kill:
            self._sender.send([Quit()])
            process.join(timeout=QUIT_PATIENCE)
        self._sender.close()
        if process.is_alive():
            process.kill()
        process.join(timeout=5.0)
        process.close()
        self._connection.close()
        for ring in self._rings.values():
            ring.close()
        self._rings = {}
