"""A mesh that a notebook has opened, with the map that its file holds."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from workbench.core.arrays import Floats
from workbench.core.constraints import Anchors
from workbench.core.distortion import Distortion
from workbench.core.errors import MeshError, WorkbenchError
from workbench.core.kinds import check_for_kind, resolve_kind, source_for_kind
from workbench.core.load_report import report_lines
from workbench.core.mesh import Mesh
from workbench.core.method import Kind
from workbench.core.problem import Problem
from workbench.engine.starts import adjusted_start
from workbench.io.mesh_file import MeshFile
from workbench.io.opening import OpenedSource, map_from_file, open_source
from workbench.notebook.pictures import WithPicture, html_page, picture_of
from workbench.notebook.wording import in_words_of_scripts

AnchorsGiven = Anchors | Mapping[int, Sequence[float]] | tuple[ArrayLike, ArrayLike] | str | os.PathLike[str] | None
"""Anchors, vertex -> target, (vertices (k,), targets (k, d)), or a CSV file; None: those that come with the mesh."""


@dataclass(frozen=True, eq=False)
class Source(WithPicture):
    """A mesh that can be solved on, as `load` opened it.

    `opened` is all that is known of it; see the properties for what is wanted often.
    """

    opened: OpenedSource

    @property
    def path(self) -> str:
        """The file, or `sample:ID`; empty for a mesh that was made."""
        return self.opened.file.path

    @property
    def mesh(self) -> Mesh:
        """What is solved on: after fixes, with two columns for plane figures."""
        return self.opened.mesh

    @property
    def kind(self) -> Kind:
        """Kind of map: plane, parameterize or volume."""
        return self.opened.kind

    @property
    def notes(self) -> tuple[str, ...]:
        """What the reader and the fixes have to say."""
        return self.opened.notes

    @property
    def start(self) -> Floats | None:
        """(n, d) float64 to begin from, where a case has it."""
        return self.opened.start

    @property
    def anchors(self) -> Anchors:
        """The anchors that come with a case; none otherwise."""
        vertices, targets = self.opened.anchor_vertices, self.opened.anchor_targets
        return Anchors.none(self.mesh.dimension) if vertices is None or targets is None else Anchors(vertices, targets)

    @cached_property
    def map(self) -> Floats | None:
        """(n, d) float64, the map that the file holds: texture coordinates, or `X` of a case; None where there is none.

        One that is mirrored as a whole is reflected.
        """
        file = self.opened.file
        if file.map_positions is None and (file.mesh.texture is None or self.kind == "volume"):
            return None
        try:
            positions = map_from_file(self.path, self.mesh, self.kind)
        except MeshError:
            return None  # seams that are not cut, or a map into space
        return adjusted_start(self.mesh, self.kind, positions, match_area=False)

    def problem(
        self,
        distortion: str | Distortion = "symmetric-dirichlet",
        anchors: AnchorsGiven = None,
        *,
        parameters: Mapping[str, float] | None = None,
        allow_inversions: bool = False,
    ) -> Problem:
        """A problem on this mesh: `distortion` is an id or a formula, with `parameters` by name.

        Raises `WorkbenchError` for what does not fit.
        """
        chosen = anchors_given(anchors, self)
        if isinstance(chosen, str):
            raise WorkbenchError("Anchors in a file are read by solve(); give them as {vertex: target} here.")
        if isinstance(distortion, str):
            distortion = Distortion.resolve(distortion, parameters)
        elif parameters:
            distortion = distortion.with_values(parameters)
        held = self.anchors if chosen is None else chosen
        return Problem.create(self.mesh, self.kind, distortion, held, allow_inversions=allow_inversions)

    def __repr__(self) -> str:
        mesh = self.mesh
        parts = [self.path or mesh.name or "mesh", f"{mesh.vertex_count:,} vertices"]
        parts += [f"{mesh.simplex_count:,} {mesh.simplex_noun(mesh.simplex_count)}", f"kind {self.kind}"]
        if len(self.anchors.vertices):
            parts.append(f"{len(self.anchors.vertices)} anchors")
        if self.map is not None:
            parts.append("with a map")
        return f"<Source {', '.join(parts)}>"

    @cached_property
    def png(self) -> bytes:
        """A picture: of the mesh, and of the map in the colours of (32) where the file holds one."""
        return picture_of(self.mesh, self.map, anchors=self.anchors.vertices)

    def _repr_html_(self) -> str:
        rows = [("mesh", self.path or self.mesh.name), ("kind", self.kind), ("vertices", f"{self.mesh.vertex_count:,}")]
        rows.append((self.mesh.simplex_noun(2), f"{self.mesh.simplex_count:,}"))
        rows += [("anchors", str(len(self.anchors.vertices))), ("map in the file", "no" if self.map is None else "yes")]
        return html_page(self.png, rows, self.notes)


@in_words_of_scripts
def load(path: str | os.PathLike[str], *, kind: str = "auto", fixes: Sequence[str] = (), tets: bool = False) -> Source:
    """A mesh file, a case, or `sample:ID`, opened as `workbench solve` opens it.

    Parameters
    ----------
    kind : str     auto, plane, parameterize or volume
    fixes          reorient, largest, unreferenced, seams, cut, linearise, tets: done in this order, and none unasked
    tets : bool    read faces of four corners as tetrahedra

    Raises `MeshError` for what cannot be used, with the fixes that would help.
    """
    if not isinstance(path, str | os.PathLike):
        raise MeshError(
            f"{type(path).__name__} is no mesh; give a file, sample:ID, Mesh(vertices, simplices), or what load() returned."
        )
    if isinstance(fixes, str):
        fixes = tuple(name.strip() for name in fixes.split(",") if name.strip())
    return Source(open_source(os.fspath(path), kind=kind, fixes=fixes, tets=tets))


def source_of(given: Source | Mesh | str | os.PathLike[str], kind: str = "auto", fixes: Sequence[str] = ()) -> Source:
    """What was opened already, a mesh that was made, or a file. Raises `MeshError` for what does not do for the kind."""
    if isinstance(given, Source):
        return given
    if not isinstance(given, Mesh):
        return load(given, kind=kind, fixes=fixes)
    resolved = resolve_kind(given, kind)
    check_for_kind(given, resolved)
    return Source(_opened(given, source_for_kind(given, resolved), resolved))


def source_of_problem(problem: Problem) -> Source:
    """The mesh of a problem, which does for it as it is."""
    return Source(_opened(problem.mesh, problem.mesh, problem.kind))


def _opened(given: Mesh, mesh: Mesh, kind: Kind) -> OpenedSource:
    lines = tuple(report_lines(given))
    return OpenedSource(MeshFile(given, "", "mesh", ""), mesh, kind, lines, np.empty((0, 2), dtype=np.int64), ())


def anchors_given(given: AnchorsGiven, source: Source) -> Anchors | str | None:
    """Anchors in one of the forms of `AnchorsGiven`; a file stays its name. Raises `WorkbenchError` where they do not fit."""
    if given is None or isinstance(given, Anchors):
        return given
    if isinstance(given, str | os.PathLike):
        return os.fspath(given)
    dimension = source.mesh.dimension
    vertices, targets = (list(given.keys()), list(given.values())) if isinstance(given, Mapping) else given
    numbers = np.asarray(vertices).reshape(-1)
    if len(numbers) and not np.issubdtype(numbers.dtype, np.integer):
        raise WorkbenchError("Anchors: vertices are whole numbers from 0 on.")
    try:
        places = np.asarray(targets, dtype=np.float64).reshape(len(numbers), -1 if len(numbers) else dimension)
    except ValueError:
        raise WorkbenchError(f"Anchors: {len(numbers)} vertices need a row of {dimension} numbers each.") from None
    anchors = Anchors(numbers.astype(np.int64), places)
    anchors.check(source.mesh.vertex_count, dimension)
    return anchors
