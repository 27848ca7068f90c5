"""The race that a window shows: who takes part, what is known of them, the place on the time axis."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from PySide6.QtCore import QObject, Signal

from workbench.app.document.engine_bridge import WorkerMaker
from workbench.app.quantities.quantities import Quantity
from workbench.app.race.race_bridge import RaceBridge, race_worker
from workbench.app.race.race_record import RaceRecord
from workbench.core.arrays import Floats
from workbench.core.jacobians import simplex_measures
from workbench.core.mesh import Mesh
from workbench.engine.messages import Failure, Pause, Refused, Run, SetAnchors, SetProblem, Step, Watch
from workbench.engine.race_messages import (
    LIVE,
    Axis,
    RaceEnded,
    RaceFrame,
    RacePhase,
    RaceStarted,
    Seek,
    StartRace,
    Switch,
)


class RaceModel(QObject):
    """Posts the commands of a race and keeps what comes back; nothing here draws."""

    started = Signal()
    map_changed = Signal(int)
    told = Signal(int)
    """News of a contestant: rows, or how it stands."""
    phase_changed = Signal()
    seek_changed = Signal()
    said = Signal(str, str)
    """A sentence of something that went wrong, and details."""
    progress = Signal(str)

    def __init__(self, set_up: StartRace, make_worker: WorkerMaker = race_worker, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.set_up = set_up
        self.records = [RaceRecord(entrant, set_up.problem, set_up.anchors) for entrant in set_up.entrants]
        self.total_measure = float(simplex_measures(set_up.mesh).sum())
        self.start: Floats | None = None
        self.is_running = False
        self.is_over = False
        self.is_ready = False
        self.seek = Seek()
        self._serial = 0
        self._wants_to_run = False
        self._watched = Watch()
        self.bridge = RaceBridge(make_worker)
        self.bridge.setParent(self)
        self.bridge.started.connect(self._take_started)
        self.bridge.frame.connect(self._take_frame)
        self.bridge.phase.connect(self._take_phase)
        self.bridge.refused.connect(self._take_refused)
        self.bridge.failure.connect(self._take_failure)
        self.bridge.ended.connect(self._take_ended)
        self.bridge.progress.connect(lambda report: self.progress.emit(report.sentence))

    @property
    def mesh(self) -> Mesh:
        return self.set_up.mesh

    # ------------------------------------------------------------------------------------------ commands

    def open(self, set_up: StartRace | None = None, *, run: bool = False) -> None:
        """Start the process and bring everyone, or these in their place, to the start."""
        self.bridge.start()
        self.begin(set_up or self.set_up, run=run)

    def begin(self, set_up: StartRace, *, run: bool = False) -> None:
        """Bring these to the start."""
        self._serial += 1
        if set_up.mesh is not self.set_up.mesh:
            self.total_measure = float(simplex_measures(set_up.mesh).sum())
        self.set_up = replace(set_up, serial=self._serial)
        self.records = [RaceRecord(entrant, set_up.problem, set_up.anchors) for entrant in set_up.entrants]
        self.seek, self.is_running, self.is_over, self.is_ready = Seek(), False, False, False
        self._wants_to_run = run
        self.progress.emit("Bringing everyone to the start …")
        self.bridge.post(self.set_up)
        self.phase_changed.emit()

    def restart(self) -> None:
        """From the start once more, with the contestants as they were set up."""
        self.begin(self.set_up, run=self.is_running)

    def toggle(self) -> None:
        """Run where it rests, else pause."""
        self.bridge.post(Pause() if self.is_running else Run())

    def pause(self) -> None:
        self._wants_to_run = False
        self.bridge.post(Pause())

    def step(self) -> None:
        """One step of everyone, shown as it comes."""
        self.go_live()
        self.bridge.post(Step(1))

    def stop(self) -> None:
        """End what hangs."""
        self.bridge.stop()

    def watch(self, quantities: list[Quantity]) -> None:
        """What frames shall carry, in `RaceFrame.fields` by the ids."""
        watched = Watch(tuple(quantity.measure for quantity in quantities))
        if watched != self._watched:
            self._watched = watched
            self.bridge.post(watched)

    def seek_to(self, axis: Axis, place: float) -> None:
        """Show all contestants as they were then."""
        if (axis, place) != (self.seek.axis, self.seek.place):
            self.seek = Seek(axis, place)
            self.bridge.post(self.seek)
            self.seek_changed.emit()

    def go_live(self) -> None:
        """Show the newest maps again, as they come."""
        if not self.is_live:
            self.seek_to(self.seek.axis, LIVE)

    @property
    def is_live(self) -> bool:
        return self.seek.place == LIVE

    def switch(self, index: int, sentence: str, solver: str, parameters: dict[str, Any], problem: SetProblem | None) -> None:
        """Let a contestant go on in another way, from the map that it has."""
        record = self.records[index]
        entrant = replace(record.entrant, solver=solver, parameters=parameters)
        record.asked = (entrant, problem or record.problem, record.anchors)
        self.bridge.post(Switch(index, sentence, solver, parameters, problem))

    def move_anchors(self, sentence: str, anchors: SetAnchors) -> None:
        """Let everyone go on with these anchors, from the map that it has."""
        for index, record in enumerate(self.records):
            record.asked = (record.entrant, record.problem, anchors)
            self.bridge.post(Switch(index, sentence, anchors=anchors))

    def end_of(self, axis: Axis) -> float:
        """The end of a time axis: of whoever came furthest."""
        if axis == "seconds":
            return max((record.spent for record in self.records), default=0.0)
        return float(max((record.iterations for record in self.records), default=0))

    def close(self) -> None:
        self.bridge.close()

    # ------------------------------------------------------------------------------------------ reports

    def _take_started(self, report: RaceStarted) -> None:
        if report.serial != self._serial:
            return
        self.start, self.is_ready = report.start, True
        self.progress.emit("")
        self.started.emit()
        self.phase_changed.emit()
        if self._wants_to_run:
            self.bridge.post(Run())

    def _take_frame(self, frame: RaceFrame) -> None:
        if frame.serial != self._serial:
            return
        if self.records[frame.index].take(frame):
            self.map_changed.emit(frame.index)
        self.told.emit(frame.index)

    def _take_phase(self, report: RacePhase) -> None:
        if report.serial == self._serial:
            self.is_running, self.is_over = report.is_running, report.is_over
            self.phase_changed.emit()

    def _take_refused(self, report: Refused) -> None:
        self.progress.emit("")
        self.said.emit(report.sentence, "")

    def _take_failure(self, report: Failure) -> None:
        self.progress.emit("")
        self.said.emit(report.sentence, report.traceback)

    def _take_ended(self, report: RaceEnded) -> None:
        self.is_running, self.is_ready = False, False
        self.progress.emit("")
        self.phase_changed.emit()
        self.said.emit(report.sentence, "")
