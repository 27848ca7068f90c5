"""Contestants while they are being chosen, before the race."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from workbench.core.arrays import Floats
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.registry import Registry
from workbench.core.solver import Solver
from workbench.engine.race_messages import Entrant

FEWEST, MOST = 2, 6


@dataclass
class Draft:
    """A contestant to be: a solver with its values, or a map (n, d) and where it comes from."""

    label: str
    solver: str = ""
    parameters: dict[str, Any] = field(default_factory=dict)
    map: Floats | None = None
    origin: str = ""

    def entrant(self) -> Entrant:
        return Entrant(self.label, self.solver, dict(self.parameters), self.map)


def misfit(solver: type[Solver], kind: str, distortion: Distortion | None) -> str:
    """Why a solver cannot take part; empty where it can."""
    if kind not in solver.kinds:
        return f"{solver.label} does not solve {kind} maps."
    if distortion is not None:
        try:
            solver.check_distortion(distortion)
        except WorkbenchError as error:
            return error.sentence
    return ""


def free_label(label: str, taken: Iterable[str]) -> str:
    """The label, with a number where it is taken."""
    used, free, number = set(taken), label, 2
    while free in used:
        free, number = f"{label} ({number})", number + 1
    return free


def what_is_wrong(drafts: list[Draft], registry: Registry, kind: str, distortion: Distortion | None) -> str:
    """One sentence about what keeps these from racing; empty where nothing does."""
    if not FEWEST <= len(drafts) <= MOST:
        return f"A race has {FEWEST} to {MOST} contestants; there are {len(drafts)}."
    labels = [draft.label.strip() for draft in drafts]
    if not all(labels):
        return "Every contestant needs a name."
    twice = next((label for label in labels if labels.count(label) > 1), "")
    if twice:
        return f"Two contestants are called {twice!r}; give each a name of its own."
    reasons = (misfit(registry.solvers[draft.solver], kind, distortion) for draft in drafts if draft.solver)
    return next(filter(None, reasons), "")
