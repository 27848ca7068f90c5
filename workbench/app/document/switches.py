"""When the user switched solver, distortion, a parameter or what is held while the solver ran, and to what."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from workbench.app.document.choices import PROBLEM_FIELDS, SOLVER_FIELDS
from workbench.app.document.document import Document
from workbench.app.document.history import History
from workbench.app.panels.distortion_box import title_of
from workbench.session.session import Session

PAUSE = 0.7
"""Seconds without a change after which the next one of the same choice is another switch: drawing a slider makes one."""
LONGEST_NAME = 60
FOLLOWED = PROBLEM_FIELDS | SOLVER_FIELDS
"""Fields of the session that a run takes up as it goes on."""


@dataclass(frozen=True)
class Switch:
    """Something was switched after `row` rows of the history; `iteration` and `seconds` are those of the last of them."""

    row: int
    iteration: int
    seconds: float
    sentence: str


class Switches:
    """Those since the last start, oldest first. Quick changes of one choice, and all those at rest, are one switch."""

    def __init__(self, document: Document, history: History) -> None:
        self._document = document
        self._history = history
        self._session = document.session
        self._before = document.session
        self._changed: set[str] = set()
        self._changed_at = 0.0
        self._found: list[Switch] = []
        document.session_changed.connect(self._take)

    def __iter__(self) -> Iterator[Switch]:
        return iter(self._found)

    def __len__(self) -> int:
        return len(self._found)

    def clear(self) -> None:
        """The history begins anew."""
        self._found.clear()
        self._session = self._document.session

    def go_back(self, switches: Iterable[Switch]) -> None:
        """Those of an earlier moment, with its choices."""
        self.clear()
        self._found.extend(switches)

    def _take(self) -> None:
        session = self._document.session
        changed = {name for name in FOLLOWED if getattr(session, name) != getattr(self._session, name)}
        if not changed:
            return
        before, self._session = self._session, session
        row, now = len(self._history), time.perf_counter()
        iterations = self._history.column("iteration")
        if not row or iterations[-1] == iterations[0]:
            return  # nothing has been stepped yet
        last = self._found[-1] if self._found else None
        is_quick = changed == self._changed and now - self._changed_at < PAUSE
        if last is not None and (last.row == row or is_quick):
            self._found.pop()
            switch = replace(last, sentence=switched(self._before, session))
        else:
            self._before = before
            seconds = float(self._history.column("seconds")[-1])
            switch = Switch(row, int(iterations[-1]), seconds, switched(before, session))
        self._changed, self._changed_at = changed, now
        if switch.sentence:
            self._found.append(switch)
        else:
            self._changed = set()  # the next change goes on with nothing


def switched(before: Session, after: Session) -> str:
    """What is another in the second session, in words; empty where nothing is that the solver follows."""
    parts = []
    if before.solver != after.solver:
        parts.append(_name_of_solver(after.solver))
    if before.distortion != after.distortion:
        parts.append(name_of_distortion(after.distortion))
    parts += _other_values(before.distortion_parameters, after.distortion_parameters, before.distortion == after.distortion)
    parts += _other_values(before.solver_parameters, after.solver_parameters, before.solver == after.solver)
    if before.fixed_boundary != after.fixed_boundary:
        parts.append("boundary fixed" if after.fixed_boundary else "boundary free")
    if before.linear_equations != after.linear_equations:
        parts.append(f"{len(after.linear_equations) or 'no'} linear equations")
    if before.allow_inversions != after.allow_inversions:
        parts.append("inversions allowed" if after.allow_inversions else "inversions forbidden")
    return ", ".join(parts)


def _other_values(before: Mapping[str, Any], after: Mapping[str, Any], is_same_method: bool) -> list[str]:
    """Parameters that have other values now; one that is back at its default is no longer named in the session."""
    parts = [f"{name} = {_number(value)}" for name, value in after.items() if not is_same_method or before.get(name) != value]
    if is_same_method:
        parts += [f"{name} back at its default" for name in before if name not in after]
    return parts


def _number(value: object) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _name_of_solver(id: str) -> str:
    from workbench.core.registry import registry

    solver = registry().solvers.get(id)
    return solver.label if solver is not None else id


def name_of_distortion(text: str) -> str:
    """The title of a registered distortion, or the beginning of a formula."""
    from workbench.core.registry import registry

    item = registry().distortions.get(text)
    name = text if item is None else title_of(item)
    return name if len(name) <= LONGEST_NAME else name[: LONGEST_NAME - 1] + "…"
