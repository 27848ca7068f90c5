"""Repeating a session without a window: the same legs from the same maps, so the same energies."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.constraints import Anchors
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.linear_equations import with_equations
from workbench.core.problem import Criteria, Problem
from workbench.core.registry import registry
from workbench.core.run import HistoryRow, RunResult, history_row, run
from workbench.core.solver import Interrupt, Solver, never
from workbench.core.state import State
from workbench.core.status import Status
from workbench.engine.exact_iterations import iterate_exactly
from workbench.engine.legs import state_without_past
from workbench.engine.starts import adjusted_start, default_initializer, make_start
from workbench.io.opening import OpenedSource
from workbench.session.journal import Leg
from workbench.session.record import SessionRecord
from workbench.session.session import Session


@dataclass(frozen=True, eq=False)
class Replayed:
    """What a session led to once more.

    Parameters
    ----------
    problem, solver : the last ones
    initializer : str        id of the start
    result : RunResult       `rows` are those of all legs, `initial` is where the first one begins
    farthest : float         largest distance of a vertex from where the recorded map has it; None where there is none
    """

    problem: Problem
    solver: Solver
    initializer: str
    result: RunResult
    farthest: float | None = None


def solver_of(session: Session, problem: Problem) -> Solver:
    """The solver of a session. Raises `WorkbenchError` where it does not take the problem."""
    method = registry().solver(session.solver)
    if problem.kind not in method.kinds:
        raise WorkbenchError(f"{method.label} does not solve {problem.kind} maps; choose another solver.")
    method.check_distortion(problem.distortion)
    solver: Solver = method.configured(session.solver_parameters)
    return solver


def anchors_of(session: Session, vertex_count: int, dimension: int) -> Anchors:
    """The anchors of a session that are in force, for a mesh. Raises `WorkbenchError` where any of them does not fit it."""
    if session.anchors_off:
        anchors_of(replace(session, anchors_off=frozenset()), vertex_count, dimension)
        session = session.in_force
    if not session.anchor_vertices:
        return Anchors.none(dimension)
    anchors = Anchors(
        np.array(session.anchor_vertices, dtype=np.int64),
        np.array(session.anchor_targets, dtype=np.float64),
        np.array(session.anchor_weights, dtype=np.float64) if session.anchor_weights else None,  # type: ignore[arg-type]
        np.array(session.anchor_groups, dtype=np.int64) if session.anchor_groups else None,  # type: ignore[arg-type]
    )
    anchors.check(vertex_count, dimension)
    return anchors


def problem_of(session: Session, opened: OpenedSource) -> Problem:
    """The problem of a session, its boundary free. Raises `WorkbenchError`."""
    mesh = opened.mesh
    distortion = Distortion.resolve(session.distortion, session.distortion_parameters)
    anchors = anchors_of(session, mesh.vertex_count, mesh.dimension)
    problem = Problem.create(mesh, opened.kind, distortion, anchors, allow_inversions=session.allow_inversions)
    return with_equations(problem, session.linear_equations)


def check_maps(record: SessionRecord, opened: OpenedSource) -> None:
    """Raises `WorkbenchError` where the maps of a session are not of this mesh."""
    wanted = (opened.mesh.vertex_count, opened.mesh.dimension)
    for positions in (record.map, *(leg.positions for leg in record.legs)):
        if positions is not None and positions.shape != wanted:
            raise WorkbenchError(
                f"The maps of the session have the shape {positions.shape}, and its mesh asks for {wanted}: "
                "it belongs to another mesh, or to other fixes."
            )


def replay(
    record: SessionRecord,
    opened: OpenedSource,
    *,
    interrupt: Interrupt = never,
    on_row: Callable[[HistoryRow], None] | None = None,
    on_state: Callable[[State], None] | None = None,
) -> Replayed:
    """Repeat what led to the map of a session.

    Its legs, iteration by iteration; where it has none, the map is taken as it is; where it has no map either, the solver
    runs from the start until it is done; `on_state` is told of every map then. Raises `WorkbenchError` for what does not fit.
    """
    check_maps(record, opened)
    problem = problem_of(record.session, opened)
    solver = solver_of(record.session, problem)
    initializer = initializer_of(record.session, opened, solver)
    if not record.legs and record.map is None:
        start = start_of(record.session, opened, initializer, problem)
        problem, session = _with_boundary(problem, record.session, start), record.session
        result = run(
            solver,
            problem,
            start,
            iterations=session.iterations,
            tolerance=session.tolerance,
            time_limit=session.time_limit,
            interrupt=interrupt,
            on_row=on_row,
            on_state=on_state,
        )
        return Replayed(problem, solver, initializer, result)
    return _repeat(record, opened, problem, solver, initializer, interrupt, on_row)


def _repeat(
    record: SessionRecord,
    opened: OpenedSource,
    problem: Problem,
    solver: Solver,
    initializer: str,
    interrupt: Interrupt,
    on_row: Callable[[HistoryRow], None] | None,
) -> Replayed:
    begin, rows = time.perf_counter(), []

    def note(row: HistoryRow) -> None:
        rows.append(row)
        if on_row is not None:
            on_row(row)

    positions, iteration = record.map, 0
    initial: State | None = None
    status = Status.INTERRUPTED
    for leg in record.legs:
        leg_problem = _problem_of_leg(problem, leg)
        if leg.origin != "previous":
            positions = leg.positions
            positions = start_of(leg.choices, opened, initializer, leg_problem) if positions is None else positions
        assert positions is not None
        leg_problem = _with_boundary(leg_problem, leg.choices, positions)
        first, last = iterate_exactly(
            solver_of(leg.choices, leg_problem),
            leg_problem,
            State(positions, iteration),
            leg.iterations,
            interrupt=interrupt,
            begin=begin,
            on_row=note,
        )
        initial = initial or first
        positions, iteration, status = last.positions, last.iteration, last.status
    assert positions is not None
    problem = _with_boundary(problem, record.session, positions).with_criteria(Criteria(record.session.tolerance))
    problem, last = state_without_past(solver, problem, State(positions, iteration))
    last = replace(last, status=status) if last.status is Status.RUNNING else last
    farthest = None if record.map is None else float(np.linalg.norm(positions - record.map, axis=1).max())
    total = time.perf_counter() - begin
    if not rows:
        note(history_row(problem, last, total))
    result = RunResult(last, initial or last, tuple(rows), {"total": total, **problem.workspace.all_seconds()})
    return Replayed(problem, solver, initializer, result, farthest)


def _problem_of_leg(problem: Problem, leg: Leg) -> Problem:
    choices = leg.choices
    distortion = Distortion.resolve(choices.distortion, choices.distortion_parameters)
    changed = problem.with_distortion(distortion, choices.allow_inversions).with_criteria(Criteria(choices.tolerance))
    changed = changed.with_anchors(anchors_of(choices, problem.mesh.vertex_count, problem.dimension))
    return with_equations(changed, choices.linear_equations)


def _with_boundary(problem: Problem, choices: Session, positions: Floats) -> Problem:
    """Hard anchors at all boundary vertices where the boundary is fixed: where `positions` has them."""
    if not choices.fixed_boundary:
        return problem
    boundary = problem.mesh.topology.boundary_vertices
    return problem.with_anchors(problem.anchors.with_added(boundary, positions[boundary]))


def initializer_of(session: Session, opened: OpenedSource, solver: Solver) -> str:
    """Id of the start of a session on a mesh."""
    if session.initializer:
        return session.initializer
    return "file" if opened.start is not None else default_initializer(opened.kind, solver.initializer)


def start_of(session: Session, opened: OpenedSource, initializer: str, problem: Problem) -> Floats:
    """(n, d) start that a session makes on a mesh for a problem. Raises `WorkbenchError`."""
    if opened.start is not None and not session.initializer:
        return adjusted_start(opened.mesh, opened.kind, opened.start, False)
    values, file = session.initializer_parameters, session.start_file
    return make_start(opened.mesh, opened.kind, initializer, values, file, session.match_area, problem)
