"""From a path or a sample to the source that is solved on."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from workbench.core.arrays import Floats, Integers, frozen
from workbench.core.errors import MeshError
from workbench.core.fixes import apply_fixes
from workbench.core.kinds import check_for_kind, resolve_kind, source_for_kind
from workbench.core.load_report import report_lines
from workbench.core.mesh import Mesh
from workbench.core.method import Kind
from workbench.io.file_names import SAMPLE
from workbench.io.mesh_file import MeshFile
from workbench.io.read import read_mesh
from workbench.io.reading_fixes import split_fixes
from workbench.io.start_file import fit_dimension, leads_into_space, map_from_file

__all__ = ["SAMPLE", "OpenedSource", "UnsuitableSourceError", "map_from_file", "open_source", "read_source"]

TETRAHEDRA_IN_DISGUISE = "Its faces have four corners each and seem to be tetrahedra; read them as such, apply --fix tets."


class UnsuitableSourceError(MeshError):
    """A mesh that was read, but does not do for the kind of map; `lines` is its report on load."""

    lines: tuple[str, ...] = ()

    def __reduce__(self) -> tuple[object, ...]:
        return (_rebuild_unsuitable, (self.sentence, self.fixes, self.lines))


def _rebuild_unsuitable(sentence: str, fixes: tuple[str, ...], lines: tuple[str, ...]) -> UnsuitableSourceError:
    error = UnsuitableSourceError(sentence, fixes=fixes)
    error.lines = lines
    return error


@dataclass(frozen=True, eq=False)
class OpenedSource:
    """Everything about a source once it is open.

    Parameters
    ----------
    file : MeshFile                   as read
    mesh : Mesh                       what is solved on: after fixes, two columns for plane
    kind : Kind
    lines : tuple of str              the report on load, then notes of the reader and the fixes
    cut_edges : (k, 2) int64          edges of `mesh` that a fix cut open
    notes : tuple of str              of the reader and the fixes
    start : (n, d) float64            or None
    anchor_vertices : (k,) int64      or None
    anchor_targets : (k, d) float64   or None
    """

    file: MeshFile
    mesh: Mesh
    kind: Kind
    lines: tuple[str, ...]
    cut_edges: Integers
    notes: tuple[str, ...]
    start: Floats | None = field(default=None, repr=False)
    anchor_vertices: Integers | None = field(default=None, repr=False)
    anchor_targets: Floats | None = field(default=None, repr=False)


def open_source(source: str, *, kind: str = "auto", fixes: Sequence[str] = (), tets: bool = False) -> OpenedSource:
    """Opens a file, or `sample:ID`, applies the fixes asked for, and checks it for the kind of map.

    Raises `MeshError`; where the mesh was read but does not do, an `UnsuitableSourceError` with its report and the
    fixes that would help.
    """
    source = str(source)
    reading, others = split_fixes(fixes)
    file = read_source(source, **{"tets": tets, **reading})
    fixed = apply_fixes(file.mesh, others)
    notes = (*file.notes, *fixed.notes)
    lines = (*report_lines(fixed.mesh), *notes)
    try:
        resolved = resolve_kind(fixed.mesh, kind)
        check_for_kind(fixed.mesh, resolved)
    except MeshError as error:
        sentence, helpful = error.sentence, error.fixes
        if "tets" not in reading and not tets and looks_like_tetrahedra(file):
            sentence, helpful = TETRAHEDRA_IN_DISGUISE, ("tets",)
        if fixes:  # those that were asked for stay, or what they mended would be in the way again
            sentence = sentence.replace("--fix ", f"--fix {','.join(fixes)},")
        raise _rebuild_unsuitable(f"{source}: {sentence}", helpful, lines) from None
    mesh = source_for_kind(fixed.mesh, resolved)
    start, anchors, targets, note = _given_map(file, mesh, resolved)
    if note:
        notes, lines = (*notes, note), (*lines, note)
    return OpenedSource(file, mesh, resolved, lines, fixed.cut_edges, notes, start, anchors, targets)


def _given_map(file: MeshFile, mesh: Mesh, kind: Kind) -> tuple[Floats | None, Integers | None, Floats | None, str]:
    """Start and anchors of a case for the mesh that is solved on, and a note where they were left out."""
    if file.start is None and file.anchor_vertices is None:
        return None, None, None, ""
    if mesh.vertex_origin is not None:
        return None, None, None, "The start and the anchors of the case were left out: a fix changed its vertices."
    path = Path(file.path)
    if file.start is not None and kind != "volume" and leads_into_space(file.start, mesh):
        return None, None, None, "The map that the file holds leads into space, and was left out."
    start = None if file.start is None else fit_dimension(path, file.start, mesh, kind)
    targets = file.anchor_targets
    if targets is not None and targets.shape[1] != (3 if kind == "volume" else 2):
        if kind == "volume" or (len(targets) and np.ptp(targets[:, 2]) > 0):
            raise MeshError(f"{path}: its targets have {targets.shape[1]} columns; the kind {kind} needs another number.")
        targets = frozen(targets[:, :2])
    return start, file.anchor_vertices, targets, ""


def read_source(source: str, **options: bool) -> MeshFile:
    """What a file, or `sample:ID`, holds, whatever it may be used for. Raises `MeshError`.

    `options` are those of `read_mesh`.
    """
    return _sample(source.removeprefix(SAMPLE)) if source.startswith(SAMPLE) else read_mesh(source, **options)


def looks_like_tetrahedra(file: MeshFile) -> bool:
    """Whether the faces of four corners of an OBJ seem to be tetrahedra: more than two of them meet in an edge."""
    mesh = file.mesh
    if mesh.polygons is None or file.format != "OBJ" or 2 * (int(mesh.polygons.max()) + 1) != mesh.simplex_count:
        return False
    return bool(len(mesh.topology.nonmanifold_edges))


def _sample(name: str) -> MeshFile:
    from workbench.core.samples import make_sample, sample_ids

    if name not in sample_ids():
        raise MeshError(f"There is no sample {name!r}; there are: {', '.join(sample_ids())}.")
    mesh = make_sample(name)
    digest = hashlib.sha256(mesh.vertices.tobytes() + mesh.simplices.tobytes()).hexdigest()
    return MeshFile(mesh, SAMPLE + name, "sample", digest)
