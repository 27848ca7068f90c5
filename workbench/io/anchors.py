"""Anchors as CSV: header `vertex,x,y[,z][,weight][,group][,on]`, vertices from 0."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from workbench.core.arrays import Integers
from workbench.core.errors import WorkbenchError
from workbench.core.mesh import Mesh
from workbench.io.anchor_rows import AXES, MORE, AnchorTable, columns_of, named_columns, parse_rows, rows_of, text_of
from workbench.io.atomic import write_text
from workbench.io.read import read_bytes
from workbench.io.text import decoded


def read_anchors(path: str | os.PathLike[str], vertex_count: int, dimension: int) -> AnchorTable:
    """Anchors of a CSV file for a map of `dimension` columns on a mesh of `vertex_count` vertices.

    Semicolons, decimal commas and tabs of spreadsheets are taken, too. Raises `WorkbenchError` with the line that is wrong:
    a vertex out of range or twice, a number that is not finite.
    """
    path = Path(path)
    try:
        rows, decimal_comma = rows_of(decoded(path, read_bytes(path)))
    except WorkbenchError as error:
        raise WorkbenchError(error.sentence if str(path) in error.sentence else f"{path}: {error.sentence}") from None
    header = rows[0][1] if rows else []
    names = named_columns(header, dimension)
    if names is None:
        plain = ",".join(("vertex", *AXES[:dimension]))
        raise WorkbenchError(
            f"{path}: the first line is {','.join(name.strip().lower() for name in header)[:80]!r}; "
            f"for this map it has to be '{plain}', with {', '.join(MORE[:-1])} or {MORE[-1]} behind where wanted."
        )
    return parse_rows(
        rows[1:], names, vertex_count, dimension, lambda line, _: f"{path}, line {line}", decimal_comma=decimal_comma
    )


def write_anchors(path: str | os.PathLike[str], table: AnchorTable) -> None:
    """Anchors as a CSV that reads back to the same; weights, groups and switches only where there are any."""
    write_text(path, text_of(columns_of(table), ","))


def vertices_after_fixes(path: str | os.PathLike[str], vertices: Integers, mesh: Mesh) -> Integers:
    """Vertices (k,) of the mesh file as vertices of the mesh that is solved on. Raises `WorkbenchError`."""
    origin = mesh.vertex_origin
    if origin is None:
        return vertices
    copies = np.bincount(origin, minlength=int(vertices.max(initial=0)) + 1)[vertices]
    if (copies != 1).any():
        vertex, count = int(vertices[copies != 1][0]), int(copies[copies != 1][0])
        what = "was dropped by a fix" if not count else f"was cut into {count} vertices by a fix"
        raise WorkbenchError(f"{path}: vertex {vertex} {what}; anchor another vertex.")
    order = np.argsort(origin, kind="stable")
    found: Integers = order[np.searchsorted(origin[order], vertices)]
    return found


def vertices_before_fixes(vertices: Integers, mesh: Mesh) -> Integers:
    """Vertices (k,) of the mesh that is solved on as its file has them. Raises `WorkbenchError` where a cut made several."""
    origin = mesh.vertex_origin
    if origin is None:
        return vertices
    found: Integers = origin[vertices]
    copies = np.bincount(origin)[found]
    if (copies > 1).any():
        vertex = int(vertices[copies > 1][0])
        raise WorkbenchError(
            f"Vertex {vertex} lies on a cut, and the file of the mesh has one vertex for both sides; "
            "a file of anchors cannot tell them apart: save the session instead."
        )
    return found
