"""How a panel looks into a solid, as JSON: every value within bounds."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import Any

from workbench.core.solid_look.look import Direction, VolumeLook
from workbench.figures.recipe import SolidLook
from workbench.session import schema
from workbench.session.text import differing, only_known

MOST_MARKED = 5_000_000
FURTHEST = 100.0
"""Spread of tetrahedra, at the most."""


def plain_look(look: SolidLook) -> dict[str, Any]:
    """The JSON object of a look: what differs from a whole solid."""
    shape = differing(look.shape, VolumeLook(), tuple(SHAPE))
    return shape | differing(look, SolidLook(), tuple(OWN))


def look_of(what: str, plain: Any) -> SolidLook:
    """The look that a JSON object stands for. Raises `WorkbenchError` naming what is wrong."""
    if not isinstance(plain, Mapping):
        raise schema.refuse(what, plain, "an object")
    only_known(plain, {*SHAPE, *OWN}, what)

    def found(checks: Mapping[str, schema.Check]) -> dict[str, Any]:
        return {name: check(f"{what}.{name}", plain[name]) for name, check in checks.items() if name in plain}

    return SolidLook(VolumeLook(**found(SHAPE)), **found(OWN))


def _within(lowest: float, highest: float) -> schema.Check:
    return lambda what, value: schema.number(what, value, lowest, highest)


def _threshold(what: str, value: Any) -> float | None:
    return None if value is None else schema.number(what, value)


def _normal(what: str, value: Any) -> Direction:
    x, y, z = ([schema.number(what, entry, -1.0, 1.0) for entry in schema.rows(what, value, 3)] + [2.0] * 3)[:3]
    if abs(x * x + y * y + z * z - 1.0) > 1e-4:
        raise schema.refuse(what, value, "three numbers, a direction of length 1")
    return x, y, z


def _marked(what: str, value: Any) -> tuple[int, ...]:
    return tuple(schema.whole(what, number) for number in schema.rows(what, value, MOST_MARKED))


SHAPE: dict[str, schema.Check] = {
    "is_cut": schema.flag,
    "normal": _normal,
    "place": _within(0.0, 1.0),
    "is_flipped": schema.flag,
    "is_exact": schema.flag,
    "cuts_target": schema.flag,
    "threshold": _threshold,
    "only_marked": schema.flag,
    "spread": _within(0.0, FURTHEST),
    "ghost": _within(0.0, 1.0),
    "is_wired": schema.flag,
}
OWN: dict[str, schema.Check] = {"peel_by": schema.text, "parameters": schema.numbers_by_name, "marked": _marked}
assert set(SHAPE) == {field.name for field in fields(VolumeLook)}
assert {"shape", *OWN} == {field.name for field in fields(SolidLook)}
