"""What is done to what the window is about; changes become commands."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

from workbench.app.document.anchor_set import AnchorSet
from workbench.app.document.choices import PROBLEM_FIELDS, SOLVER_FIELDS, START_FIELDS, EarlierChoices
from workbench.app.document.document_state import DocumentState
from workbench.app.document.engine_bridge import EngineBridge
from workbench.app.document.first_anchors import SAMPLE, first_anchors
from workbench.app.document.first_start import with_own_start, with_start_held
from workbench.app.document.history import Curves
from workbench.app.document.orders import Orders
from workbench.app.quantities.quantities import Quantity
from workbench.app.sessions.restoring import (
    Wanted,
    anchors_in,
    drawn_parameters,
    is_on_same_source,
    name_of_anchor_change,
    suits,
    without_anchors,
)
from workbench.app.watches import Watches
from workbench.core.arrays import Floats, Integers
from workbench.engine.messages import (
    Dissect,
    Dissected,
    Failure,
    LegBegun,
    Load,
    Loaded,
    Pause,
    Refused,
    Snapshot,
    Step,
    TakeMap,
    Watch,
)
from workbench.engine.session_commands import leg_of
from workbench.session.journal import Journal
from workbench.session.session import Session


class Document(DocumentState):
    """The only one who posts commands, and takes what the engine reports. Nothing here draws."""

    def __init__(self, bridge: EngineBridge, session: Session | None = None) -> None:
        super().__init__(session)
        self._bridge = bridge
        self._orders = Orders(bridge)
        self.is_held = self._is_told = False
        self.opening_source = ""
        self._attempt: Session | None = None
        self._runs_after_open = False
        self._earlier = EarlierChoices()
        self._wanted: Wanted | None = None
        self.journal = Journal()
        self._is_opening = False
        self._watches = Watches()
        bridge.loaded.connect(self._take_loaded)
        bridge.snapshot.connect(self._take_snapshot)
        bridge.refused.connect(self._take_refused)
        bridge.failure.connect(self._take_failure)
        bridge.restarted.connect(self._take_restarted)
        bridge.dissected.connect(self._take_dissected)
        bridge.leg_begun.connect(self._take_leg)

    @property
    def is_restoring(self) -> bool:
        """Whether a state is to be gone to, once its mesh is open."""
        return self._wanted is not None

    @property
    def anchor_serial(self) -> int:
        """The number of the newest anchors; a snapshot tells which it holds."""
        return self._orders.anchor_serial

    # ------------------------------------------------------------------------------------------ opening

    def open(
        self,
        source: str,
        *,
        kind: str = "auto",
        fixes: tuple[str, ...] = (),
        run: bool = False,
        wanted: Wanted | None = None,
    ) -> None:
        """Ask for a mesh; the present one stays until the new one is there. `run` starts the solver then.

        `wanted` is the state to go to on it.
        """
        self.generation += 1
        self.opening_source = source
        self._wanted = wanted
        self._attempt = replace(self.session, source=source, kind=kind, fixes=fixes)
        self._runs_after_open = run
        if wanted is not None:  # its own choices follow with its map: those of another mesh need not suit this one
            self._orders.choices_unheard()
        else:
            self._orders.choices(self._attempt)
        self._bridge.post(Load(source=source, generation=self.generation, kind=kind, fixes=fixes))
        self.opening.emit(source)

    def restore(self, session: Session, positions: Floats | None, *, run: bool = False, curves: Curves | None = None) -> None:
        """Bring back choices with their anchors and a map (n, d), or the start where there is none; then run, or rest.

        `curves` are those that led to the map, where they are known.
        """
        there = self.positions if is_on_same_source(session, self.session) and not self.opening_source else None
        wanted = Wanted(session, positions, run, curves)
        is_here = positions is not None and there is not None and there.shape == positions.shape
        if is_here and suits(session, there):
            self._take_up(wanted)
        else:
            self.open(session.source, kind=session.kind, fixes=session.fixes, wanted=wanted)

    def _take_up(self, wanted: Wanted) -> None:
        assert self.loaded is not None and wanted.positions is not None
        self._earlier.keep_all(self.complete_session)
        self._orders.number_anew()
        self._put(wanted.session)
        self._orders.take_up(wanted, self.loaded.generation)
        self._taken_up = (self.anchor_serial, wanted.positions)
        self.history_restarted.emit()
        if wanted.curves is not None:
            self.curves_returned.emit(wanted.curves)
        if wanted.runs:
            self._run()

    def _put(self, session: Session) -> None:
        """Hold these choices and anchors; the engine knows them, or is told by whoever calls."""
        self.session, self.anchors = without_anchors(session), anchors_in(session)
        self.wants_to_run = self.is_held = self._is_told = False
        self.select_all(self.selection)
        self.session_changed.emit()
        self.anchors_changed.emit()

    def open_sample(self, id: str, *, run: bool = True) -> None:
        """Open a mesh of our own generator with the anchors that suit it."""
        self.open(SAMPLE + id, run=run)

    def open_as(self, kind: str) -> None:
        """Read the present source once more for another kind of map."""
        session = self.session if self.loaded is not None else self._attempt
        if session is not None and session.source:
            self.open(session.source, kind=kind, fixes=session.fixes, run=self.wants_to_run)
        else:
            self.session = replace(self.session, kind=kind)

    @property
    def asked_source(self) -> str:
        """What was asked for last, opened or refused; empty at first."""
        return (self._attempt or self.session).source

    def try_again(self, fixes: tuple[str, ...]) -> None:
        """Read what was asked for last once more, with more fixes."""
        attempt = self._attempt or self.session
        new = tuple(name for name in fixes if name not in attempt.fixes)
        wanted, run = self._wanted, self._runs_after_open
        self.open(attempt.source, kind=attempt.kind, fixes=attempt.fixes + new, run=run, wanted=wanted)

    def _take_loaded(self, report: Loaded) -> None:
        if report.generation != self.generation:
            return
        if self._wanted is None:
            self._announce("Open")
        self.journal.clear()
        fresh = {"initializer": "", "initializer_parameters": {}, "start_file": "", "carried": "", "linear_equations": ()}
        self.session = replace(self._attempt or self.session, fixes=report.fixes, **fresh)
        self.opening_source = ""
        self.loaded = report
        self.snapshot = self._past = self._taken_up = None
        self.wants_to_run = self.is_held = self._is_told = False
        self.selection = ()
        self.anchors = AnchorSet.none()
        self._send_anchors(False)
        self._is_opening = True
        self.opened.emit()
        self.session_changed.emit()
        self.anchors_changed.emit()
        self.history_restarted.emit()

    def _take_refused(self, report: Refused) -> None:
        if report.command == "Watch":
            self.refused.emit(report)
        elif report.generation == self.generation or report.command != "Load":
            if report.command == "Load":
                self.opening_source = ""
                if self.mesh is not None:  # what was done to its anchors meanwhile, nobody has told the engine
                    self._send_anchors(False)
            if report.kept is not None and report.serial != self._orders.problem_serial:
                return  # another choice is on its way already
            if report.command == "TakeUp" and (self._taken_up is None or report.serial != self._taken_up[0]):
                return  # another moment is
            restored = self._earlier.restored(self.session, report)
            if restored is not None:
                self.session = restored
                self.session_changed.emit()
            elif report.command == "TakeUp":
                self._taken_up = None
                self._put(self._earlier.before_taking_up())
                self._send_anchors(False)  # under the number that is waited for
            elif report.command in ("Run", "Step"):
                self.wants_to_run = False
                self.session_changed.emit()
            self.refused.emit(report)

    def _take_failure(self, report: Failure) -> None:
        self.wants_to_run = False
        self._taken_up = None
        self.session_changed.emit()

    def _take_restarted(self) -> None:
        self._taken_up = None  # the engine goes on from the last map that it has told

    # ------------------------------------------------------------------------------------------ maps

    def _take_snapshot(self, snapshot: Snapshot) -> None:
        mesh = self.mesh
        # while another mesh is being read, the one on the screen goes on
        if self.loaded is None or mesh is None or snapshot.generation != self.loaded.generation:
            return
        if self._taken_up is not None and snapshot.anchor_serial < self._taken_up[0]:
            return  # of before the map that was brought back
        self.snapshot, self._taken_up = snapshot, None
        self._has_finished = snapshot.phase == "finished"
        self.snapshot_taken.emit()
        if self._past is None:
            self.shown_changed.emit()
        if self._is_opening:
            self._is_opening = False
            wanted, self._wanted = self._wanted, None
            if wanted is not None:
                self._go_on_to(wanted, snapshot.positions)
                return
            if (begun := with_own_start(self.loaded, self.session)) is not self.session:
                self.session = begun
                self._make_start()
                self.session_changed.emit()
            anchors = first_anchors(self.loaded, self.session.source, snapshot.positions)
            if len(anchors):
                self._put_anchors(anchors)
            if self._runs_after_open:
                self._run()

    def _go_on_to(self, wanted: Wanted, start: Floats) -> None:
        """The mesh of a session is open: its choices, its anchors, its map."""
        session = replace(wanted.session, fixes=self.session.fixes)
        positions = start if wanted.positions is None else wanted.positions
        if positions.shape == start.shape and suits(session, start):
            self._take_up(replace(wanted, session=session, positions=positions))
            if wanted.positions is None:
                none = replace(session, initializer="", initializer_parameters={}, start_file="")
                self._earlier.keep(none, {"initializer": ""})  # what is there already, if that start is refused
                self._make_start()
            return
        sentence = f"The session does not fit {session.source}: its map or its anchors are of another mesh, or of other fixes."
        self.refused.emit(Refused(self.generation, "Session", sentence))

    def _take_leg(self, report: LegBegun) -> None:
        if self.loaded is not None and report.generation == self.loaded.generation:
            self.journal.add(leg_of(report))

    def _announce(self, name: str, key: str = "") -> None:
        if self.snapshot is not None:
            self.changing.emit(name, key)

    # ------------------------------------------------------------------------------------------ watching

    def watch(self, owner: str, quantities: Iterable[Quantity] = (), singular_values: bool = False) -> None:
        """Say what `owner` (a view, by a name of its own) wants to see of each map, in place of what it wanted before.

        Snapshots carry what any owner wants: `Snapshot.fields[quantity.field]`, and `Snapshot.singular_values`. One with the
        new fields comes at once, also while the solver rests. Nothing wanted any longer: call it with the owner alone.
        """
        self._watches.set(owner, quantities, singular_values)
        self._orders.watch(self._watches.all)

    @property
    def watched(self) -> Watch:
        """What all want to see together."""
        return self._watches.all

    def watch_again(self) -> None:
        """The same as before, though a formula by the same name may be another one now."""
        self._orders.watch_again()

    # ------------------------------------------------------------------------------------------ choices

    def choose(self, **changes: Any) -> None:
        """Replace fields of the session and tell the engine what follows from it."""
        session = with_start_held(self.session, replace(self.session, **changes), self.loaded)
        if session == self.session:
            return
        names = set(changes)
        if self.opening_source:  # what is chosen now is for the mesh that is being read; its start is its own
            if names & START_FIELDS:
                self.session_changed.emit()
                return
            self._attempt = replace(self._attempt or self.session, **changes)
        self._announce("Choose", drawn_parameters(self.session, changes))
        self._earlier.keep(self.session, changes)
        self.session = session
        if names & PROBLEM_FIELDS:
            self.send_problem()
        if names & SOLVER_FIELDS:
            self._orders.solver(session)
        if names & START_FIELDS and self.mesh is not None:
            self._make_start()
        self.session_changed.emit()

    def send_problem(self) -> None:
        """Tell the engine the distortion once more: what its id means may have changed."""
        self._orders.problem(self.session)

    # ------------------------------------------------------------------------------------------ running

    def run(self) -> None:
        """Run the solver; while a mesh is being read, on that one as soon as it is there."""
        if self.opening_source:
            self._runs_after_open = True
            self._wanted = self._wanted and replace(self._wanted, runs=True)
            return
        if not self.is_at_work:
            self._announce("Run")
        self._run()

    def _run(self) -> None:
        if self.mesh is None:
            return
        self.wants_to_run, self._has_finished = True, False
        self._orders.run(self.session)
        self.session_changed.emit()

    def pause(self) -> None:
        self.wants_to_run = False
        self._bridge.post(Pause())
        self.session_changed.emit()

    def toggle(self) -> None:
        """Space: run where it rests or has finished, else pause."""
        if self.is_at_work:
            self.pause()
        else:
            self.run()

    def step(self) -> None:
        if self.mesh is not None and not self.opening_source:
            self._announce("Step", "step")
            self.wants_to_run = False
            self._bridge.post(Step(1))
            self.session_changed.emit()

    def reset(self) -> None:
        """Make the start anew; anchors stay where they are."""
        if self.mesh is not None and not self.opening_source:
            self._announce("Reset")
            self._make_start()

    def _make_start(self) -> None:
        self._orders.start(self.session)
        self.history_restarted.emit()
        if self.wants_to_run:
            self._run()

    def dissect(self) -> None:
        """Ask for the next step, taken apart; the map stays as it is."""
        self._bridge.post(Dissect())

    def _take_dissected(self, report: Dissected) -> None:
        if self.loaded is not None and report.generation == self.loaded.generation:
            self.dissected.emit(report)

    def take_map(self, positions: Floats) -> None:
        """Go on from a map (n, d) of the present mesh that was made elsewhere; it rests until it is run."""
        if self.loaded is not None:
            self._announce("Take a map")
            self.pause()
            self._bridge.post(TakeMap(self.loaded.generation, positions))
            self.history_restarted.emit()

    def stop(self) -> None:
        """End whatever goes on, also what hangs; the last good map stays."""
        self.wants_to_run = False
        self._bridge.stop()
        self.session_changed.emit()

    # ------------------------------------------------------------------------------------------ anchors

    def set_anchors(self, anchors: AnchorSet, *, dragging: bool = False, at: float | None = None, name: str = "") -> None:
        """Take these anchors; `at` is the time of the event behind it, for the drag meter, `name` what the step is called."""
        if self.mesh is None:
            return
        if anchors != self.anchors and not self._is_told:  # a drag is one step
            self._announce(name or name_of_anchor_change(self.anchors, anchors))
        self._is_told = dragging and (self._is_told or anchors != self.anchors)
        self.is_held = dragging
        self._put_anchors(anchors, dragging, at)

    def _put_anchors(self, anchors: AnchorSet, dragging: bool = False, at: float | None = None) -> None:
        self.anchors = anchors
        self.select_all(self.selection)
        self._send_anchors(dragging, at)
        self.anchors_changed.emit()

    def _send_anchors(self, dragging: bool, at: float | None = None) -> None:
        self._orders.anchor_serial += 1
        if self.opening_source:  # the engine would take them for those of the mesh that it reads
            return
        if at is not None:
            self.drag_sent.emit(self.anchor_serial, at)
        self._orders.anchors(self.anchors, 3 if self.kind == "volume" else 2, dragging)

    def add_anchor(self, vertex: int) -> None:
        """Hold a vertex where it is now."""
        if self.positions is not None and vertex not in self.anchors:
            self.set_anchors(self.anchors.with_target(vertex, self.positions[vertex]))
        self.select(vertex)

    def move_anchor(self, vertex: int, target: Floats, dragging: bool, at: float | None = None) -> None:
        if vertex in self.anchors:
            moment = time.perf_counter() if at is None else at
            self.set_anchors(self.anchors.with_target(vertex, target), dragging=dragging, at=moment)

    def remove_anchor(self, vertex: int) -> None:
        if vertex in self.anchors:
            self.set_anchors(self.anchors.without(vertex))

    def clear_anchors(self) -> None:
        if len(self.anchors):
            self.set_anchors(AnchorSet.none())

    def pin(self, vertices: Integers) -> None:
        """Hold more vertices where they are now; anchors that are there stay as they are."""
        if self.positions is not None:
            self.set_anchors(self.anchors.joined(AnchorSet.at(vertices, self.positions)))
