"""Wavefront OBJ, read as it is found in the wild: seams, polygons, negative indices, parts, any encoding."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import NoReturn

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.errors import MeshError
from workbench.core.mesh import Mesh, TextureCoordinates
from workbench.io.mesh_file import mesh_of_file
from workbench.io.obj_attributes import HEADS, NAMING, NamedParts, attributes_of
from workbench.io.polygons import fan
from workbench.io.text import decoded


@dataclass
class _Lines:
    """Lines of one keyword, and their numbers from 1."""

    keyword: str
    lines: list[str] = field(default_factory=list)
    numbers: list[int] = field(default_factory=list)

    def add(self, line: str, number: int) -> None:
        self.lines.append(line)
        self.numbers.append(number)

    def words(self) -> tuple[list[str], Integers]:
        """All words but the keywords, and how many stand on each line, (k,) int64."""
        flat = " ".join(self.lines).split()
        at = [i for i, word in enumerate(flat) if word == self.keyword]
        if len(at) != len(self.lines):  # the keyword stands among the arguments of a line as well
            rows = [line.split()[1:] for line in self.lines]
            return list(chain.from_iterable(rows)), np.array([len(row) for row in rows], dtype=np.int64)
        sizes = np.diff(at, append=len(flat)) - 1
        return [word for word in flat if word != self.keyword], sizes.astype(np.int64)

    def blame(self, path: Path, parse: Callable[[str], object], what: str, words: slice = slice(None)) -> NoReturn:
        """Raises `MeshError` for the first word that cannot be parsed."""
        for line, number in zip(self.lines, self.numbers, strict=True):
            for word in line.split()[1:][words]:
                try:
                    parse(word)
                except (ValueError, OverflowError):
                    raise MeshError(f"{path}, line {number}: {word[:40]!r} {what}; mend the line.") from None
        raise MeshError(f"{path}: the file cannot be understood.")


@dataclass
class _Statements:
    """The lines of an OBJ file that matter.

    `before` has four numbers a face: the vertices, texture coordinates and normals before it, and the part that it belongs to.
    """

    vertices: _Lines = field(default_factory=lambda: _Lines("v"))
    textures: _Lines = field(default_factory=lambda: _Lines("vt"))
    normals: _Lines = field(default_factory=lambda: _Lines("vn"))
    faces: _Lines = field(default_factory=lambda: _Lines("f"))
    named: NamedParts = field(default_factory=NamedParts)
    before: list[int] = field(default_factory=list)

    @property
    def before_faces(self) -> Integers:
        return np.array(self.before, dtype=np.int64).reshape(-1, 4)


def read_obj(path: Path, data: bytes, *, tets: bool = False) -> tuple[Mesh, tuple[str, ...]]:
    """The mesh in the bytes of an OBJ file, and notes.

    Polygons are fanned from their first corner; with `tets`, faces of four corners are tetrahedra and others are left
    out. Texture coordinates are kept where every corner has some; objects, groups, materials and normals where there are
    any. Raises `MeshError` with the line that is wrong.
    """
    found = _statements(decoded(path, data))
    if not found.vertices.lines:
        raise MeshError(f"{path}: there is no vertex (a line 'v x y z') in it; it is not an OBJ file, or an empty one.")
    if not found.faces.lines:
        raise MeshError(f"{path}: it has {len(found.vertices.lines)} vertices and no face ('f a b c'); is it cut short?")
    vertices = _vertex_table(path, found)
    words, sizes = found.faces.words()
    if sizes.min() < 3:
        line = found.faces.numbers[int(sizes.argmin())]
        raise MeshError(f"{path}, line {line}: a face needs three corners or more; the file is damaged or cut short.")
    corners, texture_corners, normal_corners = _corner_tables(path, found, words, sizes)
    if tets:
        return _tetrahedra(path, vertices, corners, sizes)

    notes: list[str] = []
    triangles_of, polygons = fan(sizes)
    texture = _texture(path, found, texture_corners, triangles_of, notes)
    fanned = polygons if sizes.max() > 3 else None
    attributes = attributes_of(
        path, found.named, found.before_faces[:, 3], _normal_table(found), normal_corners, triangles_of, polygons
    )
    mesh = mesh_of_file(path, vertices, corners[triangles_of], texture=texture, polygons=fanned, attributes=attributes)
    if fanned is not None:
        notes.append(f"{int((sizes > 3).sum())} polygons were fanned into triangles.")
    return mesh, tuple(notes)


def _statements(text: str) -> _Statements:
    found = _Statements()
    vertices, textures, normals, faces, named = found.vertices, found.textures, found.normals, found.faces, found.named
    lines = text.split("\n")
    if "\\\n" in text:
        lines = _joined(lines)
    for number, whole in enumerate(lines, start=1):
        line = whole.partition("#")[0] if "#" in whole else whole
        head = line[:2]
        if head not in ("v ", "f ", "vt", "vn"):
            line = line.strip()
            head = (line.replace("\t", " ") + " ")[:2]
        if head == "v ":
            vertices.add(line, number)
        elif head == "f ":
            faces.add(line, number)
            found.before += (len(vertices.lines), len(textures.lines), len(normals.lines), named.current)
        elif head == "vt" and line.split(None, 1)[0] == "vt":
            textures.add(line, number)
        elif head == "vn" and line.split(None, 1)[0] == "vn":
            normals.add(line, number)
        elif head in HEADS and line.split(None, 1)[0] in NAMING:
            named.take(whole)  # names may hold the sign of comments
    return found


def _joined(lines: list[str]) -> list[str]:
    """Lines continued by a backslash put together on their first line; the others stay, empty, for the numbering."""
    joined = list(lines)
    start = 0
    for number, line in enumerate(lines):
        if number != start:
            joined[start] += " " + line
            joined[number] = ""
        if joined[start].endswith("\\"):
            joined[start] = joined[start][:-1]
        else:
            start = number + 1
    return joined


def _vertex_table(path: Path, found: _Statements) -> Floats:
    words, widths = found.vertices.words()
    columns = 3 if widths.max() >= 3 else 2
    if widths.min() < columns:
        line = found.vertices.numbers[int(widths.argmin())]
        raise MeshError(f"{path}, line {line}: a vertex needs {columns} coordinates; the file is damaged or cut short.")
    vertices = _numbers(path, found.vertices, words, widths, columns)
    bad = ~np.isfinite(vertices).all(axis=1)
    if bad.any():
        line = found.vertices.numbers[int(bad.argmax())]
        raise MeshError(f"{path}, line {line}: a coordinate is not a finite number; mend it in the file.")
    return vertices


def _numbers(path: Path, lines: _Lines, words: list[str], widths: Integers, columns: int) -> Floats:
    """The first `columns` numbers of each line, which has at least as many words."""
    width = int(widths[0])
    if not (widths == width).all():
        starts = (np.cumsum(widths) - widths).tolist()
        words = [word for start in starts for word in words[start : start + columns]]
        width = columns
    try:
        return np.array([list(map(float, words[column::width])) for column in range(columns)]).T
    except ValueError:
        lines.blame(path, float, "is not a number", slice(columns))


def _normal_table(found: _Statements) -> Floats:
    """(k, 3), without any row where some line is no normal: nothing that is computed needs them."""
    try:
        words, widths = found.normals.words()
        return np.array(words, dtype=np.float64).reshape(-1, 3) if (widths == 3).all() else np.empty((0, 3))
    except ValueError:
        return np.empty((0, 3))


def _corner_tables(path: Path, found: _Statements, words: list[str], sizes: Integers) -> tuple[Integers, Integers, Integers]:
    """Vertex, texture coordinate and normal of each corner of each face, from 0, all (c,) int64; -1 for none."""
    try:
        vertex, texture, normal = _corner_numbers(words)
    except (ValueError, OverflowError):
        found.faces.blame(path, lambda word: _corner_numbers([word]), "is not a corner of a face")
    counts = np.repeat(found.before_faces, sizes, axis=0)
    lines = np.repeat(np.array(found.faces.numbers, dtype=np.int64), sizes)
    vertex = _from_zero(path, vertex, counts[:, 0], len(found.vertices.lines), lines, "vertex", "vertices")
    absent = texture == 0
    known = len(found.textures.lines)
    texture = _from_zero(
        path, np.where(absent, 1, texture), counts[:, 1], max(known, int(absent.any())), lines,
        "texture coordinate", "texture coordinates",
    )  # fmt: skip
    normal = np.where(normal > 0, normal - 1, np.where(normal < 0, np.maximum(counts[:, 2] + normal, -1), -1))
    return vertex, np.where(absent, -1, texture), normal


def _corner_numbers(words: list[str]) -> tuple[Integers, Integers, Integers]:
    """Numbers of vertex, texture coordinate and normal of corners `v`, `v/t`, `v//n` or `v/t/n`; 0 for none."""
    slashes = words[0].count("/")
    if slashes == 0:
        numbers = np.array(list(map(int, words)), dtype=np.int64) if "/" not in "".join(words) else None
    else:  # the same number of slashes in every word: one pass over one text
        is_even = slashes <= 2 and all(word.count("/") == slashes for word in words)
        text = "\n".join(words).replace("//", "/0/").replace("/\n", "/0\n") if is_even else ""
        if text.endswith("/"):
            text += "0"
        numbers = np.array(list(map(int, text.replace("/", " ").split())), dtype=np.int64) if is_even else None
    if numbers is not None and numbers.size == (slashes + 1) * len(words):
        table = np.zeros((len(words), 3), dtype=np.int64)
        table[:, : slashes + 1] = numbers.reshape(len(words), slashes + 1)
    else:
        parts = [(*word.split("/"), "", "")[:3] for word in words]
        table = np.array([[int(v), int(t or 0), int(n or 0)] for v, t, n in parts], dtype=np.int64).reshape(-1, 3)
    return table[:, 0], table[:, 1], table[:, 2]


def _from_zero(path: Path, index: Integers, before: Integers, count: int, lines: Integers, noun: str, plural: str) -> Integers:
    """Indices from 1, or counted back from the last one so far where negative, as indices from 0."""
    result = np.where(index > 0, index - 1, before + index)
    bad = (index == 0) | (result < 0) | (result >= count)
    if bad.any():
        at = int(bad.argmax())
        raise MeshError(
            f"{path}, line {lines[at]}: a face names {noun} {index[at]}, but the file has {count} {plural}; "
            f"it is damaged or cut short."
        )
    return np.asarray(result)


def _texture(
    path: Path, found: _Statements, corners: Integers, triangles_of: Integers, notes: list[str]
) -> TextureCoordinates | None:
    if not found.textures.lines or (corners < 0).all():
        return None
    if (corners < 0).any():
        notes.append("Some corners have no texture coordinates, so those of the others were left out.")
        return None
    words, widths = found.textures.words()
    if widths.min() < 2:  # one number alone: the other is zero
        rows = [(line.split()[1:3] + ["0", "0"])[:2] for line in found.textures.lines]
        words, widths = list(chain.from_iterable(rows)), np.full(len(rows), 2, dtype=np.int64)
    coordinates = _numbers(path, found.textures, words, widths, 2)
    if not np.isfinite(coordinates).all():
        notes.append("Some texture coordinates are not finite numbers, so all were left out.")
        return None
    return TextureCoordinates(coordinates, corners[triangles_of])


def _tetrahedra(path: Path, vertices: Floats, corners: Integers, sizes: Integers) -> tuple[Mesh, tuple[str, ...]]:
    is_tetrahedron = sizes == 4
    if not is_tetrahedron.any():
        raise MeshError(f"{path}: no face has four corners, so there are no tetrahedra in it; leave out --tets.")
    starts = (np.cumsum(sizes) - sizes)[is_tetrahedron]
    others = int((~is_tetrahedron).sum())
    notes = (f"{others} faces that do not have four corners were left out.",) if others else ()
    return mesh_of_file(path, vertices, corners[starts[:, None] + np.arange(4)]), notes
