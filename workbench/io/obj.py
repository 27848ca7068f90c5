"""Wavefront OBJ, read as it is found in the wild: seams, polygons, negative indices, any encoding."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import NoReturn

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.errors import MeshError
from workbench.core.mesh import Mesh, TextureCoordinates
from workbench.io.mesh_file import mesh_of_file
from workbench.io.polygons import fan
from workbench.io.text import decoded


@dataclass
class _Statements:
    """The lines of an OBJ file that matter, still as words; numbers of lines are from 1."""

    vertices: list[list[str]] = field(default_factory=list)
    vertex_lines: list[int] = field(default_factory=list)
    textures: list[list[str]] = field(default_factory=list)
    texture_lines: list[int] = field(default_factory=list)
    faces: list[list[str]] = field(default_factory=list)
    face_lines: list[int] = field(default_factory=list)
    counts_before: list[tuple[int, int]] = field(default_factory=list)


def read_obj(path: Path, data: bytes, *, tets: bool = False) -> tuple[Mesh, tuple[str, ...]]:
    """The mesh in the bytes of an OBJ file, and notes.

    Polygons are fanned from their first corner; with `tets`, faces of four corners are tetrahedra and others are left
    out. Texture coordinates are kept where every corner has some. Raises `MeshError` with the line that is wrong.
    """
    found = _statements(decoded(path, data))
    if not found.vertices:
        raise MeshError(f"{path}: there is no vertex (a line 'v x y z') in it; it is not an OBJ file, or an empty one.")
    if not found.faces:
        raise MeshError(f"{path}: it has {len(found.vertices)} vertices and no face ('f a b c'); is it cut short?")
    vertices = _vertex_table(path, found)
    sizes = np.array([len(face) for face in found.faces], dtype=np.int64)
    if sizes.min() < 3:
        line = found.face_lines[int(sizes.argmin())]
        raise MeshError(f"{path}, line {line}: a face needs three corners or more; the file is damaged or cut short.")
    corners, texture_corners = _corner_tables(path, found, sizes)
    if tets:
        return _tetrahedra(path, vertices, corners, sizes)

    notes: list[str] = []
    triangles_of, polygons = fan(sizes)
    texture = _texture(path, found, texture_corners, triangles_of, notes)
    fanned = polygons if sizes.max() > 3 else None
    mesh = mesh_of_file(path, vertices, corners[triangles_of], texture=texture, polygons=fanned)
    if fanned is not None:
        notes.append(f"{int((sizes > 3).sum())} polygons were fanned into triangles.")
    return mesh, tuple(notes)


def _statements(text: str) -> _Statements:
    found = _Statements()
    lines = text.split("\n")
    if "\\\n" in text:
        lines = _joined(lines)
    for number, line in enumerate(lines, start=1):
        if "#" in line:
            line = line.partition("#")[0]
        words = line.split()
        if not words:
            continue
        keyword = words[0]
        if keyword == "v":
            found.vertices.append(words)
            found.vertex_lines.append(number)
        elif keyword == "f" or keyword == "fo":
            found.faces.append(words[1:])
            found.face_lines.append(number)
            found.counts_before.append((len(found.vertices), len(found.textures)))
        elif keyword == "vt":
            found.textures.append(words)
            found.texture_lines.append(number)
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
    widths = [len(words) for words in found.vertices]
    columns = 3 if max(widths) > 3 else 2
    if min(widths) <= columns:
        line = found.vertex_lines[next(i for i, width in enumerate(widths) if width <= columns)]
        raise MeshError(f"{path}, line {line}: a vertex needs {columns} coordinates; the file is damaged or cut short.")
    vertices = _numbers(path, [words[1 : columns + 1] for words in found.vertices], found.vertex_lines)
    bad = ~np.isfinite(vertices).all(axis=1)
    if bad.any():
        line = found.vertex_lines[int(bad.argmax())]
        raise MeshError(f"{path}, line {line}: a coordinate is not a finite number; mend it in the file.")
    return vertices


def _numbers(path: Path, rows: list[list[str]], lines: list[int]) -> Floats:
    try:
        values = np.array(list(map(float, chain.from_iterable(rows))))
    except ValueError:
        _blame(path, rows, lines, float, "is not a number")
    return values.reshape(len(rows), -1)


def _corner_tables(path: Path, found: _Statements, sizes: Integers) -> tuple[Integers, Integers]:
    """Vertex and texture coordinate of each corner of each face, from 0, both (c,) int64; -1 for no texture."""
    tokens = list(chain.from_iterable(found.faces))
    try:
        if any("/" in token for token in tokens):
            parts = [token.split("/") for token in tokens]
            vertex = np.array([int(part[0]) for part in parts], dtype=np.int64)
            texture = np.array([int(part[1]) if len(part) > 1 and part[1] else 0 for part in parts], dtype=np.int64)
        else:
            vertex = np.array(list(map(int, tokens)), dtype=np.int64)
            texture = np.zeros(len(tokens), dtype=np.int64)
    except (ValueError, OverflowError):
        _blame(path, found.faces, found.face_lines, _corner, "is not a corner of a face")
    counts = np.repeat(np.array(found.counts_before, dtype=np.int64), sizes, axis=0)
    lines = np.repeat(np.array(found.face_lines, dtype=np.int64), sizes)
    vertex = _from_zero(path, vertex, counts[:, 0], len(found.vertices), lines, "vertex", "vertices")
    absent = texture == 0
    texture = _from_zero(
        path, np.where(absent, 1, texture), counts[:, 1], max(len(found.textures), int(absent.any())), lines,
        "texture coordinate", "texture coordinates",
    )  # fmt: skip
    return vertex, np.where(absent, -1, texture)


def _corner(token: str) -> None:
    part = token.split("/")
    np.array([int(part[0]), int(part[1]) if len(part) > 1 and part[1] else 0], dtype=np.int64)


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
    if not found.textures or (corners < 0).all():
        return None
    if (corners < 0).any():
        notes.append("Some corners have no texture coordinates, so those of the others were left out.")
        return None
    rows = [(words[1:3] + ["0", "0"])[:2] for words in found.textures]
    coordinates = _numbers(path, rows, found.texture_lines)
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


def _blame(
    path: Path, rows: Sequence[Sequence[str]], lines: Sequence[int], parse: Callable[[str], object], what: str
) -> NoReturn:
    """Raises `MeshError` for the first word that cannot be parsed."""
    for row, line in zip(rows, lines, strict=True):
        for word in row:
            try:
                parse(word)
            except (ValueError, OverflowError):
                raise MeshError(f"{path}, line {line}: {word[:40]!r} {what}; mend the line.") from None
    raise MeshError(f"{path}: the file cannot be understood.")
