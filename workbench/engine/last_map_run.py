"""A run whose last map is kept even where the solver raises: a plugin's fault costs a step, not the work."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from workbench.core.arrays import Floats
from workbench.core.errors import WorkbenchError
from workbench.core.problem import Problem
from workbench.core.run import HistoryRow, RunResult, run
from workbench.core.solver import Solver
from workbench.core.state import State


def run_to_last_map(
    solver: Solver,
    problem: Problem,
    start: Floats,
    *,
    on_row: Callable[[HistoryRow], None] = lambda row: None,
    on_state: Callable[[State], None] = lambda state: None,
    **limits: Any,
) -> tuple[RunResult, str]:
    """The result, and the sentence of a solver that raised, else an empty one; such a result ends at its last map.

    start : (n, d) float64;  limits : as `workbench.core.run.run` takes them

    Raises `WorkbenchError` for a solver that failed before it had a map.
    """
    rows: list[HistoryRow] = []
    states: list[State] = []
    begin = time.perf_counter()

    def keep_row(row: HistoryRow) -> None:
        rows.append(row)
        on_row(row)

    def keep_state(state: State) -> None:
        states[:] = [state] if not states else [states[0], state]
        on_state(state)

    try:
        return run(solver, problem, start, on_row=keep_row, on_state=keep_state, **limits), ""
    except (Exception, SystemExit) as error:
        if not states:
            raise WorkbenchError(f"{solver.label} failed at the start: {type(error).__name__}: {error}") from error
        seconds = {"total": time.perf_counter() - begin, **problem.workspace.all_seconds()}
        step = f"{solver.label} failed in step {states[-1].iteration + 1}: {type(error).__name__}: {error}"
        sentence = error.sentence if isinstance(error, WorkbenchError) else step
        return RunResult(states[-1], states[0], tuple(rows), seconds), sentence
