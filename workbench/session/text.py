"""A session as JSON: only what differs from the defaults is written, and nothing but what is known is read."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, get_args

from workbench.core.arrays import Floats
from workbench.core.errors import WorkbenchError
from workbench.core.linear_equations import AXES
from workbench.session import schema, view_schema
from workbench.session.journal import LONGEST, Leg, Origin
from workbench.session.record import SessionRecord
from workbench.session.schema import only_known
from workbench.session.session import ANCHORS, Session

FORMAT = "distortion-workbench session"
VERSION = 1
LEG_CHOICES = (
    "distortion", "distortion_parameters", "solver", "solver_parameters", "fixed_boundary", "allow_inversions",
    "linear_equations", "tolerance",
)  # fmt: skip
"""Choices in which a leg may differ from the session that it belongs to; its anchors may, too."""
MOST_PARTS = 4 * schema.MOST_ANCHORS
"""Lists and objects in a text: each costs time in which nothing else in the process goes on."""
MAP = "map"
"""Name of the array of the map; legs that begin at a map have `leg-0`, `leg-1` and so on."""


def plain_of(record: SessionRecord) -> tuple[dict[str, Any], dict[str, Floats]]:
    """The JSON object, and the arrays by name that belong beside it. Raises `WorkbenchError` for too many anchors."""
    session = record.session
    if len(session.anchor_vertices) > schema.MOST_ANCHORS:
        raise WorkbenchError(
            f"A session file takes {schema.MOST_ANCHORS} anchors, and there are {len(session.anchor_vertices)}; "
            "save the map as a case (.npz) instead."
        )
    arrays: dict[str, Floats] = {}
    source = {"path": session.source} | ({"sha256": record.sha256} if record.sha256 else {})
    plain: dict[str, Any] = {"format": FORMAT, "version": VERSION, "source": source}
    plain |= differing(session, Session(), tuple(schema.CHOICES))
    if session.anchor_vertices:
        plain["anchors"] = anchor_rows(session)
    if record.energy is not None and math.isfinite(record.energy):
        plain["energy"] = record.energy
    if record.legs:
        plain["legs"] = [_leg_object(leg, session, index, arrays) for index, leg in enumerate(record.legs)]
    if record.views is not None:
        plain["views"] = dict(record.views)
    if record.map is not None:
        arrays[MAP] = record.map
    return plain, arrays


def differing(chosen: Any, base: Any, names: tuple[str, ...]) -> dict[str, Any]:
    """Those of the fields `names` of an object in which it differs from another, as JSON has them."""
    values = {name: getattr(chosen, name) for name in names}
    return {name: _plain(value) for name, value in values.items() if value != getattr(base, name)}


def _plain(value: Any) -> Any:
    if isinstance(value, tuple):
        return list(value)
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return dict(value) if isinstance(value, Mapping) else value


def anchor_rows(session: Session) -> list[list[Any]]:
    """The anchors of a session as rows `[vertex, target, weight, group, "off"]`; what says nothing is left out."""
    count = len(session.anchor_vertices)
    weights = session.anchor_weights or (math.inf,) * count
    groups = session.anchor_groups or (-1,) * count
    rows: list[list[Any]] = []
    for vertex, target, weight, group in zip(session.anchor_vertices, session.anchor_targets, weights, groups, strict=True):
        row = [vertex, list(target), None if math.isinf(weight) else weight, group]
        if vertex in session.anchors_off:
            row.append(schema.OFF)
        rows.append(row if group >= 0 or row[-1] == schema.OFF else row[:3] if row[2] is not None else row[:2])
    return rows


def anchors_agree(one: Session, other: Session) -> bool:
    """Whether the same anchors are in force."""
    first, second = one.in_force, other.in_force
    return all(getattr(first, name) == getattr(second, name) for name in ANCHORS)


def _leg_object(leg: Leg, session: Session, index: int, arrays: dict[str, Floats]) -> dict[str, Any]:
    plain: dict[str, Any] = {"from": leg.origin, "iterations": leg.iterations}
    plain |= differing(leg.choices, session, LEG_CHOICES)
    choices = leg.choices.in_force
    if not anchors_agree(choices, session):
        plain["anchors"] = anchor_rows(choices)
    if leg.positions is not None and leg.origin != "previous":
        arrays[f"leg-{index}"] = leg.positions
    return plain


# ---------------------------------------------------------------------------------------------- reading


def parsed(text: str, format: str = FORMAT, newest: int = VERSION, noun: str = "session") -> dict[str, Any]:
    """The JSON object of a text that says it is of this format; `WorkbenchError` for anything else."""
    if part_count(text) > MOST_PARTS:
        raise WorkbenchError(f"It has more lists and objects than a {noun} may have ({MOST_PARTS}).")
    try:
        found = json.loads(text, parse_constant=_no_constant, object_pairs_hook=_no_twins)
    except RecursionError:
        raise WorkbenchError(f"It is nested too deep to be a {noun}.") from None
    except json.JSONDecodeError as error:
        raise WorkbenchError(f"It is no JSON (line {error.lineno}: {error.msg}).") from None
    except ValueError:
        raise WorkbenchError("It has a number with too many digits.") from None
    if not isinstance(found, dict) or found.get("format") != format:
        raise WorkbenchError(f"It is no {noun}: a {noun} says 'format': {format!r}.")
    version = found.get("version")
    if isinstance(version, bool) or not isinstance(version, int) or version < 1:
        raise schema.refuse("version", version, "a whole number from 1 on")
    if version > newest:
        raise WorkbenchError(f"It was written by a newer program (version {version}, known is {newest}); update this one.")
    return found


def part_count(text: str) -> int:
    """Lists and objects in a JSON text, about: brackets in other text count, those of coordinates in equations do not."""
    return text.count("[") + text.count("{") - sum(text.count(f"{axis}[") for axis in AXES)


def _no_constant(name: str) -> Any:
    raise WorkbenchError(f"It has the number {name}; all numbers have to be finite.")


def _no_twins(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) != len(pairs):
        raise WorkbenchError("It names one thing twice.")
    return found


def record_of(plain: Mapping[str, Any], arrays: Mapping[str, Floats]) -> SessionRecord:
    """The session that a parsed object and the arrays beside it stand for. Raises `WorkbenchError` naming what is wrong."""
    known = {"format", "version", "source", "anchors", "energy", "legs", "views", *schema.CHOICES}
    only_known(plain, known, "The session")
    source, sha256 = _source(plain.get("source"))
    choices = {name: check(name, plain[name]) for name, check in schema.CHOICES.items() if name in plain}
    session = Session(source=source, **choices, **_anchors(plain))
    energy = schema.number("energy", plain["energy"], -1e300, 1e300) if "energy" in plain else None
    objects = schema.rows("legs", plain.get("legs", []), LONGEST)
    legs = tuple(_leg_of(item, session, index, arrays) for index, item in enumerate(objects))
    found = arrays.get(MAP)
    used = {MAP, *(f"leg-{index}" for index in range(len(legs)))}
    only_known(arrays, used, "The file")
    if any(a.shape[1] != b.shape[1] or len(a) != len(b) for a in arrays.values() for b in arrays.values()):
        raise WorkbenchError("Its maps are not all of one mesh.")
    shown = view_schema.views("views", plain["views"]) if "views" in plain else None
    return SessionRecord(session, sha256, found, legs, energy, shown)


def _source(value: Any) -> tuple[str, str]:
    if not isinstance(value, dict):
        raise schema.refuse("source", value, "an object with path and sha256")
    only_known(value, {"path", "sha256"}, "The source")
    return schema.path("source.path", value.get("path")), schema.digest("source.sha256", value.get("sha256", ""))


def _anchors(plain: Mapping[str, Any]) -> dict[str, Any]:
    return schema.anchors("anchors", plain["anchors"]) if "anchors" in plain else {}


def _leg_of(plain: Any, session: Session, index: int, arrays: Mapping[str, Floats]) -> Leg:
    what = f"Leg {index}"
    if not isinstance(plain, dict):
        raise schema.refuse(what, plain, "an object")
    only_known(plain, {"from", "iterations", "anchors", *LEG_CHOICES}, what)
    origin = plain.get("from")
    if not isinstance(origin, str) or origin not in get_args(Origin) or (origin == "previous") is (index == 0):
        raise schema.refuse(f"{what}: from", origin, "start or map for the first leg, previous for the others")
    positions = arrays.get(f"leg-{index}")
    if origin == "map" and positions is None:
        raise WorkbenchError(f"{what} begins at a map, and the file does not have it.")
    if origin == "previous" and positions is not None:
        raise WorkbenchError(f"{what} goes on from the one before, and the file has a map for it.")
    changes = {name: schema.CHOICES[name](f"{what}: {name}", plain[name]) for name in LEG_CHOICES if name in plain}
    choices = replace(session.in_force, **changes, **_anchors(plain)).in_force
    return Leg(choices, origin, positions, schema.whole(f"{what}: iterations", plain.get("iterations")))  # type: ignore[arg-type]


# ---------------------------------------------------------------------------------------------- writing


def readable(value: Any, indent: str = "") -> str:
    """JSON for people: an entry a line, except in what is flat or holds numbers."""
    deeper = indent + "  "
    if isinstance(value, dict) and value and not _is_short(value):
        lines = [f"{deeper}{json.dumps(name)}: {readable(item, deeper)}" for name, item in value.items()]
        return "{\n" + ",\n".join(lines) + f"\n{indent}}}"
    if isinstance(value, list) and value and not _is_short(value):
        return "[\n" + ",\n".join(deeper + readable(item, deeper) for item in value) + f"\n{indent}]"
    return json.dumps(value, allow_nan=False, ensure_ascii=False)


def _is_short(value: Any) -> bool:
    """Whether it stands on one line: a row of numbers, or a few entries that hold nothing else."""
    if isinstance(value, dict):
        return len(value) <= 3 and not any(isinstance(item, dict | list) for item in value.values())
    return (
        len(value) <= 5
        and all(not isinstance(x, dict) and (not isinstance(x, list) or _is_short(x)) for x in value)
        and (not value or not isinstance(value[0], list))
    )
