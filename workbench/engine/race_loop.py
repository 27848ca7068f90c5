"""The loop of a race as a plain object: commands in, reports out; it runs in a child process and inline alike."""

from __future__ import annotations

import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass

from workbench.core.arrays import Floats
from workbench.core.constraints import Anchors
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.linear_equations import with_equations
from workbench.core.problem import Criteria, Problem
from workbench.core.registry import registry
from workbench.engine.messages import (
    Command,
    Failure,
    Pause,
    Progress,
    Quit,
    Refused,
    Report,
    Run,
    SetAnchors,
    SetProblem,
    Step,
)
from workbench.engine.race import Contestant, Frame, Limits, Race, Racer
from workbench.engine.race_messages import (
    Entrant,
    RaceFrame,
    RacePhase,
    RaceStarted,
    SaveTables,
    Seek,
    StartRace,
    StartWish,
    Switch,
    TablesSaved,
)
from workbench.engine.racer import Terms
from workbench.engine.starts import adjusted_start, default_initializer, make_start

TURN = 0.01
"""Seconds of a turn: between turns commands are read and maps go out."""
PATIENCE = 0.06
"""Seconds after which whoever had no turn comes before those that have spent less."""
PUBLISH_INTERVAL = 0.07
"""Seconds between two maps of one contestant, on the average."""
BURST = 2 * PUBLISH_INTERVAL
"""Seconds that a contestant may have been silent for that come back as maps sooner: turns of quick ones come in bursts."""


@dataclass
class _Told:
    """What the window knows of a contestant."""

    number: int = 0
    rows: int = 0
    due: float = 0.0
    last: tuple[object, ...] = ()


class RaceLoop:
    """One race; `handle` and `advance` are called in turn by whoever owns it."""

    def __init__(self, publish: Callable[[Report], None], pending: Callable[[], bool] = lambda: False) -> None:
        """`publish` takes every report; `pending` tells whether a command waits that a step gives way to."""
        self._publish = publish
        self._pending = pending
        self._serial = 0
        self._race: Race | None = None
        self._running = False
        self._steps_left = 0
        self._seek = Seek()
        self._told: list[_Told] = []
        self._terms: dict[Terms, int] = {}
        self._phase: RacePhase | None = None
        self._boundary = Anchors.none(2)
        self.has_quit = False

    # ----------------------------------------------------------------------------------------- commands

    def handle(self, command: Command) -> None:
        """Carry out a command; what goes wrong becomes a `Refused` or `Failure` report."""
        try:
            self._dispatch(command)
        except WorkbenchError as error:
            self._publish(Refused(self._serial, type(command).__name__, error.sentence))
        except (Exception, SystemExit) as error:
            self._fail(f"{type(command).__name__} failed: {type(error).__name__}: {error}")
        self._tell_phase()

    def _dispatch(self, command: Command) -> None:
        if isinstance(command, StartRace):
            self._start(command)
        elif isinstance(command, Run):
            self._running, self._steps_left = True, 0
        elif isinstance(command, Pause):
            self._running, self._steps_left = False, 0
            self._publish_all()
        elif isinstance(command, Step):
            self._running, self._steps_left = False, self._steps_left + command.count
        elif isinstance(command, Seek):
            self._seek = command
            for index in range(len(self._told)):
                self._told[index].last = ()
            self._publish_all()
        elif isinstance(command, Switch):
            self._switch(command)
        elif isinstance(command, SaveTables):
            self._save(command)
        elif isinstance(command, Quit):
            self.has_quit = True

    def _start(self, command: StartRace) -> None:
        self._serial, self._race, self._phase = command.serial, None, None
        self._running, self._steps_left, self._seek = False, 0, Seek()
        self._boundary = Anchors.none(command.mesh.dimension)
        self._publish(Progress("Bringing everyone to the start; what is compiled for it the first time ever takes a minute …"))
        problem = _problem_of(command)
        start = _start_of(command, problem)
        if command.problem.fixed_boundary:
            rows = problem.mesh.topology.boundary_vertices
            self._boundary = Anchors(rows, start[rows])
            problem = problem.with_anchors(self._all_anchors(command.anchors))
        contestants = [_contestant(entrant) for entrant in command.entrants]
        limits = Limits(command.limits.iterations, command.limits.time_limit)
        race = Race(problem, start, contestants, criteria=Criteria(command.limits.tolerance), limits=limits)
        self._race, self._terms = race, {}
        self._told = [_Told() for _ in race.racers]
        self._publish(RaceStarted(command.serial, start))
        self._publish_all()

    def _switch(self, command: Switch) -> None:
        if self._race is None:
            return
        racer = self._race.racers[command.index]
        solver = registry().solver(command.solver).configured(command.parameters) if command.solver else None
        distortion, allow = None, None
        if command.problem is not None:
            distortion, allow = _distortion(command.problem), command.problem.allow_inversions
        anchors = None
        if command.anchors is not None:
            anchors = self._all_anchors(command.anchors)
            anchors.check(racer.problem.mesh.vertex_count, racer.problem.dimension)
        racer.rebase(command.sentence, solver=solver, distortion=distortion, anchors=anchors, allow_inversions=allow)
        self._publish_frame(command.index)

    def _all_anchors(self, held: SetAnchors) -> Anchors:
        """These, and the boundary where it was fixed at the start."""
        anchors = _anchors(held, self._boundary.targets.shape[1])
        return anchors.with_added(self._boundary.vertices, self._boundary.targets) if len(self._boundary.vertices) else anchors

    def _save(self, command: SaveTables) -> None:
        if self._race is None:
            raise WorkbenchError("There is no race to save; begin one first.")
        from workbench.engine.race_table import history_rows, race_table
        from workbench.io.atomic import filling, write_text
        from workbench.io.write import csv_text

        with filling(command.folder) as folder:
            write_text(folder / "table.csv", csv_text(race_table(self._race, command.mesh_name)))
            write_text(folder / "history.csv", csv_text(history_rows(self._race, command.mesh_name)))
        self._publish(TablesSaved(command.folder))

    # -------------------------------------------------------------------------------------------- turns

    @property
    def is_active(self) -> bool:
        """Whether `advance` has something to do."""
        return self._race is not None and (self._running or self._steps_left > 0) and not self._race.is_over

    def advance(self) -> bool:
        """A turn, or one step of everyone where steps were asked for; false where there is nothing to do."""
        race = self._race
        if race is None or not self.is_active:
            return False
        if self._steps_left:
            self._steps_left -= 1
            race.step_all(self._pending)
            self._publish_all()
        else:
            racer = race.advance(TURN, self._pending, PATIENCE)
            if racer is not None:
                index = race.racers.index(racer)
                if not racer.is_running or time.perf_counter() >= self._told[index].due:
                    self._publish_frame(index)
        if not self.is_active:
            self._publish_all()
        self._tell_phase()
        return True

    # ------------------------------------------------------------------------------------------ reports

    def _publish_all(self) -> None:
        for index in range(len(self._told)):
            self._publish_frame(index)

    def _publish_frame(self, index: int) -> None:
        """Tell what is new of a contestant: rows always, a map where another one is to be seen."""
        assert self._race is not None
        racer, told = self._race.racers[index], self._told[index]
        frame = self._frame_to_show(racer)
        news = (frame.index, len(racer.rows), racer.phase, racer.message)
        if news == told.last:
            return
        has_map = not told.last or told.last[0] != frame.index
        told.number += has_map
        rows, terms = racer.rows[told.rows :], racer.terms[told.rows :]
        row = racer.rows[frame.index]
        told.last, told.rows = news, len(racer.rows)
        told.due = max(told.due, time.perf_counter() - BURST) + PUBLISH_INTERVAL
        self._publish(
            RaceFrame(
                serial=self._serial,
                index=index,
                number=told.number if has_map else 0,
                iteration=frame.iteration,
                seconds=frame.seconds,
                rows=tuple(rows),
                terms=tuple(self._terms.setdefault(item, len(self._terms)) for item in terms),
                markers=tuple(racer.markers),
                phase=racer.phase,
                status=racer.status_name,
                message=racer.message,
                inverted_count=row.inverted,
                positions=frame.positions if has_map else None,
            )
        )

    def _frame_to_show(self, racer: Racer) -> Frame:
        store = racer.maps
        return store.at_seconds(self._seek.place) if self._seek.axis == "seconds" else store.at_iteration(self._seek.place)

    def _tell_phase(self) -> None:
        if self._race is None:
            return
        phase = RacePhase(self._serial, self.is_active, self._race.is_over)
        if phase != self._phase:
            self._phase = phase
            self._publish(phase)

    def _fail(self, sentence: str) -> None:
        self._running, self._steps_left = False, 0
        self._publish(Failure(self._serial, sentence, traceback.format_exc()))


def _start_of(command: StartRace, problem: Problem) -> Floats:
    """The start (n, d) that is given or wished for. Raises `WorkbenchError` where it cannot be made."""
    wish, mesh, kind = command.start, command.mesh, command.kind
    if not isinstance(wish, StartWish):
        return wish
    reset = wish.reset
    if not reset.initializer:
        from workbench.io.opening import open_source

        given = open_source(wish.source, kind=kind, fixes=wish.fixes).start
        if given is not None and len(given) == mesh.vertex_count:
            return adjusted_start(mesh, kind, given, False)
    id = reset.initializer or default_initializer(kind, registry().solver(wish.solver).initializer)
    return make_start(mesh, kind, id, reset.parameters, reset.file, reset.match_area, problem)


def _problem_of(command: StartRace) -> Problem:
    mesh, choices = command.mesh, command.problem
    anchors = _anchors(command.anchors, mesh.dimension)
    problem = Problem.create(mesh, command.kind, _distortion(choices), anchors, allow_inversions=choices.allow_inversions)
    return with_equations(problem, choices.equations)


def _anchors(held: SetAnchors, dimension: int) -> Anchors:
    return held.anchors if len(held.vertices) else Anchors.none(dimension)


def _distortion(choices: SetProblem) -> Distortion:
    return Distortion.resolve(choices.distortion, choices.parameters)


def _contestant(entrant: Entrant) -> Contestant:
    if entrant.solver:
        return Contestant.of(entrant.solver, entrant.parameters, entrant.label)
    return Contestant(entrant.label, None, entrant.map)
