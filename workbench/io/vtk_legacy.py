"""VTK's legacy format where meshio gives up: surfaces as POLYDATA, and what VTK 9 itself writes beside points and cells."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.io.linear_elements import Blocks

CELL_KINDS = {
    1: "vertex", 3: "line", 4: "line", 5: "triangle", 6: "strip", 7: "polygon", 9: "quad", 10: "tetra", 12: "hexahedron",
    13: "wedge", 14: "pyramid", 21: "line3", 22: "triangle6", 24: "tetra10",
}  # fmt: skip
TYPES = {
    "float": "f4", "double": "f8", "int": "i4", "unsigned_int": "u4", "long": "i8", "unsigned_long": "u8", "vtkidtype": "i8",
    "vtktypeint64": "i8", "vtktypeuint64": "u8", "vtktypeint32": "i4", "char": "i1", "unsigned_char": "u1", "short": "i2",
    "unsigned_short": "u2", "bit": "u1",
}  # fmt: skip
DATASETS = ("POLYDATA", "UNSTRUCTURED_GRID")
PARTS = {"POLYGONS": 7, "TRIANGLE_STRIPS": 6, "LINES": 4, "VERTICES": 1}
"""Kinds of cells of a surface, by the word that they follow."""


class LegacyError(ValueError):
    """The bytes are not those of a legacy file that is read here."""


@dataclass
class _Reader:
    """The bytes after the title, and how far they are read."""

    data: bytes
    is_binary: bool
    at: int = 0
    words: list[bytes] = field(default_factory=list)

    def __post_init__(self) -> None:
        if not self.is_binary:
            self.words = self.data.split()

    def line(self) -> list[str] | None:
        """The words of the next line that has any; in text, where lines mean nothing, the next word. None at the end."""
        if not self.is_binary:
            self.at += 1
            return [self.words[self.at - 1].decode("latin-1")] if self.at <= len(self.words) else None
        while self.at < len(self.data):
            end = self.data.find(b"\n", self.at)
            end = len(self.data) if end < 0 else end
            words, self.at = self.data[self.at : end].decode("latin-1").split(), end + 1
            if words:
                return words
        return None

    def arguments(self, words: list[str], count: int) -> list[str]:
        """What follows the first of `words`, `count` of them."""
        while len(words) <= count:
            more = self.line()
            if more is None:
                raise LegacyError("it ends too early")
            words = words + more
        return words[1 : count + 1]

    def numbers(self, kind: str, amount: int) -> np.ndarray:
        if kind not in TYPES or not 0 <= amount <= len(self.data):
            raise LegacyError("its numbers are of no known type, or too many")
        code = TYPES[kind]
        if not self.is_binary:
            words, self.at = self.words[self.at : self.at + amount], self.at + amount
            parse: Any = float if code[0] == "f" else int
            values = np.array(list(map(parse, words)), dtype="f8" if code[0] == "f" else "i8")
        else:
            end = self.at + amount * int(code[1])
            values, self.at = np.frombuffer(self.data[self.at : end], ">" + code), end
        if len(values) < amount:
            raise LegacyError("it ends too early")
        return values

    def skip_metadata(self) -> None:
        """In a binary file it ends with an empty line."""
        if self.is_binary:
            end = self.data.find(b"\n\n", self.at)
            self.at = len(self.data) if end < 0 else end + 2


def read_vtk_legacy(data: bytes) -> tuple[Floats, Blocks]:
    """Points (n, 3) and elements of a legacy VTK file, text or binary, a surface or an unstructured grid.

    Raises `LegacyError`, or another `ValueError`, for anything else.
    """
    parts = data.replace(b"\r\n", b"\n", 4).split(b"\n", 3)
    if len(parts) < 4 or not parts[0].startswith(b"# vtk DataFile Version "):
        raise LegacyError("it does not begin as such a file")
    reader = _Reader(parts[3], parts[2].strip().upper() == b"BINARY")
    is_new = parts[0].split()[-1].split(b".")[0] >= b"5"
    points: Floats | None = None
    cells: list[tuple[int, Integers]] = []
    rows: list[Integers] = []
    while (words := reader.line()) is not None:
        word = words[0].upper()
        if word == "DATASET" and reader.arguments(words, 1)[0].upper() not in DATASETS:
            raise LegacyError("its kind of data is not read here")
        if word == "POINTS":
            count, kind = reader.arguments(words, 2)
            points = reader.numbers(kind.lower(), 3 * int(count)).reshape(-1, 3).astype(np.float64)
        elif word in PARTS:
            cells += [(PARTS[word], row) for row in _rows(reader, reader.arguments(words, 2), is_new)]
        elif word == "CELLS":
            rows = _rows(reader, reader.arguments(words, 2), is_new)
        elif word == "CELL_TYPES":
            kinds = reader.numbers("int", int(reader.arguments(words, 1)[0]))
            cells += zip(kinds.tolist(), rows, strict=True)
        elif word == "METADATA":
            reader.skip_metadata()
        elif word == "FIELD":
            _skip_field(reader, int(reader.arguments(words, 2)[1]))
        elif word in ("POINT_DATA", "CELL_DATA"):
            break
    if points is None:
        raise LegacyError("it has no points")
    return points, _blocks(cells)


def _rows(reader: _Reader, sizes: list[str], is_new: bool) -> list[Integers]:
    """The corners of each cell."""
    if not is_new:
        flat = reader.numbers("int", int(sizes[1])).astype(np.int64)
        count, ends = int(sizes[0]), [0]
        for _ in range(count):
            if not (ends[-1] < len(flat) and flat[ends[-1]] >= 0):
                raise LegacyError("its cells are damaged")
            ends.append(ends[-1] + 1 + int(flat[ends[-1]]))
        if ends[-1] > len(flat):
            raise LegacyError("its cells are damaged")
        return [flat[begin + 1 : end] for begin, end in pairwise(ends)]
    found = {}
    for wanted, size in zip(("OFFSETS", "CONNECTIVITY"), sizes, strict=True):
        words = reader.line() or [""]
        if words[0].upper() != wanted:
            raise LegacyError("its cells are damaged")
        found[wanted] = reader.numbers(reader.arguments(words, 1)[0].lower(), int(size)).astype(np.int64)
    offsets = found["OFFSETS"]
    if len(offsets) and (offsets[0] or (np.diff(offsets) < 0).any() or offsets[-1] > len(found["CONNECTIVITY"])):
        raise LegacyError("its cells are damaged")
    return np.split(found["CONNECTIVITY"], offsets[1:-1]) if len(offsets) > 1 else []


def _skip_field(reader: _Reader, arrays: int) -> None:
    for _ in range(arrays):
        words = reader.line()
        if words is None:
            raise LegacyError("it ends too early")
        components, tuples, kind = reader.arguments(words, 3)
        if kind.lower() == "string":
            raise LegacyError("it holds texts")
        reader.numbers(kind.lower(), int(components) * int(tuples))


def _blocks(cells: list[tuple[int, Integers]]) -> Blocks:
    """Tables of cells of one kind and size that follow each other."""
    runs: list[tuple[str, list[Integers]]] = []
    for number, row in cells:
        kind = CELL_KINDS.get(number, f"cells of the type {number}")
        for name, corners in _faces_of_strip(row) if kind == "strip" else [(kind, row)]:
            if not runs or runs[-1][0] != name or len(runs[-1][1][-1]) != len(corners):
                runs.append((name, []))
            runs[-1][1].append(corners)
    return [(name, np.stack(rows)) for name, rows in runs]


def _faces_of_strip(row: Integers) -> list[tuple[str, Integers]]:
    """Triangles of a strip, every other one turned over so that all agree."""
    triangles = np.stack([row[:-2], row[1:-1], row[2:]], axis=1)
    triangles[1::2] = triangles[1::2, ::-1]
    return [("triangle", triangle) for triangle in triangles]
