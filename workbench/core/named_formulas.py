"""Formulas that the user has given a name: kept as plain data, checked when read, never executed."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import platformdirs

from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.formula import FUNCTIONS, compile_formula
from workbench.core.method import KINDS, Parameter

SCHEMA = 1
LARGEST_FILE = 2_000_000
MOST_FORMULAS = 500
MOST_PARAMETERS = 16
LONGEST_NAME = 60
LONGEST_NOTE = 2000
ORIGIN = "Own formula"

_ID = re.compile(r"[a-z][a-z0-9]*(-[a-z0-9]+)*")
_RESERVED = re.compile(r"sigma(\d*|n)|n|det|" + "|".join(FUNCTIONS))
_TYPES: Mapping[str, type] = {"float": float, "int": int}


@dataclass(frozen=True)
class NamedFormula:
    """A formula with its name, its parameters (defaults and ranges) and a note.

    `id` follows from the name: small letters, digits, hyphens; inside other formulas with underscores.
    """

    name: str
    formula: str
    parameters: tuple[Parameter, ...] = ()
    note: str = ""

    @property
    def id(self) -> str:
        return id_of_name(self.name)

    def to_distortion(self) -> Distortion:
        return Distortion(
            id=self.id,
            label=self.name,
            formula=self.formula,
            parameters=self.parameters,
            citation=ORIGIN,
            description=self.note,
            kinds=KINDS,
        )


def formulas_file() -> Path:
    """Where the user's own formulas are kept, beside the folder of the user's plugins."""
    return platformdirs.user_data_path("distortion-workbench", appauthor=False) / "formulas.json"


def id_of_name(name: str) -> str:
    """The id that belongs to a name. Raises `WorkbenchError` where the name gives none, or a word of the language."""
    plain = " ".join(name.split())
    if not plain or len(plain) > LONGEST_NAME:
        raise WorkbenchError(f"A name has 1 to {LONGEST_NAME} characters; {name[:LONGEST_NAME]!r} does not do.")
    if plain != name or not plain.isprintable():
        raise WorkbenchError(f"The name {plain[:LONGEST_NAME]!r} has line breaks, double or outer blanks; leave them out.")
    id = re.sub(r"[^a-z0-9]+", "-", plain.lower()).strip("-")
    if not _ID.fullmatch(id):
        raise WorkbenchError(f"The name {plain!r} must begin with a letter from a to z, so that formulas can use it.")
    if _RESERVED.fullmatch(id.replace("-", "_")):
        raise WorkbenchError(f"The name {plain!r} is a word of the formula language; choose another.")
    return id


def check_formula(item: NamedFormula, known: Mapping[str, Distortion]) -> None:
    """Raises `WorkbenchError` unless the formula can be used in both dimensions beside the distortions `known`."""
    if item.id in known:
        raise WorkbenchError(f"{item.name!r} would hide the distortion {item.id}; choose another name.")
    try:
        _formula_of_entry(_entry_of(item))  # what could not be read again is not kept
    except WorkbenchError as error:
        raise WorkbenchError(f"The formula {item.name!r} cannot be kept: {error.sentence}") from None
    names = [p.name for p in item.parameters]
    if len(set(names)) < len(names):
        raise WorkbenchError(f"{item.name!r} declares a parameter twice.")
    for name in names:
        if _RESERVED.fullmatch(name):
            raise WorkbenchError(f"{item.name!r} declares {name} as a parameter, a word of the formula language.")
    values = {p.name: float(p.check(p.default)) for p in item.parameters}
    others = {id.replace("-", "_"): other for id, other in known.items()}

    def text_of(name: str) -> tuple[str, Mapping[str, float]] | None:
        other = others.get(name)
        return None if other is None else (other.formula, other.parameter_values)

    for dimension in (2, 3):
        compile_formula(item.formula, dimension, values, text_of)


# ------------------------------------------------------------------------------------------------- the file


def read_formulas(path: Path) -> tuple[list[NamedFormula], list[str]]:
    """The formulas of a file, and a sentence for each part that is none. A file that is not there holds none."""
    try:
        if not path.exists():
            return [], []
        if path.stat().st_size > LARGEST_FILE:
            return [], [f"{path} is larger than any list of formulas; move it away."]
        content = json.loads(path.read_bytes().decode("utf-8"), parse_constant=_no_constant)
    except OSError as error:
        return [], [f"{path} cannot be read: {error.strerror or error}."]
    except (ValueError, RecursionError) as error:
        return [], [f"{path} is damaged ({type(error).__name__}): the formulas in it are left out; mend it or move it."]
    if not isinstance(content, dict) or content.get("schema") != SCHEMA or not isinstance(content.get("formulas"), list):
        return [], [f"{path} is not a list of formulas of this program; mend it or move it away."]
    good: list[NamedFormula] = []
    faults: list[str] = []
    for number, entry in enumerate(content["formulas"], 1):
        if number > MOST_FORMULAS:
            faults.append(f"{path} holds more than {MOST_FORMULAS} formulas; those after them are left out.")
            break
        try:
            item = _formula_of_entry(entry)
            if item.id in {other.id for other in good}:
                raise WorkbenchError(f"there are two of the id {item.id}.")
            good.append(item)
        except WorkbenchError as error:
            faults.append(f"{path}, formula {number}: {error.sentence}")
    return good, faults


def add_formulas(items: Iterable[NamedFormula], known: dict[str, Distortion]) -> list[str]:
    """Add to `known` what can be used, whatever the order in which formulas refer to each other; sentences for the rest."""
    waiting = list(items)
    faults: dict[str, str] = {}
    while waiting:
        left = []
        for item in waiting:
            try:
                check_formula(item, known)
                known[item.id] = item.to_distortion()
            except WorkbenchError as error:
                faults[item.id] = f"The formula {item.name!r} is left out: {error.sentence}"
                left.append(item)
        if len(left) == len(waiting):
            break
        waiting = left
    return [faults[item.id] for item in waiting]


def text_of_formulas(items: Iterable[NamedFormula]) -> str:
    """The file's content."""
    content = {"schema": SCHEMA, "formulas": [_entry_of(item) for item in items]}
    return json.dumps(content, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _entry_of(item: NamedFormula) -> dict[str, Any]:
    keys = ("name", "default", "minimum", "maximum", "description")
    parameters = [{"type": p.type.__name__, **{key: getattr(p, key) for key in keys}} for p in item.parameters]
    return {"name": item.name, "formula": item.formula, "note": item.note, "parameters": parameters}


def _no_constant(word: str) -> None:
    raise ValueError(f"{word} is not a number")


def _formula_of_entry(entry: Any) -> NamedFormula:
    fields = _fields(entry, {"name", "formula"}, {"note", "parameters"})
    parameters = fields.get("parameters", [])
    if not isinstance(parameters, list) or len(parameters) > MOST_PARAMETERS:
        raise WorkbenchError(f"its parameters are not a list of at most {MOST_PARAMETERS}.")
    item = NamedFormula(
        name=_text(fields, "name", LONGEST_NAME),
        formula=_text(fields, "formula", 10 * LONGEST_NOTE),
        parameters=tuple(_parameter_of_entry(p) for p in parameters),
        note=_text(fields, "note", LONGEST_NOTE) if "note" in fields else "",
    )
    id_of_name(item.name)
    return item


def _parameter_of_entry(entry: Any) -> Parameter:
    fields = _fields(entry, {"name", "default"}, {"type", "minimum", "maximum", "description"})
    name = _text(fields, "name", 31)
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name):
        raise WorkbenchError(f"{name!r} cannot be the name of a parameter.")
    kind = _TYPES.get(str(fields.get("type", "float")))
    if kind is None:
        raise WorkbenchError(f"the type of its parameter {name} is neither float nor int.")
    description = _text(fields, "description", LONGEST_NOTE) if "description" in fields else ""
    low, high = (_number(fields.get(key), f"{key} of {name}") for key in ("minimum", "maximum"))
    default = _number(fields["default"], f"default of {name}")
    if default is None:
        raise WorkbenchError(f"its parameter {name} has no default.")
    if low is not None and high is not None and not low < high:
        raise WorkbenchError(f"the range of its parameter {name} is empty.")
    if kind is int and default != round(default):
        raise WorkbenchError(f"the default of its parameter {name} is not a whole number.")
    item = Parameter(name, kind, kind(default), description, low, high)
    item.check(item.default)
    return item


def _fields(entry: Any, needed: set[str], allowed: set[str]) -> dict[str, Any]:
    if not isinstance(entry, dict):
        raise WorkbenchError("an entry is not an object.")
    missing, foreign = needed - entry.keys(), entry.keys() - needed - allowed
    if missing or foreign:
        what = f"{sorted(missing)[0]!r} is missing" if missing else f"{sorted(foreign)[0][:40]!r} is not a field"
        raise WorkbenchError(f"{what}.")
    return entry


def _text(fields: Mapping[str, Any], key: str, longest: int) -> str:
    value = fields[key]
    if not isinstance(value, str) or len(value) > longest:
        raise WorkbenchError(f"its {key} is not a text of at most {longest} characters.")
    return value


def _number(value: Any, what: str) -> float | None:
    if value is None:
        return None
    try:
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            raise ValueError
        return float(value)
    except (ValueError, OverflowError):
        raise WorkbenchError(f"the {what} is not a finite number.") from None
