"""Source and map out of a file as they stand there, and back into one after refinement."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.errors import WorkbenchError
from workbench.core.fixes import apply_fixes
from workbench.core.kinds import resolve_kind, source_for_kind
from workbench.core.mesh import Mesh, TextureCoordinates
from workbench.core.method import Kind
from workbench.core.refine import Refined
from workbench.io.mesh_file import MeshFile
from workbench.io.opening import read_source
from workbench.io.reading_fixes import split_fixes
from workbench.io.start_file import fit_dimension, map_from_file
from workbench.io.write import write_case, write_map, write_mesh

REFINED_ENDINGS = (".obj", ".npz", ".vtu", ".mesh", ".msh")
"""Endings of the files that a refined mesh is written to."""
MESH_ALONE = (".mesh", ".msh")


@dataclass(frozen=True, eq=False)
class Refinable:
    """A mesh with the map of it that its file, or a second one, holds.

    Parameters
    ----------
    file : MeshFile
    mesh : Mesh                       after fixes, in the coordinates of the file
    kind : Kind                       of map
    positions : (n, 2|3) float64      the map of the vertices, or None: then the texture coordinates of `mesh`, if any
    start : (n, 2|3) float64          `X0` of a case that has `X` as well, or None
    anchor_vertices, anchor_targets : (k,) int64, (k, d) float64     of a case, or None
    notes : tuple of str              what was left out or taken for granted
    """

    file: MeshFile
    mesh: Mesh
    kind: Kind
    positions: Floats | None = None
    start: Floats | None = None
    anchor_vertices: Integers | None = None
    anchor_targets: Floats | None = None
    notes: tuple[str, ...] = field(default=())

    @property
    def has_map(self) -> bool:
        return self.positions is not None or self.mesh.texture is not None

    @property
    def columns(self) -> Floats | None:
        """Map and start side by side, to be refined at once; None where there is neither."""
        given = [array for array in (self.positions, self.start) if array is not None]
        return np.concatenate(given, axis=1) if given else None

    def to_measure(self) -> tuple[Mesh, Floats | None]:
        """Source and map with the columns that measures need. Raises `MeshError` for a map that is not flat."""
        mesh = source_for_kind(self.mesh, self.kind)
        if self.positions is None:
            return mesh, None
        return mesh, fit_dimension(Path(self.file.path), self.positions, mesh, self.kind)


def open_refinable(
    source: str, target: str | None = None, *, kind: str = "auto", fixes: Sequence[str] = (), tets: bool = False
) -> Refinable:
    """Reads a mesh, or `sample:ID`, with its map: that of the file `target`, else X of a case, else texture coordinates.

    Raises `WorkbenchError` for what cannot be read, or a target that does not fit.
    """
    reading, others = split_fixes(fixes)
    file = read_source(source, **{"tets": tets, **reading})
    fixed = apply_fixes(file.mesh, others)
    mesh, notes = fixed.mesh, [*file.notes, *fixed.notes]
    resolved = resolve_kind(mesh, kind)
    if mesh.polygons is not None:
        notes.append("The polygons of the file are refined as the triangles that they were fanned into.")
    origin = mesh.vertex_origin
    anchors, targets = file.anchor_vertices, file.anchor_targets
    if origin is not None and anchors is not None:
        anchors = targets = None
        notes.append("The anchors of the case were left out: a fix changed its vertices.")
    if target is not None:
        given = map_from_file(target, source_for_kind(mesh, resolved), resolved)
        return Refinable(file, replace(mesh, texture=None), resolved, given, None, anchors, targets, tuple(notes))
    positions, start = file.map_positions, file.start
    if start is positions:
        start = None
    if origin is not None:
        positions, start = (None if array is None else array[origin] for array in (positions, start))
    return Refinable(file, mesh, resolved, positions, start, anchors, targets, tuple(notes))


def check_refined_place(path: str | os.PathLike[str], given: Refinable) -> None:
    """Raises `WorkbenchError` where the format of `path` cannot hold what was read."""
    ending = Path(path).suffix.lower()
    if ending not in REFINED_ENDINGS:
        raise WorkbenchError(f"{path}: refinements are written as {', '.join(REFINED_ENDINGS)}; choose one of these endings.")
    if ending == ".obj" and given.positions is not None and given.positions.shape[1] != 2:
        raise WorkbenchError(f"{path}: OBJ holds no source beside a map into space; write .npz or .vtu.")
    if ending in MESH_ALONE and given.has_map:
        raise WorkbenchError(f"{path}: this format holds no map beside the mesh; write .npz or .vtu.")


def write_refined(path: str | os.PathLike[str], given: Refinable, refined: Refined) -> tuple[str, ...]:
    """Writes a refined source with its map; the file is whole or not there.

    OBJ: the source as `v`, a map to the plane as `vt`, with its seams. npz: `V S`, the map as `X`, the start as `X0`, the
    anchors, whose vertices keep their numbers. VTU: the source and the map. MEDIT and Gmsh: the mesh of a file
    that holds no map.

    Parameters
    ----------
    refined : Refined      of `given.mesh` and `given.columns`

    Returns notes on what the format could not hold. Raises `WorkbenchError` where the file cannot be written.
    """
    check_refined_place(path, given)
    mesh, positions, start = refined.mesh, None, None
    if refined.positions is not None and given.positions is not None:
        width = given.positions.shape[1]
        positions, start = refined.positions[:, :width], refined.positions[:, width:]
    ending = Path(path).suffix.lower()
    lost = ending != ".npz" and given.anchor_vertices is not None
    notes: tuple[str, ...] = ("The anchors are not in the file: only .npz holds them.",) if lost else ()
    if ending == ".obj":
        if positions is not None:
            mesh = replace(mesh, texture=TextureCoordinates(positions, mesh.simplices))
        write_mesh(path, mesh)
        return notes
    if positions is None and mesh.texture is not None:
        mesh, positions, cut = _texture_as_map(mesh)
        notes += cut
    if ending in (".vtu", *MESH_ALONE):
        write_map(path, mesh, mesh, mesh.vertices if positions is None else positions, given.kind)
        return notes
    arrays = {"V": mesh.vertices, "S": mesh.simplices}
    if positions is not None:
        arrays["X"] = positions
    if start is not None and start.shape[1]:
        arrays["X0"] = start
    if given.anchor_vertices is not None and given.anchor_targets is not None:
        arrays |= {"anchors": given.anchor_vertices, "targets": given.anchor_targets}
    write_case(path, arrays)
    return notes


def _texture_as_map(mesh: Mesh) -> tuple[Mesh, Floats, tuple[str, ...]]:
    """The mesh cut along its texture seams, the coordinates at its vertices, and a note where a cut was needed."""
    assert mesh.texture is not None
    cut = apply_fixes(mesh, ("seams",)).mesh
    assert cut.texture is not None
    positions = np.zeros((cut.vertex_count, 2))
    positions[cut.simplices.ravel()] = cut.texture.coordinates[cut.texture.corners.ravel()]
    was_cut = cut.vertex_count > mesh.vertex_count
    return cut, positions, ("The mesh was cut along its texture seams: this format has one place a vertex.",) * was_cut
