"""So many iterations and no other number, as a session repeats them: whatever the criteria say meanwhile."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace

from workbench.core.guarded_step import guarded_step
from workbench.core.problem import Problem
from workbench.core.run import HistoryRow, history_row
from workbench.core.solver import Interrupt, Solver, never
from workbench.core.state import State
from workbench.core.status import Status
from workbench.engine.legs import state_without_past

MOST_IDLE = 100
"""Steps in a row that may change what a solver remembers and no more."""


def iterate_exactly(
    solver: Solver,
    problem: Problem,
    state: State,
    iterations: int,
    *,
    interrupt: Interrupt = never,
    begin: float | None = None,
    on_row: Callable[[HistoryRow], None] = lambda row: None,
) -> tuple[State, State]:
    """First and last state of `iterations` steps from the map of `state`, its iterations counted on.

    The solver begins anew, knowing the map alone. It ends early where it has nothing left to do. `begin` is when the clock
    of the rows began, in seconds of `time.perf_counter`. Raises `SolverFaultError` where the solver itself is at fault.
    """
    started = time.perf_counter() if begin is None else begin
    problem, state = state_without_past(solver, problem, state)
    first = state
    on_row(history_row(problem, state, time.perf_counter() - started))
    end, idle, ended = state.iteration + iterations, 0, Status.RUNNING
    while state.iteration < end and idle < MOST_IDLE and not interrupt():
        following = guarded_step(solver, problem, state, interrupt)
        if following.iteration > state.iteration:
            idle = 0
            on_row(history_row(problem, following, time.perf_counter() - started))
        elif following.status is not Status.RUNNING:
            ended = following.status
            break
        else:
            idle += 1
        ended = solver.terminate(problem, following)
        state = replace(following, status=Status.RUNNING)
    return first, replace(state, status=Status.INTERRUPTED if ended is Status.RUNNING else ended)
