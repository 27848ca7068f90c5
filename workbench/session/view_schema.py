"""The views of a window as a session file has them: how they are arranged, what each shows and from where it is looked at.

Everything is optional, and nothing of it changes a map.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import Any

from workbench.core.errors import WorkbenchError
from workbench.session import schema

MOST_VIEWS = 24
DEEPEST = 8
LARGEST_SIZE = 100_000
MOST_RANGES = 500
SPLITS = ("right", "below")
SIDES = ("source", "target", "carried")
PANE = re.compile(r"pane-[1-9][0-9]?")

Tree = dict[str, Any]


def views(what: str, value: Any) -> dict[str, Any]:
    """The object as it is where every part of it is known and within bounds. Raises `WorkbenchError` naming what is not."""
    found = schema.checked_object(value, VIEWS, what)
    panes = found.get("panes", {})
    names = [name for tree in found.get("layout", {}).values() for name in leaves(tree)]
    if len(set(names)) < len(names):
        raise WorkbenchError(f"{what} puts one view into two places.")
    for name in names:
        if PANE.fullmatch(name) and "side" not in panes.get(name, {}):
            raise WorkbenchError(f"{what} has a view {name!r} that shows neither source nor target.")
    return found


def leaves(tree: Tree) -> Iterator[str]:
    """Names of the views in a layout."""
    for part in tree["parts"]:
        yield from [part] if isinstance(part, str) else leaves(part)


def _name(what: str, value: Any) -> str:
    return schema.text(what, value, schema.SHOWN)


def _named(what: str, value: Any, most: int, check: schema.Check) -> dict[str, Any]:
    """An object of values of one kind by name."""
    if not isinstance(value, dict) or len(value) > most:
        raise schema.refuse(what, value, f"an object of at most {most} entries")
    return {schema.text(what, name, 500): check(f"{what}.{name[: schema.SHOWN]}", item) for name, item in value.items()}


def _layout(what: str, value: Any) -> dict[str, Tree]:
    return _named(what, value, MOST_VIEWS, lambda name, tree: _tree(name, tree, DEEPEST))


def _tree(what: str, value: Any, depth: int) -> Tree:
    if depth == 0:
        raise WorkbenchError(f"{what} is split into itself too often.")

    def part(called: str, item: Any) -> Any:
        return _name(called, item) if isinstance(item, str) else _tree(called, item, depth - 1)

    checks: Mapping[str, schema.Check] = {
        "split": schema.one_of(SPLITS),
        "sizes": lambda name, sizes: [schema.whole(name, s, 0, LARGEST_SIZE) for s in schema.rows(name, sizes, MOST_VIEWS)],
        "parts": lambda name, parts: [part(name, p) for p in schema.rows(name, parts, MOST_VIEWS)],
    }
    found = schema.checked_object(value, checks, what)
    if set(found) != set(checks) or not found["parts"] or len(found["sizes"]) != len(found["parts"]):
        raise schema.refuse(what, value, "split, parts and as many sizes")
    return found


def _shows(what: str, value: Any) -> Any:
    """A pattern or a quantity by its id, or a formula with its parameters."""
    if isinstance(value, str):
        return schema.text(what, value)
    return schema.checked_object(value, {"formula": schema.text, "parameters": schema.numbers_by_name}, what)


def _edges(what: str, value: Any) -> bool | None:
    return None if value is None else schema.flag(what, value)


def _positive(what: str, value: Any) -> float:
    return schema.number(what, value, 1e-300)


def _focal(what: str, value: Any) -> list[float]:
    found = [schema.number(what, part) for part in schema.rows(what, value, 3)]
    if len(found) < 2:
        raise schema.refuse(what, value, "two coordinates, or three")
    return found


def _camera(what: str, value: Any) -> dict[str, Any]:
    found = schema.checked_object(value, {"focal": _focal, "half_height": _positive, "axes": schema.axes}, what)
    if "axes" not in found or ("focal" in found) is not ("half_height" in found):
        raise schema.refuse(what, value, "axes, and focal with half_height or neither")
    return found


def _draws(what: str, value: Any) -> dict[str, Any]:
    return schema.checked_object(value, DRAWS, what)


def _range(what: str, value: Any) -> dict[str, Any]:
    found = schema.checked_object(value, RANGE, what)
    if ("low" in found) is not ("high" in found):
        raise schema.refuse(what, value, "both ends of a range, or none")
    return found


def _ranges(what: str, value: Any) -> dict[str, Any]:
    return _named(what, value, MOST_RANGES, _range)


def _pane(what: str, value: Any) -> dict[str, Any]:
    return schema.checked_object(value, PANE_CHECKS, what)


def _panes(what: str, value: Any) -> dict[str, Any]:
    return _named(what, value, MOST_VIEWS, _pane)


def _pattern(what: str, value: Any) -> dict[str, Any]:
    return schema.checked_object(value, PATTERN, what)


def _glyphs(what: str, value: Any) -> dict[str, Any]:
    return schema.checked_object(value, GLYPHS, what)


def _solid(what: str, value: Any) -> dict[str, Any]:
    return schema.checked_object(value, SOLID, what)


def _normal(what: str, value: Any) -> list[float]:
    found = [schema.number(what, part, -1.0, 1.0) for part in schema.rows(what, value, 3)]
    if len(found) != 3 or not any(found):
        raise schema.refuse(what, value, "three numbers, not all of them 0")
    return found


def _part(what: str, value: Any) -> float:
    return schema.number(what, value, 0.0, 1.0)


def _factor(what: str, value: Any) -> float:
    return schema.number(what, value, 0.01, 100.0)


DRAWS: Mapping[str, schema.Check] = {
    "edges": _edges,
    "wireframe": schema.flag,
    "seams": schema.flag,
    "boundary": schema.flag,
    "scale_bar": schema.flag,
}
RANGE: Mapping[str, schema.Check] = {
    "low": schema.number,
    "high": schema.number,
    "logarithmic": schema.flag,
    "reversed": schema.flag,
    "whole": schema.flag,
    "clipped": schema.flag,
}
PANE_CHECKS: Mapping[str, schema.Check] = {
    "side": schema.one_of(SIDES),
    "shows": _shows,
    "camera": _camera,
    "linked": schema.flag,
    "closed": schema.flag,
    "draws": _draws,
    "range": _range,
}
PATTERN: Mapping[str, schema.Check] = {
    "size": _factor,
    "degrees": lambda what, value: schema.number(what, value, -360.0, 360.0),
    "of_source": schema.flag,
    "of_unit": schema.flag,
    "picture": schema.path,
}
GLYPHS: Mapping[str, schema.Check] = {
    "kind": schema.one_of(("none", "stretches", "ellipses")),
    "number": _factor,
    "size": _factor,
    "places": lambda what, value: [schema.one_of(SIDES[:2])(what, place) for place in schema.rows(what, value, 2)],
}
SOLID: Mapping[str, schema.Check] = {
    "cut": schema.flag,
    "normal": _normal,
    "place": _part,
    "flipped": schema.flag,
    "section": schema.flag,
    "plane": schema.one_of(SIDES[:2]),
    "veil": _part,
    "wires": schema.flag,
    "peel_by": schema.text,
    "peeled": _part,
    "threshold": schema.number,
    "spread": lambda what, value: schema.number(what, value, 0.0, 10.0),
}
VIEWS: Mapping[str, schema.Check] = {
    "layout": _layout,
    "panes": _panes,
    "ranges": _ranges,
    "draws": _draws,
    "readings": schema.flag,
    "pattern": _pattern,
    "glyphs": _glyphs,
    "solid": _solid,
}
