"""The engine's loop as a plain object: commands in, reports out; it runs in the child process and inline alike."""

from __future__ import annotations

import time
import traceback
from collections.abc import Callable
from dataclasses import replace
from multiprocessing.connection import Connection

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.constraints import Anchors
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.guarded_step import checked, guarded_step
from workbench.core.linear_equations import with_equations
from workbench.core.mesh import Mesh
from workbench.core.method import Kind
from workbench.core.problem import Criteria, Problem
from workbench.core.registry import registry
from workbench.core.run import HistoryRow, history_row
from workbench.core.solver import Solver
from workbench.core.state import Approach, State
from workbench.core.status import Status
from workbench.engine.admission import check_admissible
from workbench.engine.hand import HandFollower
from workbench.engine.legs import LegBook, state_without_past
from workbench.engine.messages import (
    Command,
    Dissect,
    Dissected,
    Failure,
    Load,
    MapReport,
    Pause,
    Progress,
    Quit,
    Report,
    Reset,
    Restore,
    Run,
    SetAnchors,
    SetProblem,
    SetSolver,
    Step,
    TakeMap,
    TakeUp,
)
from workbench.engine.reports import loaded_report, refusal
from workbench.engine.run_budget import RunBudget
from workbench.engine.starts import adjusted_start, default_initializer, make_start

HAND_RESTS = 0.12
"""Seconds without a new anchor command after which the full solver goes on, though the hand still holds the anchor."""
HAND_LETS_GO = 0.05
"""Seconds after a release in which the last events are answered before the full solver starts."""


class EngineLoop:
    """One mesh, one problem, one solver, one map; `handle` and `advance` are called in turn by whoever owns it."""

    def __init__(
        self,
        publish: Callable[[Report], None],
        pending: Callable[[], bool] = lambda: False,
        corrector: Connection | None = None,
    ) -> None:
        """`publish` takes every report; `pending` tells whether a command other than `SetAnchors` waits.

        `corrector` leads to a process that runs `workbench.engine.corrector.corrector_main`; without it the loop does all
        by itself.
        """
        self._hand = HandFollower(corrector, pending)
        self._legs = LegBook()
        self._publish = publish
        self._pending = pending
        self._generation = 0
        self._mesh: Mesh | None = None
        self._kind: Kind = "plane"
        self._file_start: Floats | None = None
        self._choices = SetProblem()
        self._solver_choice = SetSolver()
        self._reset = Reset()
        self._anchors: SetAnchors | None = None
        self._boundary_positions: Floats | None = None
        self._solver: Solver | None = None
        self._problem: Problem | None = None
        self._state: State | None = None
        self._budget = RunBudget()
        self._seconds = 0.0
        self._rows: list[HistoryRow] = []
        self._number = 0
        self._hand_until = 0.0
        self._timing: dict[str, float] = {}
        self.has_quit = False

    # ----------------------------------------------------------------------------------------- commands

    def handle(self, command: Command) -> None:
        """Carry out a command; what goes wrong becomes a `Refused` or `Failure` report."""
        try:
            self._dispatch(command)
        except WorkbenchError as error:
            self._publish(refusal(command, error, self._generation, self._choices))
        except (Exception, SystemExit) as error:
            self._fail(f"{type(command).__name__} failed: {type(error).__name__}: {error}", traceback.format_exc())

    def _dispatch(self, command: Command) -> None:
        if isinstance(command, Load):
            self._load(command)
        elif isinstance(command, Restore):
            self._restore(command)
        elif isinstance(command, SetProblem):
            self._set_problem(command)
        elif isinstance(command, SetSolver):
            self._set_solver(command)
        elif isinstance(command, SetAnchors):
            self._set_anchors(command)
        elif isinstance(command, Reset):
            self._make_start(command)
        elif isinstance(command, TakeMap):
            if command.generation == self._generation and self._problem is not None:
                self._seconds = 0.0
                self._start_from(command.positions, 0)
        elif isinstance(command, TakeUp):
            self._take_up_all(command)
        elif isinstance(command, Run):
            self._budget.run(command)
            self._begin_run()
            if not self.is_active and self._state is not None:
                self.publish_map()  # it cannot run, and the status says why
        elif isinstance(command, Pause):
            self._budget.rest()
            self.publish_map()
        elif isinstance(command, Step):
            self._budget.step(command.count)
            self._begin_run()
        elif isinstance(command, Dissect):
            self._dissect()
        elif isinstance(command, Quit):
            self.has_quit = True

    def _dissect(self) -> None:
        if self._problem is None or self._state is None or self._solver is None:
            raise WorkbenchError("There is no map yet whose next step could be taken apart; open a mesh first.")
        from workbench.core.dissection import dissect

        found = dissect(self._solver, self._problem, self._state)
        # what is the solver's own need not cross the process boundary
        before, after = (replace(state, memory=None, approach=Approach()) for state in (found.before, found.after))
        found = replace(found, before=before, after=after)
        self._publish(Dissected(self._generation, self._solver.label, found, found.after.status.value))

    def _load(self, command: Load) -> None:
        from workbench.io.opening import open_source

        self._publish(Progress(f"Reading {command.source} …"))
        opened = open_source(command.source, kind=command.kind, fixes=command.fixes, tets=command.tets)
        # Whatever refuses the mesh (a formula that does not exist in its dimension, say) leaves the old one in force.
        distortion = Distortion.resolve(self._choices.distortion, self._choices.parameters)
        problem = Problem.create(opened.mesh, opened.kind, distortion, allow_inversions=self._choices.allow_inversions)
        self._choices = replace(self._choices, equations=())
        self._configured_solver(self._solver_choice, problem)
        if self._mesh is not None:  # the start that was chosen for another mesh is not for this one
            self._reset = Reset(match_area=self._reset.match_area)
        self._generation = command.generation
        self._mesh, self._kind, self._file_start = opened.mesh, opened.kind, opened.start
        self._budget.rest()
        self._anchors = None
        self._problem, self._state, self._boundary_positions = problem, None, None
        self._publish(loaded_report(command, opened))
        self._make_start(self._reset)

    def _restore(self, command: Restore) -> None:
        self._generation, self._mesh, self._kind = command.generation, command.mesh, command.kind
        self._file_start = command.positions
        distortion = Distortion.resolve(self._choices.distortion, self._choices.parameters)
        problem = Problem.create(command.mesh, command.kind, distortion, allow_inversions=self._choices.allow_inversions)
        self._problem = with_equations(problem, self._choices.equations)
        self._number = command.number
        self._start_from(command.positions, command.iteration)
        self._file_start = None

    def _make_start(self, command: Reset) -> None:
        if self._mesh is None:
            self._reset = command
            return
        assert self._problem is not None
        if self._file_start is not None and not command.initializer:
            start = adjusted_start(self._mesh, self._kind, self._file_start, False)
        else:
            if command.initializer or self._mesh.simplex_count > 20_000:
                self._publish(Progress("Making the start …"))
            problem = self._problem.with_anchors(self._all_anchors())
            wished = registry().solver(self._solver_choice.solver).initializer
            id = command.initializer or default_initializer(self._kind, wished)
            start = make_start(self._mesh, self._kind, id, command.parameters, command.file, command.match_area, problem)
        self._reset = command
        self._seconds = 0.0
        self._start_from(start, 0, "start")

    def _take_up_all(self, command: TakeUp) -> None:
        if command.generation != self._generation or self._problem is None:
            return
        choices, held = command.problem, command.anchors
        distortion = Distortion.resolve(choices.distortion, choices.parameters)
        problem = with_equations(self._problem.with_distortion(distortion, choices.allow_inversions), choices.equations)
        self._configured_solver(command.solver, problem)
        held.anchors.check(problem.mesh.vertex_count, problem.dimension)
        self._choices, self._solver_choice, self._anchors, self._problem = choices, command.solver, held, problem
        self._budget.rest()
        self._boundary_positions, self._seconds = None, command.seconds
        self._start_from(command.positions, command.iteration)

    def _start_from(self, start: Floats, iteration: int, origin: str = "map") -> None:
        assert self._problem is not None
        self._legs.moved(origin)
        self._solver = self._configured_solver(self._solver_choice, self._problem)
        if self._choices.fixed_boundary:
            self._boundary_positions = start[self._boundary()].copy()
        self._problem = self._problem.with_anchors(self._all_anchors()).from_start(start)
        self._state = replace(self._solver.init(self._problem, start), iteration=iteration)
        self._rows = [history_row(self._problem, self._state, self._seconds)]
        self._hand.moved()
        self._begin_run()
        self.publish_map()

    def _set_problem(self, command: SetProblem) -> None:
        distortion = Distortion.resolve(command.distortion, command.parameters)
        boundary_changes = command.fixed_boundary != self._choices.fixed_boundary
        if self._problem is not None:
            old = self._problem.density
            same = distortion == old.distortion and command.allow_inversions == old.allow_inversions
            # Whatever refuses the new distortion (a dimension it does not have, say) leaves the old one in force.
            if self._solver is not None:
                self._solver.check_distortion(distortion)
            changed = self._problem if same else self._problem.with_distortion(distortion, command.allow_inversions)
            if command.equations != self._choices.equations:
                changed = with_equations(changed, command.equations)
            if self._state is not None:
                changed = changed.from_start(self._state.positions)
                if not same:
                    check_admissible(changed, self._state.positions)
            self._choices = command
            self._problem = changed
            if boundary_changes and self._state is not None:
                self._boundary_positions = (
                    self._current().positions[self._boundary()].copy() if command.fixed_boundary else None
                )
            if self._state is not None:
                self._rebase()
        self._choices = command

    def _set_solver(self, command: SetSolver) -> None:
        solver = self._configured_solver(command, self._problem)
        self._solver_choice = command
        if self._state is not None:
            self._solver = solver
            self._rebase()

    def _configured_solver(self, choice: SetSolver, problem: Problem | None) -> Solver:
        """Raises `WorkbenchError` where the solver does not take the problem."""
        method = registry().solver(choice.solver)
        if problem is not None:
            if problem.kind not in method.kinds:
                raise WorkbenchError(f"{method.label} does not solve {problem.kind} maps; choose another solver.")
            method.check_distortion(problem.distortion)
        solver: Solver = method.configured(choice.parameters)
        return solver

    def _set_anchors(self, command: SetAnchors) -> None:
        grace = HAND_RESTS if command.dragging else HAND_LETS_GO if self._is_dragging else 0.0
        self._hand_until = time.perf_counter() + grace
        previous, self._anchors = self._anchors, command
        if self._problem is None or self._state is None:
            return
        try:
            anchors = self._all_anchors()
            anchors.check(self._problem.mesh.vertex_count, self._problem.dimension)
        except WorkbenchError:
            self._anchors = previous
            raise
        old = self._problem.anchors
        self._problem = self._problem.with_anchors(anchors)
        if np.array_equal(old.hard_vertices, anchors.hard_vertices) and not len(anchors.soft[0]):
            # Only targets moved: the energy and what the walk has learnt so far stay true.
            state = self._state
            self._state = replace(
                state,
                anchor_error=self._problem.anchor_error(state.positions),
                previous_energy=float("nan"),
                status=Status.RUNNING if state.status is not Status.INVERTED_START else state.status,
                memory=None,
                approach=replace(state.approach, stuck=0),
            )
            self._hand.moved()
            self._legs.changed()
            self._begin_run()
        else:
            self._rebase()
        if not self.is_active:
            self.publish_map()

    def _boundary(self) -> np.ndarray:
        assert self._mesh is not None
        return self._mesh.topology.boundary_vertices

    def _all_anchors(self) -> Anchors:
        assert self._mesh is not None
        anchors = Anchors.none(self._mesh.dimension)
        if self._anchors is not None and len(self._anchors.vertices):
            anchors = self._anchors.anchors
        if self._boundary_positions is not None:
            anchors = anchors.with_added(self._boundary(), self._boundary_positions)
        return anchors

    def _current(self) -> State:
        assert self._state is not None
        return self._state

    def _rebase(self) -> None:
        assert self._problem is not None and self._solver is not None
        self._problem = self._problem.with_anchors(self._all_anchors())
        state = self._solver.rebase(self._problem, self._current())
        if state.inverted and self._problem.density.meets_barrier(state.positions):
            state = replace(state, status=Status.INVERTED_START)
        self._state = state
        self._hand.moved()
        self._legs.changed()
        self._begin_run()
        if not self.is_active:
            self.publish_map()

    def _begin_run(self) -> None:
        self._budget.begin(self._seconds)
        if self._state is not None:
            if self._problem is not None:
                self._problem = self._problem.with_criteria(Criteria(self._budget.limits.tolerance))
            if self._state.status not in (Status.RUNNING, Status.INVERTED_START, Status.NONFINITE):
                # Asked again: what stopped it then (a limit, a looser tolerance) may not stop it now.
                self._state = replace(self._state, status=Status.RUNNING, previous_energy=float("nan"))
                self._legs.changed()

    # -------------------------------------------------------------------------------------------- steps

    @property
    def is_active(self) -> bool:
        """Whether `advance` has something to do."""
        return self._budget.wants_more and self._state is not None and self._state.status is Status.RUNNING

    @property
    def phase(self) -> str:
        if self._state is None or not self._budget.wants_more:
            return "idle"
        if self._state.status is not Status.RUNNING:
            return "finished"
        return "dragging" if self._is_dragging else "running"

    @property
    def _hand_moves(self) -> bool:
        """Whether the next event of a hand is to be expected within moments, or its last one is still to be answered."""
        return self._budget.is_running and time.perf_counter() < self._hand_until

    @property
    def _is_dragging(self) -> bool:
        return self._anchors is not None and self._anchors.dragging

    def advance(self) -> bool:
        """One iteration, if there is one to take; false when the map is settled and only a new command can change it."""
        if not self.is_active:
            return False
        by_hand = self._hand_moves
        begin = time.perf_counter()
        assert self._problem is not None and self._solver is not None
        before = self._problem.workspace.all_seconds()
        state, solver = self._current(), self._solver
        try:
            if not (by_hand or self._is_dragging or self._legs.is_open):
                state = self._open_leg(solver)
            problem = self._problem
            following = self._step(problem, state, solver, by_hand) if state.status is Status.RUNNING else state
        except Exception as error:
            self._budget.rest()
            step = f"{solver.label} failed in step {state.iteration + 1}: {type(error).__name__}: {error}"
            self._fail(error.sentence if isinstance(error, WorkbenchError) else step, traceback.format_exc())
            self.publish_map()
            return False
        if following is None:
            return False
        if not self._legs.is_open:
            self._legs.moved()
        elapsed = time.perf_counter() - begin
        self._seconds += elapsed
        after = problem.workspace.all_seconds()
        self._timing = {k: after[k] - before.get(k, 0.0) for k in after}
        self._take_up(problem, solver, state, following)
        return True

    def _open_leg(self, solver: Solver) -> State:
        """Forget what only this process knows, and tell from where the solver goes on."""
        assert self._problem is not None
        self._problem, self._state = state_without_past(solver, self._problem, self._current())
        choices = self._choices, self._solver_choice, self._anchors, self._budget.limits.tolerance
        self._publish(self._legs.open(self._generation, self._state, choices))
        return self._state

    def _step(self, problem: Problem, state: State, solver: Solver, by_hand: bool) -> State | None:
        if by_hand:
            following = self._hand.step(problem, state)
            return None if following is None else checked(solver, problem, state, following)
        return guarded_step(solver, problem, state, self._pending)

    @property
    def waits_for(self) -> list[Connection]:
        """What else than a command can give `advance` or `tend` something to do."""
        return self._hand.waits_for

    def tend(self) -> None:
        """Housekeeping while there is no step to take."""
        if self._problem is not None and not self.is_active:
            self._hand.tend(self._problem)

    def _take_up(self, problem: Problem, solver: Solver, state: State, following: State) -> None:
        if following.status is Status.INTERRUPTED:
            self._state = replace(following, status=Status.RUNNING)
            return
        moving = self._hand_moves and following.status is Status.RUNNING
        status = Status.RUNNING if moving else solver.terminate(problem, following)
        if following.iteration > state.iteration:
            self._budget.count()
            self._rows.append(history_row(problem, following, self._seconds))
        self._state = replace(following, status=self._budget.status(status, self._seconds))
        self.publish_map()

    # ------------------------------------------------------------------------------------------ reports

    def publish_map(self) -> None:
        """Report the map as it is now, with all history since the last report."""
        state, problem = self._state, self._problem
        if state is None or problem is None:
            return
        self._number += 1
        rows, self._rows = tuple(self._rows) or (history_row(problem, state, self._seconds),), []
        self._publish(
            MapReport(
                generation=self._generation,
                number=self._number,
                positions=state.positions,
                phase=self.phase,
                status=state.status,
                rows=rows,
                anchor_serial=self._anchors.serial if self._anchors else 0,
                limiting_simplex=state.limiting_simplex if problem.anchors_lag(state.positions) else -1,
                inverted=state.inverted,
                seconds_published=time.perf_counter(),
                timing=self._timing,
                solver=self._solver_choice.solver,
                distortion=problem.distortion.id,
                leg=self._legs.leg,
            )
        )

    def _fail(self, sentence: str, details: str) -> None:
        self._publish(Failure(self._generation, sentence, details))
