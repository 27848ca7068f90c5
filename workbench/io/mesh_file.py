"""What a file held."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from workbench.core.arrays import Floats, Integers, frozen
from workbench.core.errors import MeshError
from workbench.core.mesh import FaceAttributes, Mesh, TextureCoordinates
from workbench.io.text import shown_name

LARGEST_COORDINATE = 1e70
"""Beyond this, products of four lengths leave the range of double precision."""

SMALLEST_DIAMETER = 1e-70


@dataclass(frozen=True, eq=False)
class MeshFile:
    """A mesh as its file has it, and what else the file says about a map of it.

    Parameters
    ----------
    mesh : Mesh
    path : str                       file, or `sample:ID`
    format : str                     for people: OBJ, case, Gmsh ...
    sha256 : str                     of the bytes of the file
    start : (n, 2|3) float64         positions to begin from (`X0`, else `X`, of a case), or None
    map_positions : (n, 2|3) float64 positions of the map (`X`, else `X0`, of a case), or None
    anchor_vertices : (k,) int64     or None
    anchor_targets : (k, 2|3) float64   or None
    notes : tuple of str             what was left out or taken for granted while reading
    """

    mesh: Mesh
    path: str
    format: str
    sha256: str
    start: Floats | None = field(default=None, repr=False)
    map_positions: Floats | None = field(default=None, repr=False)
    anchor_vertices: Integers | None = field(default=None, repr=False)
    anchor_targets: Floats | None = field(default=None, repr=False)
    notes: tuple[str, ...] = ()


def mesh_of_file(
    path: Path,
    vertices: Floats,
    simplices: Integers,
    *,
    texture: TextureCoordinates | None = None,
    polygons: Integers | None = None,
    attributes: FaceAttributes | None = None,
) -> Mesh:
    """A mesh of vertices (n, 2|3) and simplices (m, 3|4), named as its file; `MeshError` names it for what does not fit."""
    vertices = np.asarray(vertices, dtype=np.float64)
    try:
        mesh = Mesh(vertices, simplices, shown_name(path.name), texture, polygons, attributes=attributes)
    except MeshError as error:
        raise MeshError(f"{path}: {error.sentence}") from None
    check_range(path, vertices)
    if not float(np.ptp(vertices, axis=0).max()) > SMALLEST_DIAMETER:
        raise MeshError(f"{path}: all vertices are at the same place (to {SMALLEST_DIAMETER:g}); scale or mend it.")
    return mesh


def check_range(path: Path, vertices: Floats) -> None:
    """Raises `MeshError` for coordinates (n, 2|3) too large to compute with."""
    too_large = np.abs(vertices) > LARGEST_COORDINATE
    if too_large.any():
        row = int(np.flatnonzero(too_large.any(axis=1))[0])
        raise MeshError(
            f"{path}: vertex {row} (from 0) has a coordinate beyond {LARGEST_COORDINATE:g}, too large to compute with; "
            f"mend it, or scale the mesh."
        )


def finite_rows(path: Path, name: str, values: object, rows: int | None, columns: tuple[int, ...]) -> Floats:
    """`values` as a finite float64 array with a row an item; `MeshError` says which array of the file does not fit."""
    array = np.asarray(values)
    if array.dtype.kind not in "fiu":
        raise MeshError(f"{path}: the array {name} does not hold numbers.")
    if array.ndim != 2 or array.shape[1] not in columns or rows not in (None, len(array)):
        wanted = f"({'any' if rows is None else rows}, {' or '.join(map(str, columns))})"
        raise MeshError(f"{path}: the array {name} has shape {array.shape}; {wanted} is needed.")
    array = array.astype(np.float64)
    if not np.isfinite(array).all():
        row = int(np.flatnonzero(~np.isfinite(array).all(axis=1))[0])
        raise MeshError(f"{path}: row {row} (from 0) of the array {name} has a number that is not finite; mend it.")
    return frozen(array)


def whole_numbers(path: Path, name: str, values: object) -> Integers:
    """`values` as int64; `MeshError` where they are not whole numbers."""
    array = np.asarray(values)
    if array.dtype.kind not in "fiu":
        raise MeshError(f"{path}: the array {name} does not hold numbers.")
    if array.dtype.kind == "f" and not (np.isfinite(array).all() and (array == np.round(array)).all()):
        raise MeshError(f"{path}: the array {name} holds numbers that are not whole; indices are needed.")
    if array.size and float(np.abs(array.astype(np.float64)).max()) >= 2**62:
        raise MeshError(f"{path}: the array {name} holds indices that are too large.")
    return frozen(array, np.int64)
