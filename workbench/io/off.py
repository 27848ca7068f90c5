"""OFF, read with own code: the reader of meshio knows triangles only, and never returns from some cut files."""

from __future__ import annotations

from itertools import chain
from pathlib import Path

import numpy as np

from workbench.core.errors import MeshError
from workbench.core.mesh import Mesh
from workbench.io.mesh_file import mesh_of_file
from workbench.io.polygons import fan
from workbench.io.text import decoded


def read_off(path: Path, data: bytes) -> tuple[Mesh, tuple[str, ...]]:
    """The mesh in the bytes of a text OFF file (`OFF`, or with colours and normals: `COFF`, `NOFF` ...), and notes."""
    rows = []
    numbers = []
    for number, line in enumerate(decoded(path, data).split("\n"), start=1):
        words = line.partition("#")[0].split()
        if words:
            rows.append(words)
            numbers.append(number)
    if not rows or not rows[0][0].upper().endswith("OFF"):
        raise MeshError(f"{path}: it does not begin with OFF, so it is not an OFF file; is the ending right?")
    counts = rows[0][1:] or (rows[1] if len(rows) > 1 else [])
    at = 1 if rows[0][1:] else 2
    try:
        vertex_count, face_count = int(counts[0]), int(counts[1])
    except (ValueError, IndexError):
        raise MeshError(f"{path}: the numbers of vertices and faces are missing after OFF; is it cut short?") from None
    if vertex_count < 1 or face_count < 1 or len(rows) < at + vertex_count + face_count:
        raise MeshError(
            f"{path}: it promises {vertex_count} vertices and {face_count} faces, but has {max(len(rows) - at, 0)} "
            f"lines of them; it is empty or cut short."
        )
    vertex_rows = rows[at : at + vertex_count]
    face_rows = rows[at + vertex_count : at + vertex_count + face_count]
    vertices = np.array([_parsed(path, row, 0, 3, float, line) for row, line in zip(vertex_rows, numbers[at:], strict=False)])
    faces = [
        _parsed(path, row, 1, _size(path, row, line), int, line)
        for row, line in zip(face_rows, numbers[at + vertex_count :], strict=False)
    ]
    sizes = np.array([len(face) for face in faces], dtype=np.int64)
    try:
        corners = np.array(list(chain.from_iterable(faces)), dtype=np.int64)
    except OverflowError:
        raise MeshError(f"{path}: a face names a vertex that is out of range; the file is damaged.") from None
    triangles_of, polygons = fan(sizes)
    fanned = polygons if sizes.max() > 3 else None
    notes = () if fanned is None else (f"{int((sizes > 3).sum())} polygons were fanned into triangles.",)
    return mesh_of_file(path, vertices, corners[triangles_of], polygons=fanned), notes


def _size(path: Path, row: list[str], line: int) -> int:
    (size,) = _parsed(path, row, 0, 1, int, line)
    if size < 3:
        raise MeshError(f"{path}, line {line}: a face needs three corners or more; the file is damaged or cut short.")
    return int(size)


def _parsed(path: Path, row: list[str], begin: int, count: int, parse: type, line: int) -> list[float]:
    try:
        values = [parse(word) for word in row[begin : begin + count]]
    except ValueError:
        values = []
    if len(values) < count:
        raise MeshError(f"{path}, line {line}: {count} numbers are needed here; the file is damaged or cut short.")
    return values
