"""The background thread that owns the process of a race: the window posts commands and takes reports, and never waits."""

from __future__ import annotations

import multiprocessing.connection
from collections.abc import Callable
from dataclasses import replace

from workbench.core.jacobians import Elements, build_elements
from workbench.engine.child import exit_words
from workbench.engine.live import LiveColours
from workbench.engine.messages import Refused, Report, Watch
from workbench.engine.process_owner import ProcessOwner
from workbench.engine.race_messages import RaceEnded, RaceFrame, StartRace
from workbench.engine.race_process import race_main
from workbench.engine.shared_positions import PositionRing


class RaceWorker(ProcessOwner):
    """Runs the process of a race; where it dies, says so and has a new one ready for the next `StartRace`."""

    name = "workbench-race"
    trouble = "The owner of the race failed: {}. Close the race and begin another."

    def __init__(self, wake: Callable[[], None], *, threads: int = 0, gives_way: bool = False) -> None:
        """See `ProcessOwner`."""
        super().__init__(wake, threads=threads, gives_way=gives_way)
        self._frames: dict[int, RaceFrame] = {}
        # What the thread alone touches:
        self._serial = 0
        self._elements: Elements | None = None
        self._rings: dict[int, PositionRing] = {}
        self._colours: dict[int, LiveColours] = {}
        self._shown: dict[int, RaceFrame] = {}
        self._watch = Watch()
        self._said: set[str] = set()

    # ------------------------------------------------------------------------- called by the window's thread

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

    # ----------------------------------------------------------------------------------- the thread's own

    @property
    def _generation(self) -> int:
        return self._serial

    def _spawn(self) -> None:
        self._begin_process(race_main, self._threads)

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
            self._send(*for_child)

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

    def _end_process(self, *, kill: bool = False) -> None:
        super()._end_process(kill=kill)
        for ring in self._rings.values():
            ring.close()
        self._rings = {}
