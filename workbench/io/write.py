"""Writing a map: OBJ, npz case, VTU with fields, CSV of the fields."""

from __future__ import annotations

import csv
import io
import math
import os
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from workbench.core.arrays import Floats, Integers
from workbench.core.errors import WorkbenchError
from workbench.core.measure import Measure
from workbench.core.mesh import FaceAttributes, Mesh
from workbench.core.method import Kind
from workbench.core.plane_frame import into_plane_of
from workbench.core.quality import simplex_table
from workbench.io.atomic import replacing, write_text
from workbench.io.foreign import silenced
from workbench.io.obj_attributes import library_lines
from workbench.io.obj_faces import faces_text

WRITABLE = (".obj", ".npz", ".vtu", ".mesh", ".msh", ".csv")
"""Endings of the files that a map can be written to."""
SURFACE_ENDINGS = (".obj", ".npz", ".vtu", ".csv")
"""Endings of the files that a carried surface can be written to."""


def write_map(
    path: str | os.PathLike[str],
    file_mesh: Mesh,
    source_mesh: Mesh,
    positions: ArrayLike,
    kind: Kind,
    *,
    fields: Mapping[str, ArrayLike] | None = None,
    others: Iterable[Measure] = (),
    anchor_vertices: ArrayLike | None = None,
    anchor_targets: ArrayLike | None = None,
) -> None:
    """Writes a map in the format of the ending of `path`; the file is whole or not there.

    OBJ: for parameterize the vertices and faces of the file as they were, polygons too, and the map as `vt`, with the
    objects, groups, materials and normals of the file; for plane and volume the map as `v` (in the plane of the file where
    that was a plane in space). npz: `V S X anchors targets`. VTU: the map, with fields on the simplices. MEDIT and Gmsh
    (2.2, binary): the map alone. CSV: a row a simplex, a column a field.
    Numbers have as many digits as it takes to read back to the same values.

    Parameters
    ----------
    file_mesh : Mesh               as read
    source_mesh : Mesh             as solved on, after fixes: where these dropped simplices, what was kept is written
    positions : (n, d) float64     of the vertices of `source_mesh`
    fields : name -> (m,)          numbers a simplex, for VTU and CSV; where none are given, those of `simplex_table`,
    others : Measure ...           with these beside them, as the formula that is minimised
    anchor_vertices, anchor_targets : (k,) int64, (k, d) float64     for npz

    Raises `WorkbenchError` for an ending that is not known, or a place that cannot be written.
    """
    ending = Path(path).suffix.lower()
    positions = np.asarray(positions, dtype=np.float64)
    if ending == ".obj":
        write_text(path, obj_text(file_mesh, source_mesh, positions, kind, Path(path)))
    elif ending == ".npz":
        _write_npz(path, source_mesh, positions, anchor_vertices, anchor_targets)
    elif ending in (".vtu", ".csv"):
        columns = simplex_table(source_mesh, positions, others) if fields is None else fields
        write_simplices(path, source_mesh, positions, columns)
    elif ending in (".mesh", ".msh"):
        _write_by_meshio(path, source_mesh, positions)
    else:
        raise WorkbenchError(
            f"{path}: maps are written as {', '.join(WRITABLE)}; the ending {ending or '(none)'} is not one of them."
        )


def write_mesh(path: str | os.PathLike[str], mesh: Mesh) -> None:
    """Writes a mesh alone, as OBJ (tetrahedra as faces of four corners; triangles with their texture coordinates)."""
    if mesh.dimension == 3:
        write_text(path, _rows("v", mesh.vertices) + faces_text(mesh.simplices))
        return
    texture, attributes = mesh.texture, mesh.attributes
    if attributes is not None:  # normals are those of another shape as soon as vertices have moved
        attributes = replace(attributes, normals=np.empty((0, 3)))
    points, corners = (None, None) if texture is None else (texture.coordinates, texture.corners)
    faces = faces_text(mesh.simplices, mesh.polygons, corners, attributes)
    write_text(path, _surface_text(mesh.vertices, points, faces, attributes, Path(path)))


def write_surface(
    path: str | os.PathLike[str], surface: Mesh, positions: Floats, columns: Mapping[str, ArrayLike] | None = None
) -> None:
    """Writes a surface in space where a map takes its vertices, `positions` (n, 3), in the format of the ending of `path`.

    OBJ keeps faces and texture coordinates; npz has the source as `V`; VTU and CSV have `columns`, or else what
    `simplex_table` finds for the surface's own map.
    Raises `WorkbenchError` for an ending that is not known, or a place that cannot be written.
    """
    ending = Path(path).suffix.lower()
    if ending not in SURFACE_ENDINGS:
        raise WorkbenchError(f"{path}: surfaces are written as {', '.join(SURFACE_ENDINGS)}; choose one of these endings.")
    if ending == ".obj":
        write_mesh(path, replace(surface, vertices=positions))
    elif ending == ".npz":
        write_case(path, {"V": surface.vertices, "S": surface.simplices, "X": positions})
    else:
        write_simplices(path, surface, positions, simplex_table(surface, positions) if columns is None else columns)


def write_simplices(path: str | os.PathLike[str], mesh: Mesh, positions: Floats, columns: Mapping[str, ArrayLike]) -> None:
    """Writes numbers a simplex, name -> (m,): `.vtu` has them as fields on the map, any other ending is a table in CSV."""
    if Path(path).suffix.lower() == ".vtu":
        _write_by_meshio(path, mesh, positions, columns)
    else:
        write_text(path, simplex_table_text(columns))


def write_case(path: str | os.PathLike[str], arrays: Mapping[str, ArrayLike]) -> None:
    """Writes an npz case of these arrays: `V S X X0 anchors targets`, those that there are."""
    with replacing(path) as part, part.open("wb") as stream:
        plain: dict[str, Any] = {name: np.asarray(values) for name, values in arrays.items()}
        np.savez_compressed(stream, **plain)


def obj_text(file_mesh: Mesh, source_mesh: Mesh, positions: Floats, kind: Kind, place: Path) -> str:
    """The OBJ file of a map at a place; see `write_map`."""
    if kind == "volume":
        return _rows("v", positions) + faces_text(source_mesh.simplices)
    attributes, polygons = source_mesh.attributes, source_mesh.polygons
    if kind == "plane":
        faces = faces_text(source_mesh.simplices, polygons, None, attributes)
        return _surface_text(_plane_points(file_mesh, source_mesh, positions), None, faces, attributes, place)
    kept, vertices = file_mesh.vertices, source_mesh.simplices
    if source_mesh.vertex_origin is not None:
        used, number = np.unique(source_mesh.vertex_origin, return_inverse=True)
        kept, vertices = kept[used], number.reshape(-1)[vertices]
    faces = faces_text(vertices, polygons, source_mesh.simplices, attributes)
    return _surface_text(kept, positions, faces, attributes, place)


def _surface_text(vertices: Floats, texture: Floats | None, faces: str, attributes: FaceAttributes | None, place: Path) -> str:
    """Everything of an OBJ file of a surface, in the order that programs expect."""
    parts = [] if attributes is None else [library_lines(attributes, place)]
    parts.append(_rows("v", _in_space(vertices)))
    if texture is not None:
        parts.append(_rows("vt", texture))
    if attributes is not None:
        parts.append(_rows("vn", attributes.normals))
    return "".join((*parts, faces))


def _plane_points(file_mesh: Mesh, source_mesh: Mesh, positions: Floats) -> Floats:
    if file_mesh.vertices.shape[1] == 2:
        return _in_space(positions)
    origin = source_mesh.vertex_origin
    space = file_mesh.vertices if origin is None else file_mesh.vertices[origin]
    return into_plane_of(space, source_mesh.vertices, positions)


def _in_space(points: Floats) -> Floats:
    return points if points.shape[1] == 3 else np.column_stack([points, np.zeros(len(points))])


def _rows(keyword: str, table: Floats) -> str:
    row = keyword + " %r" * table.shape[1] + "\n"
    return (row * len(table)) % tuple(table.ravel().tolist())


def _write_npz(
    path: str | os.PathLike[str], mesh: Mesh, positions: Floats, vertices: ArrayLike | None, targets: ArrayLike | None
) -> None:
    anchors: Integers = np.asarray([] if vertices is None else vertices, dtype=np.int64)
    targets = np.asarray([] if targets is None else targets, dtype=np.float64)
    targets = targets.reshape(len(anchors), positions.shape[1])
    write_case(path, {"V": mesh.vertices, "S": mesh.simplices, "X": positions, "anchors": anchors, "targets": targets})


def _write_by_meshio(
    path: str | os.PathLike[str], mesh: Mesh, positions: Floats, columns: Mapping[str, ArrayLike] | None = None
) -> None:
    ending = Path(path).suffix.lower()
    cells = [("triangle" if mesh.dimension == 2 else "tetra", mesh.simplices)]
    with replacing(path) as part, silenced():
        import meshio

        if ending == ".vtu":
            point_data = {"source": _in_space(mesh.vertices)}
            cell_data = {name: [np.asarray(values, dtype=np.float64)] for name, values in (columns or {}).items()}
            meshio.vtu.write(str(part), meshio.Mesh(_in_space(positions), cells, point_data, cell_data))
        elif ending == ".mesh":
            meshio.medit.write(str(part), meshio.Mesh(_in_space(positions), cells))
        else:
            meshio.gmsh.write(str(part), meshio.Mesh(_in_space(positions), cells), "2.2", binary=True)


def simplex_table_text(columns: Mapping[str, ArrayLike]) -> str:
    """CSV of numbers a simplex: a row a simplex (from 0), a column for each name -> (m,); infinities are `inf`."""
    table = {name: np.asarray(values) for name, values in columns.items()}
    count = len(next(iter(table.values()), ()))
    stacked = np.column_stack([np.arange(count), *table.values()])
    row = "%d" + ",%.17g" * len(table) + "\n"
    return csv_line(["simplex", *table]) + (row * count) % tuple(stacked.ravel().tolist())


def csv_line(cells: Iterable[object]) -> str:
    """One line of CSV; cells with commas or quotes, as formulas have them, are quoted."""
    line = io.StringIO()
    csv.writer(line, lineterminator="\n").writerow(cells)
    return line.getvalue()


def csv_text(rows: Iterable[Mapping[str, Any]]) -> str:
    """CSV with the names of the first row as its header; 17 significant digits; what is not finite or not known stays empty."""
    lines: list[str] = []
    for row in rows:
        if not lines:
            lines.append(csv_line(row))
        lines.append(csv_line(_cell(value) for value in row.values()))
    return "".join(lines)


def _cell(value: Any) -> str:
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return f"{value:.17g}" if math.isfinite(value) else ""
    return str(value)
