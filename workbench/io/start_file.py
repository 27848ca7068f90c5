"""A map from a file: texture coordinates, positions, or the X of a case, put on the vertices of a mesh."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from workbench.core.arrays import Floats, Integers, frozen
from workbench.core.errors import MeshError
from workbench.core.mesh import Mesh
from workbench.core.method import Kind
from workbench.core.plane_frame import is_flat, plane_coordinates
from workbench.io.cases import mat_arrays, npz_arrays
from workbench.io.mesh_file import MeshFile, check_range, finite_rows
from workbench.io.read import read_bytes, read_mesh

SAME_PLACE = 1e-9
"""Vertices of two files are the same when they are nearer than this part of the diameter."""


def map_from_file(path: str | os.PathLike[str], mesh: Mesh, kind: Kind) -> Floats:
    """Positions of the vertices of `mesh`, from a file that holds a map of it.

    A case gives `X`, else `X0`, else `V`; an OBJ of a surface its texture coordinates; everything else its vertices.
    For plane, texture coordinates count where the vertices of the file are those of the mesh (then they are the
    source, and the map has to be elsewhere). The file may be of the mesh as it was before `fixes`: `vertex_origin`
    leads to its vertices, and texture coordinates are matched corner by corner.

    Parameters
    ----------
    mesh : Mesh      the source that is solved on

    Returns
    -------
    (n, 2|3) float64

    Raises `MeshError` where the file does not fit the mesh: what differs, and what to do.
    """
    return fit_dimension(Path(path), positions_in_file(path, mesh, kind), mesh, kind)


def positions_in_file(path: str | os.PathLike[str], mesh: Mesh, kind: Kind) -> Floats:
    """As `map_from_file`, with as many columns as the file has."""
    path = Path(path)
    bare = _bare_positions(path)
    if bare is not None:
        return _on_vertices(path, bare, mesh)
    found = read_mesh(path, tets=kind == "volume", linearise=True)
    if found.map_positions is not None:
        return _on_vertices(path, found.map_positions, mesh)
    if kind != "volume" and found.mesh.texture is not None and (kind == "parameterize" or _same_places(found, mesh)):
        return _texture_on_vertices(path, found.mesh, mesh)
    return _on_vertices(path, found.mesh.vertices, mesh)


def leads_into_space(positions: Floats, mesh: Mesh) -> bool:
    """Whether positions (n, 2|3) of the vertices of a surface lie in no plane."""
    return mesh.dimension == 2 and positions.shape[1] == 3 and not is_flat(Mesh(positions, mesh.simplices))


def fit_dimension(path: Path, positions: Floats, mesh: Mesh, kind: Kind) -> Floats:
    """`positions` (n, 2|3) with as many columns as maps of this kind have; flat ones in space lose their plane.

    In a tilted plane the side seen is that from which most of the area is positively oriented.
    """
    columns = 3 if kind == "volume" else 2
    if positions.shape[1] == columns:
        return frozen(positions)
    if columns == 3:
        raise MeshError(f"{path}: a map of a volume needs positions with three columns; these have two.")
    if leads_into_space(positions, mesh):
        raise MeshError(f"{path}: its positions are not flat, so they are no map to the plane; name a file of one.")
    return frozen(plane_coordinates(Mesh(positions, mesh.simplices)))


def _bare_positions(path: Path) -> Floats | None:
    """Positions of a case file that has no mesh with them."""
    ending = path.suffix.lower()
    if ending not in (".npz", ".mat"):
        return None
    arrays = npz_arrays(path, read_bytes(path)) if ending == ".npz" else mat_arrays(path, read_bytes(path))
    if {"S", "F", "T"} & set(arrays):
        return None
    name = next((name for name in ("X", "X0", "fV", "V") if name in arrays), "")
    if not name:
        raise MeshError(f"{path}: no positions were found in it (arrays X, X0, fV or V); name a file that holds a map.")
    positions = finite_rows(path, name, arrays[name], None, (2, 3))
    check_range(path, positions)
    return positions


def _on_vertices(path: Path, positions: Floats, mesh: Mesh) -> Floats:
    """Rows of the file for the vertices of the mesh: one to one, or through `vertex_origin`."""
    if len(positions) == mesh.vertex_count:
        return positions
    origin = mesh.vertex_origin
    if origin is not None and len(positions) > int(origin.max()):
        return positions[origin]
    raise MeshError(
        f"{path}: it has {len(positions)} positions, but the source has {mesh.vertex_count} vertices; "
        f"name a file of the same mesh, with the same fixes."
    )


def _same_places(found: MeshFile, mesh: Mesh) -> bool:
    vertices = found.mesh.vertices
    origin = mesh.vertex_origin
    if origin is not None and len(vertices) != mesh.vertex_count and len(vertices) > int(origin.max()):
        vertices = vertices[origin]
    if len(vertices) != mesh.vertex_count or not is_flat(found.mesh):
        return False
    if vertices.shape[1] == 3:
        flat = plane_coordinates(found.mesh)
        vertices = flat if len(flat) == mesh.vertex_count or origin is None else flat[origin]
    return bool(np.abs(vertices - mesh.vertices[:, :2]).max() <= SAME_PLACE * mesh.diameter)


def _texture_on_vertices(path: Path, file_mesh: Mesh, mesh: Mesh) -> Floats:
    """Texture coordinates of the file at the corners of the mesh, which have to agree at every vertex."""
    assert file_mesh.texture is not None
    rows, corner_order = _matching_rows(path, file_mesh, mesh)
    texture_corners = np.take_along_axis(file_mesh.texture.corners[rows], corner_order, axis=1)
    values = file_mesh.texture.coordinates[texture_corners.ravel()]
    corners = mesh.simplices.ravel()
    positions = np.full((mesh.vertex_count, 2), np.nan)
    positions[corners] = values
    differs = (positions[corners] != values).any(axis=1)
    if differs.any():
        vertex = int(corners[int(differs.argmax())])
        raise MeshError(
            f"{path}: its texture coordinates have a seam at vertex {vertex} (from 0), where the source has none; "
            f"cut the source along it with --fix seams.",
            fixes=("seams",),
        )
    check_range(path, positions)
    return frozen(positions)


def _matching_rows(path: Path, file_mesh: Mesh, mesh: Mesh) -> tuple[Integers, Integers]:
    """Triangle of the file for each of the mesh, (m,), and its corner for each corner, (m, 3)."""
    candidates = [mesh.simplices]
    if mesh.vertex_origin is not None:
        candidates.insert(0, mesh.vertex_origin[mesh.simplices])
    for wanted in candidates:
        found = _rows_of(file_mesh.simplices, wanted)
        if found is not None:
            order_there = np.argsort(file_mesh.simplices[found], axis=1, kind="stable")
            rank_here = np.argsort(np.argsort(wanted, axis=1, kind="stable"), axis=1, kind="stable")
            return found, np.take_along_axis(order_there, rank_here, axis=1)
    raise MeshError(
        f"{path}: its triangles are not those of the source, so its texture coordinates cannot be placed; "
        f"name a file of the same mesh."
    )


def _rows_of(table: Integers, wanted: Integers) -> Integers | None:
    """Row of `table` with the same vertices as each row of `wanted`; None where one is missing.

    Repeated rows are used one after another, in their order.
    """
    if len(wanted) == len(table) and np.array_equal(np.sort(table, axis=1), np.sort(wanted, axis=1)):
        return np.arange(len(wanted))
    both, number = np.unique(np.sort(np.concatenate([table, wanted]), axis=1), axis=0, return_inverse=True)
    number = number.reshape(-1)
    row = np.full(len(both), -1, dtype=np.int64)
    row[number[: len(table)]] = np.arange(len(table))
    result = row[number[len(table) :]]
    return None if (result < 0).any() else result
