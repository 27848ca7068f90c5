"""Who takes part in a race: solvers with their parameters, and maps from elsewhere."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from workbench.core.arrays import Floats
from workbench.core.errors import WorkbenchError
from workbench.core.registry import registry
from workbench.core.solver import Solver

SYNTAX = "[LABEL=]ID[:NAME=VALUE]..."
"""A solver in words, such as `aqp`, `aqp:accelerate=no` or `plain=aqp:accelerate=no:eta=50`."""


@dataclass(frozen=True, eq=False)
class Contestant:
    """One who takes part: a solver, or, where `solver` is None, the map (n, d) that something else has made."""

    label: str
    solver: Solver | None
    map: Floats | None = None

    @staticmethod
    def of(solver: str, values: Mapping[str, Any] | None = None, label: str = "") -> Contestant:
        """A registered solver with parameter values. Raises `WorkbenchError` for names and values that do not fit."""
        settings = dict(values or {})
        text = ":".join([solver, *(f"{name}={value}" for name, value in settings.items())])
        return Contestant(label or text, registry().solver(solver).configured(settings))


@dataclass(frozen=True)
class SolverChoice:
    """A solver in words, read but not made yet: `label`, id and parameter values as text."""

    label: str
    solver: str
    values: Mapping[str, str] = field(default_factory=dict)


def parse_choices(text: str) -> tuple[SolverChoice, ...]:
    """Solvers separated by commas, each as in `SYNTAX`.

    Raises `WorkbenchError` for words that are not of that form; ids and parameters are checked by who makes the solvers.
    """
    return tuple(_parse_choice(part.strip()) for part in text.split(",") if part.strip())


def _parse_choice(text: str) -> SolverChoice:
    head, *settings = text.split(":")
    label, equals, id = head.rpartition("=")
    values = {}
    for setting in settings:
        name, sign, value = (part.strip() for part in setting.partition("="))
        if not (sign and name and value):
            raise WorkbenchError(f"{text!r}: {setting!r} is not of the form NAME=VALUE; a solver is written {SYNTAX}.")
        values[name] = value
    if not id.strip() or (equals and not label.strip()):
        raise WorkbenchError(f"{text!r} names no solver; a solver is written {SYNTAX}.")
    return SolverChoice(label.strip() or text, id.strip(), values)


def check_labels(labels: Iterable[str]) -> None:
    """Raises `WorkbenchError` where two contestants have one label."""
    seen = set()
    for label in labels:
        if label in seen:
            raise WorkbenchError(f"Two contestants are called {label!r}; give each a label of its own, as in NAME={label}.")
        seen.add(label)


@dataclass(frozen=True)
class Preset:
    """A comparison worth seeing; `distortion` is the one that it needs, empty where any will do."""

    id: str
    label: str
    choices: tuple[SolverChoice, ...]
    distortion: str = ""

    def contestants(self) -> tuple[Contestant, ...]:
        """The contestants, made."""
        return tuple(Contestant.of(choice.solver, choice.values, choice.label) for choice in self.choices)


PRESETS: dict[str, Preset] = {
    preset.id: preset
    for preset in (
        Preset(
            "acceleration",
            "AQP with and without its extrapolation",
            (SolverChoice("AQP", "aqp"), SolverChoice("AQP without extrapolation", "aqp", {"accelerate": "no"})),
        ),
        Preset(
            "anderson",
            "Local/global with and without Anderson acceleration",
            (SolverChoice("Local/global", "local-global"), SolverChoice("Anderson acceleration", "anderson")),
            distortion="arap",
        ),
        Preset(
            "progressive",
            "Projected Newton with and without progressive references",
            (SolverChoice("Projected Newton", "projected-newton"), SolverChoice("Progressive references", "progressive")),
        ),
    )
}


def file_name(label: str) -> str:
    """A label as part of a file's name."""
    return re.sub(r"[^A-Za-z0-9.-]+", "-", label).strip("-.") or "contestant"
