"""Trying the laws on a solver in a child process: one that hangs or crashes takes nothing with it."""

from __future__ import annotations

import multiprocessing
import os
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from workbench.core.errors import WorkbenchError
from workbench.core.registry import load_plugin, registry
from workbench.core.solver import Solver
from workbench.core.solver_laws import LAWS, Finding, try_law

START_LIMIT = 120.0
"""Seconds in which the child has to be ready; the first time ever it compiles."""
READY = "ready"
NOT_READY = "its process did not start in time."


@dataclass(frozen=True)
class _OnCase:
    """What the child is about to try."""

    case: str


@dataclass(frozen=True)
class Trial:
    """A solver to try: `id` of a registered one, or one that `file` defines; parameter values as text."""

    id: str
    file: str = ""
    values: Mapping[str, str] | None = None

    def solver(self) -> Solver:
        """The solver, made. Raises `WorkbenchError`."""
        known = solvers_in(self.file) if self.file else registry().solvers
        if self.id not in known:
            raise WorkbenchError(f"There is no solver {self.id!r}; there are: {', '.join(sorted(known))}.")
        solver: Solver = known[self.id].configured(dict(self.values or {}))
        return solver


def solvers_in(file: str) -> dict[str, type[Solver]]:
    """The solvers that a plugin file defines. Runs the file. Raises `WorkbenchError` where there are none."""
    found = load_plugin(Path(file))
    if found.failures:
        raise WorkbenchError(f"{file} cannot be used: {found.failures[0].sentence}")
    if not found.solvers:
        raise WorkbenchError(
            f"{file} defines no solver; a solver is a frozen dataclass, a subclass of Solver with id and label."
        )
    return found.solvers


def try_in_child(trial: Trial, time_limit: float) -> Iterator[Finding]:
    """Every law in turn. A law that takes longer than `time_limit` seconds, or ends the child, is broken; the next goes on.

    Raises `WorkbenchError` where the solver cannot be made.
    """
    left = list(LAWS)
    while left:
        yield from _one_child(trial, left, time_limit)


def solver_ids(file: str, time_limit: float) -> tuple[str, ...]:
    """Ids of the solvers that a plugin file defines; it is run in a process of its own. Raises `WorkbenchError`."""
    with _child(_list_solvers, file) as answers:
        found = _received(answers, START_LIMIT + time_limit)
    if not isinstance(found, tuple):
        raise WorkbenchError(f"{file} cannot be read: {found or NOT_READY}")
    return found


def _one_child(trial: Trial, left: list[str], time_limit: float) -> Iterator[Finding]:
    """Findings of one child, taken from the front of `left`, until all are tried or the child is lost."""
    with _child(_try_laws, trial, tuple(left)) as answers:
        said = _received(answers, START_LIMIT)
        if said != READY:
            raise WorkbenchError(f"{trial.file or trial.id} cannot be tried: {said or NOT_READY}")
        while left:
            finding = _finding(answers, left.pop(0), time_limit)
            yield finding
            if finding.cases == 0:  # the child is lost
                return


def _finding(answers: Connection, law: str, time_limit: float) -> Finding:
    """What the child finds of a law; one of no cases where it says nothing within the limit, or no more."""
    end, case = time.monotonic() + time_limit, ""
    while True:
        answer = _received(answers, max(0.0, end - time.monotonic()))
        if isinstance(answer, Finding):
            return answer
        if not isinstance(answer, _OnCase):
            said = f"it was not done after {time_limit:g} s." if answer is None else answer
            return Finding(law, False, 0, case, said)
        case = answer.case


def _received(answers: Connection, seconds: float) -> Any:
    """The next answer of a child, None where there is none in time; a sentence where it has ended.

    Raises the `WorkbenchError` that the child has sent.
    """
    try:
        answer: Any = answers.recv() if answers.poll(seconds) else None
    except (EOFError, ConnectionResetError):
        return "it ended its process."
    if isinstance(answer, WorkbenchError):
        raise answer
    return answer


@contextmanager
def _child(body: Callable[..., None], *arguments: Any) -> Iterator[Connection]:
    """A child that runs `body(connection, *arguments)`, for as long as the block lasts."""
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe()
    child = context.Process(target=_body, args=(there, body, arguments), daemon=True)
    child.start()
    there.close()
    try:
        yield here
    finally:
        here.close()
        child.kill()
        child.join()


def _body(connection: Connection, body: Callable[..., None], arguments: tuple[Any, ...]) -> None:
    sys.stdout = sys.stderr  # what the solver prints is not the report
    try:
        body(connection, *arguments)
    except WorkbenchError as error:
        connection.send(error)
    connection.close()
    sys.stderr.flush()
    os._exit(0)  # threads of a plugin shall not keep the process


def _list_solvers(connection: Connection, file: str) -> None:
    connection.send(tuple(sorted(solvers_in(file))))


def _try_laws(connection: Connection, trial: Trial, laws: tuple[str, ...]) -> None:
    solver = trial.solver()
    connection.send(READY)
    for name in laws:
        connection.send(try_law(solver, LAWS[name], lambda case: connection.send(_OnCase(case))))
