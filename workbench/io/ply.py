"""PLY, read with own code: files of MeshLab, Blender or a scanner hold more beside vertices and faces than meshio bears."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.errors import MeshError
from workbench.core.mesh import Mesh
from workbench.io.mesh_file import mesh_of_file
from workbench.io.polygons import fan

TYPES = {
    **dict.fromkeys(("char", "int8"), "i1"),
    **dict.fromkeys(("uchar", "uint8"), "u1"),
    **dict.fromkeys(("short", "int16"), "i2"),
    **dict.fromkeys(("ushort", "uint16"), "u2"),
    **dict.fromkeys(("int", "int32"), "i4"),
    **dict.fromkeys(("uint", "uint32"), "u4"),
    **dict.fromkeys(("float", "float32"), "f4"),
    **dict.fromkeys(("double", "float64"), "f8"),
}
BYTE_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
END = re.compile(rb"(?<=[\r\n])end_header[ \t]*(\r\n|\n|\r)")
FACES = ("vertex_indices", "vertex_index")
MOST_PROPERTIES = 1000
"""Of one element; what scanners write has some hundred at the most."""


@dataclass(frozen=True)
class _Property:
    """A number a row, of type `item`; a list of them where `count` is the type of their number."""

    name: str
    item: str
    count: str = ""


@dataclass(frozen=True)
class _Element:
    """Rows of one kind, as the header promises them."""

    name: str
    rows: int
    properties: tuple[_Property, ...]


Columns = dict[str, tuple[np.ndarray, np.ndarray]]
"""By name of property: the numbers of all rows, one after another, and how many each row has, (rows,) int64."""


def read_ply(path: Path, data: bytes) -> tuple[Mesh, tuple[str, ...]]:
    """The mesh in the bytes of a PLY file, text or binary, and notes; whatever is no vertex and no face is passed over."""
    end = END.search(data)
    if not data.startswith(b"ply") or end is None:
        raise MeshError(f"{path}: its header has no end, so it is no PLY file, or one that is cut short.")
    order, elements = _header(path, data[: end.start()].decode("latin-1"))
    body = data[end.end() :]
    for element in elements:
        if element.properties and element.rows > len(body):
            raise MeshError(f"{path}: it promises {element.rows} elements, more than it has bytes; it is cut short.")
    reader = _BinaryBody(path, body, order) if order else _TextBody(path, body)
    found: dict[str, Columns] = {}
    for element in elements:
        found[element.name] = reader.read(element)
        if {"vertex", "face"} <= found.keys():
            break
    return _mesh(path, found, [element.name for element in elements])


def _header(path: Path, text: str) -> tuple[str, list[_Element]]:
    order = None
    elements: list[_Element] = []
    for line in text.splitlines()[1:]:
        words = line.split()
        try:
            if words[:1] == ["format"]:
                order = BYTE_ORDERS[words[1]]
            elif words[:1] == ["element"]:
                elements.append(_Element(words[1], _count(words[2]), ()))
            elif words[:1] == ["property"]:
                name = words[-1]
                is_list = words[1] == "list"
                new = _Property(name, TYPES[words[3]], TYPES[words[2]]) if is_list else _Property(name, TYPES[words[1]])
                last = elements[-1]
                if len(last.properties) == MOST_PROPERTIES:
                    raise MeshError(f"{path}: its elements {last.name[:60]!r} have too many properties; it is damaged.")
                elements[-1] = _Element(last.name, last.rows, (*last.properties, new))
        except (KeyError, IndexError, ValueError):
            raise MeshError(f"{path}: the line {line[:60]!r} of its header is not understood; the file is damaged.") from None
    if order is None:
        raise MeshError(f"{path}: its header names no format, ascii or binary; the file is damaged.")
    return order, elements


def _count(word: str) -> int:
    if not word.isdecimal():
        raise ValueError(word)
    return int(word[:18])


class _Body:
    """What follows the header, read from the front, an element after the other."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def cut_short(self, element: _Element) -> NoReturn:
        raise MeshError(
            f"{self.path}: it ends within its {element.rows} elements {element.name!r}; it is damaged or cut short."
        )

    def read(self, element: _Element) -> Columns:
        """The columns of an element; rows whose lists are all as long as those of the first row are read at once."""
        if not element.rows or not element.properties:
            return {p.name: (np.empty(0), np.zeros(element.rows, dtype=np.int64)) for p in element.properties}
        return self.even(element) or self.uneven(element)

    def even(self, element: _Element) -> Columns | None:
        """The columns where all rows are of one shape, else None."""
        raise NotImplementedError

    def number(self, element: _Element, kind: str, amount: int) -> np.ndarray:
        """The next `amount` numbers of a type."""
        raise NotImplementedError

    def uneven(self, element: _Element) -> Columns:
        """The columns, row by row."""
        rows: dict[str, list[np.ndarray]] = {p.name: [] for p in element.properties}
        for _ in range(element.rows):
            for p in element.properties:
                size = self.size(element, p)
                rows[p.name].append(self.number(element, p.item, size))
        sizes = {name: np.array([len(row) for row in parts], dtype=np.int64) for name, parts in rows.items()}
        return {name: (np.concatenate(parts), sizes[name]) for name, parts in rows.items()}

    def size(self, element: _Element, p: _Property) -> int:
        """How many numbers stand in the next place."""
        size = self.number(element, p.count, 1)[0] if p.count else 1
        if not 0 <= size < 2**31 or size != int(size):
            raise MeshError(f"{self.path}: a list of its elements {element.name!r} is said to be {size} long; it is damaged.")
        return int(size)


class _BinaryBody(_Body):
    def __init__(self, path: Path, data: bytes, order: str) -> None:
        super().__init__(path)
        self.data, self.order, self.at = data, order, 0

    def even(self, element: _Element) -> Columns | None:
        begin, sizes = self.at, []
        fields: list[Any] = []
        for i, p in enumerate(element.properties):
            size = self.size(element, p)
            self.number(element, p.item, size)
            sizes.append(size)
            fields += [(f"count{i}", self.order + p.count)] if p.count else []
            fields.append((f"item{i}", self.order + p.item, (size,)))
        self.at = begin
        row = np.dtype(fields)
        if begin + row.itemsize * element.rows > len(self.data):
            return None
        table = np.frombuffer(self.data, row, element.rows, begin)
        if any(p.count and (table[f"count{i}"] != sizes[i]).any() for i, p in enumerate(element.properties)):
            return None
        self.at += row.itemsize * element.rows
        return {
            p.name: (table[f"item{i}"].reshape(-1), np.full(element.rows, sizes[i]))
            for i, p in enumerate(element.properties)
        }  # fmt: skip

    def number(self, element: _Element, kind: str, amount: int) -> np.ndarray:
        end = self.at + amount * int(kind[1])
        if end > len(self.data):
            self.cut_short(element)
        values = np.frombuffer(self.data, self.order + kind, amount, self.at)
        self.at = end
        return values


class _TextBody(_Body):
    def __init__(self, path: Path, data: bytes) -> None:
        super().__init__(path)
        self.words, self.at = data.split(), 0

    def even(self, element: _Element) -> Columns | None:
        begin, places, sizes = self.at, [], []
        for p in element.properties:
            sizes.append(self.size(element, p))
            places.append(self.at - begin)
            self.number(element, p.item, sizes[-1])
        width, self.at = self.at - begin, begin
        end = begin + width * element.rows
        if end > len(self.words):
            return None
        words = self.words[begin:end]
        counts = (words[at - 1 :: width] for at, p in zip(places, element.properties, strict=True) if p.count)
        expected = (words[at - 1] for at, p in zip(places, element.properties, strict=True) if p.count)
        if any(set(column) != {first} for column, first in zip(counts, expected, strict=True)):
            return None
        self.at = end
        columns: Columns = {}
        for p, at, size in zip(element.properties, places, sizes, strict=True):
            parts = [self.parsed(words[at + k :: width], p.item) for k in range(size)]
            values = np.stack(parts, axis=1).reshape(-1) if parts else np.empty(0)
            columns[p.name] = values, np.full(element.rows, size)
        return columns

    def number(self, element: _Element, kind: str, amount: int) -> np.ndarray:
        words = self.words[self.at : self.at + amount]
        if len(words) < amount:
            self.cut_short(element)
        self.at += amount
        return self.parsed(words, kind)

    def parsed(self, words: list[bytes], kind: str) -> np.ndarray:
        try:
            return np.array(
                list(map(float if kind[0] == "f" else int, words)), dtype=np.float64 if kind[0] == "f" else np.int64
            )
        except (ValueError, OverflowError):
            raise MeshError(f"{self.path}: a number in it cannot be read ({_bad(words, kind)}); the file is damaged.") from None


def _bad(words: list[bytes], kind: str) -> str:
    for word in words:
        try:
            np.int64(int(word)) if kind[0] != "f" else float(word)
        except (ValueError, OverflowError):
            return repr(word[:40].decode("latin-1"))
    return "it is too large"


def _mesh(path: Path, found: dict[str, Columns], names: list[str]) -> tuple[Mesh, tuple[str, ...]]:
    vertex, face = found.get("vertex", {}), found.get("face", {})
    if "x" not in vertex or "y" not in vertex or not len(vertex["x"][0]):
        raise MeshError(f"{path}: there are no vertices (an element `vertex` with x, y, z) in it.")
    vertices: Floats = np.column_stack([vertex[axis][0] for axis in "xyz" if axis in vertex]).astype(np.float64)
    corners, sizes = next((face[name] for name in FACES if name in face), (np.empty(0), np.empty(0, dtype=np.int64)))
    if not len(corners):
        raise MeshError(f"{path}: there are no faces (an element `face` with vertex_indices) in it; it has {', '.join(names)}.")
    if sizes.min() < 3:
        raise MeshError(f"{path}: a face has fewer than three corners; the file is damaged.")
    triangles_of, polygons = fan(sizes)
    triangles: Integers = corners.astype(np.int64)[triangles_of]
    fanned = polygons if sizes.max() > 3 else None
    notes = () if fanned is None else (f"{int((sizes > 3).sum())} polygons were fanned into triangles.",)
    return mesh_of_file(path, vertices, triangles, polygons=fanned), notes
