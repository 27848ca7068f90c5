"""The only plain loop, and the record of a run."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from workbench.core.arrays import Floats
from workbench.core.guarded_step import guarded_step
from workbench.core.history_row import HistoryRow
from workbench.core.problem import Criteria, Problem
from workbench.core.solver import Interrupt, Solver, never
from workbench.core.state import State
from workbench.core.status import Status


@dataclass(frozen=True)
class Limits:
    """What a user allows a run: `iterations` steps, `seconds` of solving."""

    iterations: int = 1000
    seconds: float = float("inf")


@dataclass(frozen=True, eq=False, repr=False)
class RunResult:
    """`state.status` says how it ended; `seconds` has total, setup, assemble, factorise, solve, line_search."""

    state: State
    initial: State
    rows: tuple[HistoryRow, ...]
    seconds: dict[str, float] = field(default_factory=dict)

    def __repr__(self) -> str:
        state = self.state
        how = f"{state.status.name}, iteration {state.iteration}, energy {state.energy:.10g}, {state.inverted} inverted"
        return f"<RunResult {how}, anchors off by {state.anchor_error:.3g} at most>"


def history_row(problem: Problem, state: State, seconds: float) -> HistoryRow:
    """The line of the history that belongs to `state`."""
    return HistoryRow(
        iteration=state.iteration,
        seconds=seconds,
        energy=state.energy,
        mean_distortion=state.energy / problem.total_measure,
        gradient_norm=state.gradient_norm,
        step_size=state.step_size,
        inverted=state.inverted,
        anchor_error=state.anchor_error,
    )


def step_within(
    solver: Solver,
    problem: Problem,
    state: State,
    limits: Limits,
    taken: int,
    elapsed: Callable[[], float],
    interrupt: Interrupt = never,
) -> State:
    """The state after one more step with its status told, or the same map with the status of the limit that forbids a step.

    Parameters
    ----------
    taken : int            steps so far
    elapsed : callable     seconds so far; also asked within the step, which ends with the old map when they are up

    Raises `SolverFaultError` where the solver itself is at fault.
    """

    def is_late() -> bool:
        return elapsed() >= limits.seconds

    if taken >= limits.iterations:
        return replace(state, status=Status.MAX_ITERATIONS)
    if is_late():
        return replace(state, status=Status.TIME_LIMIT)
    if interrupt():
        return replace(state, status=Status.INTERRUPTED)
    following = guarded_step(solver, problem, state, lambda: interrupt() or is_late())
    if following.status is Status.INTERRUPTED and not interrupt():
        following = replace(following, status=Status.TIME_LIMIT)
    return replace(following, status=solver.terminate(problem, following))


def run(
    solver: Solver,
    problem: Problem,
    positions: Floats,
    *,
    iterations: int = 1000,
    tolerance: float = 1e-6,
    gradient_tolerance: float | None = None,
    time_limit: float = float("inf"),
    interrupt: Interrupt = never,
    on_row: Callable[[HistoryRow], None] | None = None,
    on_state: Callable[[State], None] | None = None,
) -> RunResult:
    """Minimise from `positions` until a criterion of `Solver.terminate` or a limit stops it.

    Parameters
    ----------
    positions : (N, d) float64     the start
    iterations, time_limit         limits; the map so far is returned with MAX_ITERATIONS or TIME_LIMIT
    interrupt : callable           true ends the run with the last accepted map and INTERRUPTED
    on_row, on_state : callable    told after the start and after each step

    A failure is the status of the state. Raises `SolverFaultError` where the solver itself is at fault.
    """
    problem = problem.with_criteria(Criteria(tolerance, gradient_tolerance)).from_start(positions)
    begin = time.perf_counter()
    state = initial = solver.init(problem, positions)
    solver.prepare(problem)
    setup = time.perf_counter() - begin
    before = problem.workspace.all_seconds()
    rows: list[HistoryRow] = []

    def elapsed() -> float:
        return time.perf_counter() - begin

    def record() -> None:
        rows.append(history_row(problem, state, elapsed()))
        if on_row:
            on_row(rows[-1])
        if on_state:
            on_state(state)

    record()
    taken = 0
    limits = Limits(iterations, time_limit)
    while state.status is Status.RUNNING:
        state = step_within(solver, problem, state, limits, taken, elapsed, interrupt)
        taken += 1
        if state.iteration > rows[-1].iteration:
            record()
    total = time.perf_counter() - begin
    after = problem.workspace.all_seconds()
    seconds = {"total": total, "setup": setup, **{k: after[k] - before.get(k, 0.0) for k in after}}
    return RunResult(state, initial, tuple(rows), seconds)
