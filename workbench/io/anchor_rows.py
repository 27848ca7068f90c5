"""Anchors as rows of words: from files and from spreadsheets, each cell checked, and back."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from workbench.core.arrays import Booleans, Floats, Integers, frozen
from workbench.core.constraints import LARGEST_WEIGHT
from workbench.core.errors import WorkbenchError
from workbench.io.mesh_file import LARGEST_COORDINATE

LARGEST_GROUP = 2**62
AXES = ("x", "y", "z")
MORE = ("weight", "group", "on")
"""Columns that may follow vertex and target, in this order where there is no header."""
SHOWN_ONLY = ("source_x", "source_y", "source_z", "residual")
"""Columns that are copied for the reader, and not read."""
HARD = ("", "hard", "inf")
ON, OFF = ("", "on", "yes", "true", "1"), ("off", "no", "false", "0")

Place = Callable[[int, str], str]
"""(number of a line from 1, column or empty) -> where that is, in words"""
Rows = list[tuple[int, list[str]]]
"""Number of the line from 1, and its cells"""


@dataclass(frozen=True, eq=False)
class AnchorTable:
    """Anchors as a file or a spreadsheet has them.

    Parameters
    ----------
    vertices : (k,) int64
    targets : (k, d) float64
    weights : (k,) float64      inf is hard (where there are no weights), finite is a penalty
    groups : (k,) int64         -1 (where there are none) for those that move alone
    is_off : (k,) bool          which are kept and hold nothing
    """

    vertices: Integers
    targets: Floats
    weights: Floats = None  # type: ignore[assignment]
    groups: Integers = None  # type: ignore[assignment]
    is_off: Booleans = None  # type: ignore[assignment]

    def __post_init__(self) -> None:
        count = len(self.vertices)
        object.__setattr__(self, "vertices", frozen(self.vertices, np.int64))
        object.__setattr__(self, "targets", frozen(self.targets))
        object.__setattr__(self, "weights", frozen(np.full(count, np.inf) if self.weights is None else self.weights))
        object.__setattr__(self, "groups", frozen(np.full(count, -1) if self.groups is None else self.groups, np.int64))
        object.__setattr__(self, "is_off", frozen(np.zeros(count, bool) if self.is_off is None else self.is_off, bool))

    @property
    def in_force(self) -> AnchorTable:
        """Those that are on."""
        on = ~self.is_off
        return AnchorTable(self.vertices[on], self.targets[on], self.weights[on], self.groups[on])


# ---------------------------------------------------------------------------------------------- reading


def rows_of(text: str) -> tuple[Rows, bool]:
    """The cells of every line that has any, and whether numbers have a decimal comma.

    Cells are parted by tabs where there is one, else by semicolons, else by commas. Raises `WorkbenchError` where decimal
    points and commas are mixed, since one of them would then be read for what it is not, and where a quoted cell has no end.
    """
    separator = "\t" if "\t" in text else ";" if ";" in text else ","
    lines = text.splitlines()
    if '"' in text:
        found = [(n, row) for n, line in enumerate(lines, 1) if line.strip() for row in _quoted_cells(line, n, separator)]
    else:
        found = [(n, line.split(separator)) for n, line in enumerate(lines, 1) if line.strip()]
    has_commas = separator != "," and any("," in cell for _, row in found for cell in row)
    if has_commas and any("." in cell and _is_numeral(cell) for _, row in found for cell in row):
        raise WorkbenchError("Some numbers have a decimal point and some a comma; write all of them in one way.")
    return found, has_commas


def _quoted_cells(line: str, number: int, separator: str) -> list[list[str]]:
    try:
        return list(csv.reader([line], delimiter=separator))
    except csv.Error as error:
        raise WorkbenchError(f"Line {number} cannot be read: {error}; mend its quotation marks.") from None


def _is_numeral(cell: str) -> bool:
    return cell.strip().lstrip("+-")[:1].isdigit()


def parse_rows(
    rows: Rows, names: Sequence[str], vertex_count: int, dimension: int, place: Place, *, decimal_comma: bool = False
) -> AnchorTable:
    """The anchors in rows whose columns are `names`: vertex, x, y (z), and what there is of `MORE` and `SHOWN_ONLY`.

    Raises `WorkbenchError` that names the place of what is wrong: a cell that is missing, a vertex that there is not or
    that comes twice, a number that is none or out of range.
    """
    for line, row in rows:
        if len(row) != len(names):
            wanted = f"{len(names)} are needed: {', '.join(names)}"
            raise WorkbenchError(f"{place(line, '')}: it has {len(row)} fields, and {wanted}.")
    lines = [line for line, _ in rows]
    cells = {name: [row[k].strip() for _, row in rows] for k, name in enumerate(names)}

    def column(name: str, convert: Callable[[str], float]) -> list[float]:
        found = []
        for line, cell in zip(lines, cells[name], strict=True):
            try:
                found.append(convert(cell.replace(",", ".") if decimal_comma else cell))
            except WorkbenchError as error:
                raise WorkbenchError(f"{place(line, name)}: {error.sentence}") from None
        return found

    vertices = _ordinary_vertices(cells["vertex"], vertex_count)
    if vertices is None:
        vertices = [int(vertex) for vertex in column("vertex", lambda cell: vertex_of(cell, vertex_count))]
    _refuse_twins(vertices, lines, place)
    count = len(rows)
    ordinary = [_ordinary(cells[axis], decimal_comma) for axis in AXES[:dimension]]
    targets = np.array([
        column(axis, coordinate_of) if values is None else values
        for axis, values in zip(AXES, ordinary, strict=False)
    ]).reshape(dimension, count).T  # fmt: skip
    return AnchorTable(
        np.array(vertices, dtype=np.int64),
        targets,
        np.array(column("weight", weight_of)) if "weight" in cells else None,  # type: ignore[arg-type]
        np.array(column("group", group_of), dtype=np.int64) if "group" in cells else None,  # type: ignore[arg-type]
        np.array(column("on", switch_of)) == 0.0 if "on" in cells else None,  # type: ignore[arg-type]
    )


def _ordinary_vertices(cells: list[str], vertex_count: int) -> list[int] | None:
    """Vertices all at once; None where one of them is not in order, and has to be found."""
    if not all(map(str.isdecimal, cells)) or max(map(len, cells), default=0) > 18:
        return None
    vertices = list(map(int, cells))
    return vertices if max(vertices, default=0) < vertex_count else None


def _ordinary(cells: list[str], decimal_comma: bool) -> Floats | None:
    """Coordinates all at once; None where one of them is not in order, and has to be found."""
    try:
        values = np.array([cell.replace(",", ".") for cell in cells] if decimal_comma else cells, dtype=np.float64)
    except ValueError:
        return None
    return values if (np.abs(values) <= LARGEST_COORDINATE).all() else None


def _refuse_twins(vertices: list[int], lines: list[int], place: Place) -> None:
    if len(set(vertices)) == len(vertices):
        return
    seen: dict[int, int] = {}
    for line, vertex in zip(lines, vertices, strict=True):
        if vertex in seen:
            raise WorkbenchError(f"{place(line, 'vertex')}: vertex {vertex} has an anchor already, in line {seen[vertex]}.")
        seen[vertex] = line


def named_columns(header: Sequence[str], dimension: int) -> tuple[str, ...] | None:
    """Names of the columns of a header; None where it does not have what is needed, or has something unknown, or twice."""
    names = tuple(name.strip().lower().replace(" ", "_") for name in header)
    needed = {"vertex", *AXES[:dimension]}
    known = needed | {*MORE, *SHOWN_ONLY}
    return names if needed <= set(names) <= known and len(set(names)) == len(names) else None


# ---------------------------------------------------------------------------------------------- cells


def vertex_of(cell: str, vertex_count: int) -> int:
    """The vertex that a cell names. Raises `WorkbenchError`, as all of these do."""
    try:
        vertex = int(_whole(cell))
    except ValueError:
        raise WorkbenchError(f"{_shown(cell)} is not the number of a vertex.") from None
    if not 0 <= vertex < vertex_count:
        raise WorkbenchError(f"there is no vertex {_shown(vertex)}; the mesh has {vertex_count}, numbered from 0.")
    return vertex


def coordinate_of(cell: str) -> float:
    """A finite coordinate."""
    value = _number(cell, "a number")
    if not abs(value) <= LARGEST_COORDINATE:
        raise WorkbenchError(f"the coordinate {cell[:40]} is not finite, or too large.")
    return value


def weight_of(cell: str) -> float:
    """The weight of a soft anchor; inf for a hard one."""
    if cell.strip().lower() in HARD:
        return math.inf
    try:
        value = _number(cell, "a number")
    except WorkbenchError:
        value = math.nan
    if value == math.inf:
        return value
    if not 0.0 < value <= LARGEST_WEIGHT:
        raise WorkbenchError(
            f"the weight {_shown(cell)} is not a positive number up to {LARGEST_WEIGHT:g}; a hard anchor has none."
        )
    return value


def group_of(cell: str) -> int:
    """The number of a group; -1 for an anchor that moves alone."""
    number = _whole(cell)
    if number in ("", "-1"):
        return -1
    if not (number.isascii() and number.isdigit()) or len(number) > 20 or int(number) > LARGEST_GROUP:
        raise WorkbenchError(f"the group {_shown(cell)} is not a whole number from 0 on; leave it empty for no group.")
    return int(number)


def switch_of(cell: str) -> bool:
    """Whether an anchor is on."""
    word = cell.lower()
    if word not in ON + OFF:
        raise WorkbenchError(f"{_shown(cell)} is neither on nor off.")
    return word in ON


def _whole(cell: str) -> str:
    """Tables that keep every column as decimals write 5 as 5.0."""
    before, point, behind = cell.partition(".")
    return before if point and behind and not behind.strip("0") else cell


def _number(cell: str, noun: str) -> float:
    try:
        return float(cell)
    except ValueError:
        raise WorkbenchError(f"{_shown(cell)} is not {noun}.") from None


def _shown(value: object) -> str:
    """A value in a sentence, not too long."""
    text = str(value)
    shown = text if len(text) <= 40 else text[:40] + "…"
    return repr(shown) if isinstance(value, str) else shown


# ---------------------------------------------------------------------------------------------- writing


def columns_of(table: AnchorTable, *, whole: bool = False) -> dict[str, list[str]]:
    """The cells of each column by its name, as they are read back to the same numbers; `whole`: those of `MORE`, too.

    Without it, only those of `MORE` in which something stands.
    """
    columns = {"vertex": [str(vertex) for vertex in table.vertices.tolist()]}
    for axis, values in zip(AXES, table.targets.T, strict=False):
        columns[axis] = list(map(repr, values.tolist()))
    if whole or np.isfinite(table.weights).any():
        columns["weight"] = list(map(repr, table.weights.tolist()))
    if whole or (table.groups >= 0).any():
        columns["group"] = [str(group) if group >= 0 else "" for group in table.groups.tolist()]
    if whole or table.is_off.any():
        columns["on"] = ["off" if is_off else "on" for is_off in table.is_off.tolist()]
    return columns


def text_of(columns: dict[str, list[str]], separator: str) -> str:
    """A line a row, the names of the columns in the first."""
    rows = zip(*columns.values(), strict=True)
    return "\n".join([separator.join(columns), *(separator.join(row) for row in rows)]) + "\n"
