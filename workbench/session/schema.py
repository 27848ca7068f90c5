"""What may stand in a session file: each value is checked before anything is made of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from workbench.core.constraints import LARGEST_WEIGHT
from workbench.core.errors import WorkbenchError
from workbench.core.linear_equations import LONGEST_EQUATION, MOST_EQUATIONS, read_equations
from workbench.core.method import KINDS

LARGEST_COORDINATE = 1e70
LONGEST_TEXT = 20_000
LONGEST_PATH = 4096
MOST_ANCHORS = 250_000
MOST_PARAMETERS = 200
MOST_ITERATIONS = 10**9
SHOWN = 60
OFF = "off"
"""The last entry in the row of an anchor that is kept and holds nothing."""

Check = Callable[[str, Any], Any]
"""(what it is called, value) -> the value as a session has it. Raises `WorkbenchError`."""


def refuse(what: str, value: Any, wanted: str) -> WorkbenchError:
    """The error that says what is wrong with a value."""
    shown = repr(value) if isinstance(value, str | int | float | bool | None) else f"a {type(value).__name__}"
    shown = shown if len(shown) <= SHOWN else shown[:SHOWN] + "…"
    return WorkbenchError(f"{what} is {shown}; it has to be {wanted}.")


def text(what: str, value: Any, longest: int = LONGEST_TEXT) -> str:
    """A string without control characters, and without halves of characters, which nothing can draw."""
    if any(0xD800 <= ord(c) < 0xE000 for c in path(what, value, longest)):
        raise refuse(what, value, "text")
    return str(value)


def path(what: str, value: Any, longest: int = LONGEST_PATH) -> str:
    """The name of a file, or `sample:ID`; bytes of a name that are no text stand in it as halves of characters."""
    if not isinstance(value, str) or len(value) > longest or any(ord(c) < 32 for c in value):
        raise refuse(what, value, f"a line of at most {longest} characters")
    return value


def flag(what: str, value: Any) -> bool:
    """True or false, no number in their place."""
    if not isinstance(value, bool):
        raise refuse(what, value, "true or false")
    return value


def whole(what: str, value: Any, lowest: int = 0, highest: int = MOST_ITERATIONS) -> int:
    """An integer between two bounds."""
    if isinstance(value, bool) or not isinstance(value, int) or not lowest <= value <= highest:
        raise refuse(what, value, f"a whole number from {lowest} to {highest}")
    return value


def number(what: str, value: Any, lowest: float = -LARGEST_COORDINATE, highest: float = LARGEST_COORDINATE) -> float:
    """A finite number between two bounds."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not lowest <= value <= highest:
        raise refuse(what, value, f"a number from {lowest:g} to {highest:g}")
    return float(value)


def amount(what: str, value: Any) -> float:
    """A finite number that is not negative."""
    return number(what, value, 0.0)


def weight(what: str, value: Any) -> float:
    """Of a soft anchor, as files of anchors may have it."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0.0 < value <= LARGEST_WEIGHT:
        raise refuse(what, value, f"a positive number up to {LARGEST_WEIGHT:g}, or null for a hard anchor")
    return float(value)


def kind(what: str, value: Any) -> str:
    """A kind of map, or auto."""
    if not isinstance(value, str) or value not in ("auto", *KINDS):
        raise refuse(what, value, f"one of auto, {', '.join(KINDS)}")
    return value


def rows(what: str, value: Any, most: int) -> list[Any]:
    """A list that is not too long."""
    if not isinstance(value, list):
        raise refuse(what, value, "a list")
    if len(value) > most:
        raise WorkbenchError(f"{what} has {len(value)} entries; at most {most} are taken.")
    return value


def fixes(what: str, value: Any) -> tuple[str, ...]:
    """Names of fixes; those that there are not are refused where they are applied."""
    return tuple(text(what, name, SHOWN) for name in rows(what, value, 20))


def equations(what: str, value: Any) -> tuple[str, ...]:
    """Linear equations, a line each."""
    found = rows(what, value, MOST_EQUATIONS)
    return read_equations("\n".join(text(f"A line of {what}", line, LONGEST_EQUATION) for line in found))


def parameters(what: str, value: Any) -> dict[str, Any]:
    """Values by name: numbers, switches and words."""
    if not isinstance(value, dict) or len(value) > MOST_PARAMETERS:
        raise refuse(what, value, f"an object of at most {MOST_PARAMETERS} parameters")
    found: dict[str, Any] = {}
    for name, item in value.items():
        called = f"{what}.{name[:SHOWN]}"
        text(called, name, SHOWN)
        if isinstance(item, bool):
            found[name] = item
        elif isinstance(item, str):
            found[name] = text(called, item, SHOWN)
        elif isinstance(item, int):
            found[name] = whole(called, item, -(2**62), 2**62)
        else:
            found[name] = number(called, item)
    return found


def numbers_by_name(what: str, value: Any) -> dict[str, float]:
    """Parameters that are numbers."""
    return {name: number(f"{what}.{name}", item) for name, item in parameters(what, value).items()}


def digest(what: str, value: Any) -> str:
    """A sha256 in hexadecimal; empty where it is not known."""
    found = text(what, value, 64)
    if found and (len(found) != 64 or set(found) - set("0123456789abcdef")):
        raise refuse(what, value, "64 hexadecimal digits")
    return found


def anchors(what: str, value: Any) -> dict[str, Any]:
    """The fields of a session that `[vertex, [x, y], weight, group, "off"]` of every anchor make.

    The weight is null for a hard one, the group -1 for one that moves alone; what stands at the end may be left out.
    """
    vertices: list[int] = []
    targets: list[tuple[float, ...]] = []
    weights: list[float] = []
    groups: list[int] = []
    off: set[int] = set()
    for row in rows(what, value, MOST_ANCHORS):
        if not isinstance(row, list) or not 2 <= len(row) <= 5:
            raise refuse(f"A row of {what}", row, "[vertex, [x, y], weight, group]")
        vertices.append(whole(f"A vertex of {what}", row[0], 0, 2**62))
        target = rows(f"A target of {what}", row[1], 3)
        if len(target) < 2 or len(target) != len(targets[0] if targets else target):
            raise refuse(f"A target of {what}", target, "two coordinates each, or three each")
        targets.append(tuple(number(f"A target of {what}", c) for c in target))
        soft = row[2] if len(row) > 2 else None
        weights.append(math.inf if soft is None else weight(f"A weight of {what}", soft))
        groups.append(whole(f"A group of {what}", row[3], -1, 2**62) if len(row) > 3 else -1)
        if len(row) > 4:
            if row[4] != OFF:
                raise refuse(f"The last entry of a row of {what}", row[4], f"{OFF!r}, or not there")
            off.add(vertices[-1])
    if len(set(vertices)) != len(vertices):
        raise WorkbenchError(f"{what} names a vertex twice; one target a vertex is needed.")
    return {
        "anchor_vertices": tuple(vertices),
        "anchor_targets": tuple(targets),
        "anchor_weights": tuple(weights),
        "anchor_groups": tuple(groups),
        "anchors_off": frozenset(off),
    }


def one_of(choices: tuple[str, ...]) -> Check:
    """A text that is one of these."""

    def check(what: str, value: Any) -> str:
        if not isinstance(value, str) or value not in choices:
            raise refuse(what, value, f"one of {', '.join(choices)}")
        return value

    return check


def axes(what: str, value: Any) -> list[list[float]]:
    """Three directions of length 1, at right angles: to the right, upwards, towards the eye."""
    lines = [rows(what, line, 3) for line in rows(what, value, 3)]
    found = [[number(what, entry, -1.0, 1.0) for entry in line] for line in lines]
    if [len(line) for line in found] != [3, 3, 3] or np.abs(np.array(found) @ np.array(found).T - np.eye(3)).max() > 1e-4:
        raise refuse(what, value, "three axes of length 1, at right angles")
    return found


def only_known(found: Mapping[str, Any], known: set[str], what: str) -> None:
    """Raises `WorkbenchError` for the first entry that is not known."""
    unknown = next((name for name in found if name not in known), None)
    if unknown is not None:
        raise WorkbenchError(f"{what} has an entry {unknown[:SHOWN]!r}, which is not known.")


def checked_object(plain: Any, checks: Mapping[str, Check], what: str) -> dict[str, Any]:
    """Every entry of an object checked by name. Raises `WorkbenchError` for others."""
    if not isinstance(plain, dict):
        raise refuse(what, plain, "an object")
    only_known(plain, set(checks), what)
    return {name: checks[name](f"{what}: {name}", value) for name, value in plain.items()}


CHOICES: dict[str, Check] = {
    "kind": kind,
    "fixes": fixes,
    "distortion": text,
    "distortion_parameters": numbers_by_name,
    "solver": text,
    "solver_parameters": parameters,
    "initializer": text,
    "initializer_parameters": parameters,
    "start_file": path,
    "match_area": flag,
    "fixed_boundary": flag,
    "allow_inversions": flag,
    "linear_equations": equations,
    "carried": path,
    "iterations": whole,
    "tolerance": amount,
    "time_limit": amount,
}
"""Fields of a session that stand in a file by their own names; anchors and the source are written in other words."""
