"""Solving from a notebook or a script: the code of `workbench solve`, with results in hand."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from dataclasses import replace
from numbers import Integral, Real
from typing import Any

from numpy.typing import ArrayLike

from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.linear_equations import read_equations
from workbench.core.mesh import Mesh
from workbench.core.problem import Criteria, Problem
from workbench.core.run import HistoryRow, RunResult
from workbench.core.solver import Solver
from workbench.core.state import State
from workbench.engine.exact_iterations import iterate_exactly
from workbench.engine.interrupt import InterruptFlag
from workbench.engine.last_map_run import run_to_last_map
from workbench.engine.preparation import Prepared, Wishes, prepare
from workbench.notebook.progress import ProgressLine
from workbench.notebook.solution import Solution
from workbench.notebook.source import AnchorsGiven, Source, anchors_given, source_of, source_of_problem
from workbench.notebook.wording import in_words_of_scripts

StartGiven = str | os.PathLike[str] | ArrayLike | Solution | None
"""An initializer, a file, positions (n, d), or an earlier result to go on from; None: the default of the kind of map."""


@in_words_of_scripts
def solve(
    what: Source | Problem | Mesh | str | os.PathLike[str],
    distortion: str | Distortion | None = None,
    *,
    solver: str | Solver = "projected-newton",
    init: StartGiven = None,
    anchors: AnchorsGiven = None,
    equations: str | os.PathLike[str] | Sequence[str] | None = None,
    iterations: int = 1000,
    tolerance: float = 1e-6,
    gradient_tolerance: float | None = None,
    time_limit: float = math.inf,
    parameters: Mapping[str, Any] | None = None,
    init_parameters: Mapping[str, Any] | None = None,
    kind: str = "auto",
    fixes: Sequence[str] = (),
    pin_boundary: bool = False,
    allow_inversions: bool = False,
    match_area: bool = True,
    seed: int = 0,
    exactly: bool = False,
    progress: bool | Callable[[HistoryRow], None] = True,
) -> Solution:
    """The map of least distortion, found as `workbench solve` finds it: the same energies, bit for bit.

    Parameters
    ----------
    what                   a loaded mesh, a problem, a mesh, a file or `sample:ID` (`kind` and `fixes` are for files)
    distortion             an id, a formula, or a distortion; None: symmetric-dirichlet, or that of the problem
    solver                 an id, or a solver made by `solver(id, ...)`
    init                   an initializer, a file, positions (n, d), or an earlier result to go on from
    anchors                {vertex: target}, (vertices, targets), `Anchors`, or a CSV file; None: those of the mesh
    equations              linear constraints: lines such as "x[12] - x[30] = 0", or a file of them
    iterations, time_limit        limits, the latter in seconds
    tolerance, gradient_tolerance    when it is done (see `Solver.terminate`)
    parameters             of the distortion, the solver or the initializer by name, the first that has it
    init_parameters        of the initializer alone
    pin_boundary           hard anchors at all boundary vertices, where the start has them
    allow_inversions       let distortions without a barrier invert simplices
    match_area             scale a start whose own scale means nothing to the area of the source
    seed                   for methods that draw random numbers
    exactly                take exactly `iterations` steps, whatever the tolerances say
    progress               a line about each iteration that writes over itself; or what is called with each row

    Ctrl+C, or the notebook's stop button, ends it with the last map. How it ended is the `status` of the result, and no
    exception. Raises `WorkbenchError` for what does not fit: what is wrong and what to do.
    """
    _check_limits(iterations, tolerance=tolerance, gradient_tolerance=gradient_tolerance, time_limit=time_limit)
    problem = what if isinstance(what, Problem) else None
    source = source_of_problem(problem) if problem is not None else source_of(what, kind, fixes)  # type: ignore[arg-type]
    earlier = init if isinstance(init, Solution) else None
    held = anchors_given(anchors, source)
    wishes = Wishes(
        distortion=distortion or ("symmetric-dirichlet" if problem is None else problem.distortion),
        settings=tuple((parameters or {}).items()),
        init=earlier.positions if earlier else os.fspath(init) if isinstance(init, os.PathLike) else init,  # type: ignore[arg-type]
        init_parameters=init_parameters or {},
        match_area=match_area,
        anchors=problem.anchors if problem is not None and held is None else held,
        equations=_equations(equations),
        pin_boundary=pin_boundary,
        allow_inversions=allow_inversions or (problem is not None and problem.density.allow_inversions),
        seed=seed,
    )
    prepared = prepare(wishes, source.opened, solver)
    if problem is not None and problem.constraints is not None and equations is None:
        prepared = replace(prepared, problem=prepared.problem.with_constraints(problem.constraints))
    line = nullcontext(progress) if callable(progress) else ProgressLine(progress)
    with InterruptFlag() as interrupt, line as on_row:
        if exactly:
            result, fault = _exactly(prepared, iterations, tolerance, earlier, interrupt, on_row), ""
        else:
            result, fault = run_to_last_map(
                prepared.solver,
                prepared.problem,
                prepared.start,
                iterations=iterations,
                tolerance=tolerance,
                gradient_tolerance=gradient_tolerance,
                time_limit=time_limit,
                interrupt=interrupt,
                on_row=on_row,
            )
    return Solution(prepared, result, fault)


def _check_limits(iterations: int, **amounts: float | None) -> None:
    """Raises `WorkbenchError` for what is no number of iterations, tolerance or time."""
    if not isinstance(iterations, Integral) or iterations < 0:
        raise WorkbenchError(f"iterations is {iterations!r}; it has to be a whole number from 0 on.")
    for name, amount in amounts.items():
        if amount is not None and not (isinstance(amount, Real) and amount >= 0):
            raise WorkbenchError(f"{name} is {amount!r}; it has to be a number from 0 on.")


def _equations(given: str | os.PathLike[str] | Sequence[str] | None) -> str | Sequence[str]:
    """The name of a file, or lines; a text with an equals sign that names no file is lines."""
    if isinstance(given, str) and "=" in given and not os.path.exists(given):
        return read_equations(given)
    return os.fspath(given) if isinstance(given, os.PathLike) else given or ()


def _exactly(
    prepared: Prepared,
    iterations: int,
    tolerance: float,
    earlier: Solution | None,
    interrupt: InterruptFlag,
    on_row: Callable[[HistoryRow], None],
) -> RunResult:
    rows: list[HistoryRow] = []

    def note(row: HistoryRow) -> None:
        rows.append(row)
        on_row(row)

    problem = prepared.problem.with_criteria(Criteria(tolerance))
    state = State(prepared.start, earlier.iterations if earlier else 0)
    first, last = iterate_exactly(prepared.solver, problem, state, iterations, interrupt=interrupt, on_row=note)
    return RunResult(last, first, tuple(rows), {"total": rows[-1].seconds, **problem.workspace.all_seconds()})
