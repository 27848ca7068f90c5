"""Which kind of map a mesh is for, the source that is solved on, and what stands in the way."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from workbench.core.errors import MeshError
from workbench.core.fixes import apply_fixes
from workbench.core.load_report import first_few
from workbench.core.mesh import Mesh
from workbench.core.method import KINDS, Kind
from workbench.core.nouns import count_of
from workbench.core.plane_frame import is_flat, plane_coordinates


def resolve_kind(mesh: Mesh, kind: str = "auto") -> Kind:
    """The kind of map: the one named, or by the mesh.

    `auto`: tetrahedra -> volume; two columns or one flat plane -> plane; else parameterize.
    Raises `MeshError` where the mesh is of the wrong dimension, or not flat, for the kind named.
    """
    if kind == "auto":
        if mesh.dimension == 3:
            return "volume"
        return "plane" if is_flat(mesh) else "parameterize"
    for known in KINDS:
        if kind == known:
            _check_dimension(mesh, known)
            return known
    raise MeshError(f"There is no kind of map {kind!r}; there are: auto, {', '.join(KINDS)}.")


def source_for_kind(mesh: Mesh, kind: Kind) -> Mesh:
    """The mesh that is solved on: two columns for plane, three otherwise; simplices, seams and origins as they are."""
    _check_dimension(mesh, kind)
    if kind == "plane":
        return mesh if mesh.vertices.shape[1] == 2 else replace(mesh, vertices=plane_coordinates(mesh))
    if mesh.vertices.shape[1] == 2:
        return replace(mesh, vertices=np.column_stack([mesh.vertices, np.zeros(mesh.vertex_count)]))
    return mesh


def check_for_kind(mesh: Mesh, kind: Kind) -> None:
    """Raises `MeshError`, with the fixes that would help, unless maps of this kind can be computed on the mesh."""
    _check_dimension(mesh, kind)
    topology = mesh.topology
    noun = "triangle" if mesh.dimension == 2 else "tetrahedron"
    fault = _first_fault(mesh, kind)
    if fault:
        fixes = helpful_fixes(mesh, kind)
        raise MeshError(f"{fault}{_chart_words(mesh, kind)}; {_advice(fixes)}.", fixes=fixes)
    if len(topology.degenerate):
        without = "area" if mesh.dimension == 2 else "volume"
        raise MeshError(
            f"The source has {count_of(len(topology.degenerate), noun)} without {without} "
            f"({first_few(topology.degenerate)}, from 0), where a map has no Jacobian: "
            f"collapse or remove such places in a mesh editor."
        )


def helpful_fixes(mesh: Mesh, kind: Kind) -> tuple[str, ...]:
    """The fixes after which `mesh` would do, in the order to apply them; empty where none would do.

    They are found by trying. Where the seams of the file would do as well as a cut, both are named:
    either alone is enough, and both together do no harm.
    """
    names: list[str] = []
    fixed = mesh

    def attempt(name: str) -> None:
        nonlocal fixed
        changed = apply_fixes(fixed, (name,)).mesh
        if changed is not fixed:
            names.append(name)
            fixed = changed

    if kind != "parameterize":
        attempt("unreferenced")
        return () if _first_fault(fixed, kind) else tuple(names)
    if mesh.topology.component_count > 1:
        attempt("largest")  # its unused vertices go, too
    else:
        attempt("unreferenced")
    if fixed.topology.is_orientable:
        attempt("reorient")
    if not fixed.topology.is_disc:
        seamed = apply_fixes(fixed, ("seams",)).mesh
        if seamed.topology.is_disc and not _first_fault(seamed, kind):
            return (*names, "seams", "cut")
        attempt("cut")
        attempt("largest")
        attempt("reorient")
    return () if _first_fault(fixed, kind) or len(fixed.topology.degenerate) else tuple(names)


def _advice(fixes: tuple[str, ...]) -> str:
    if not fixes:
        return "none of the fixes offered here helps, so mend it in a mesh editor"
    if fixes[-2:] == ("seams", "cut"):
        along_seams = ",".join(fixes[:-1])
        other = ",".join((*fixes[:-2], "cut"))
        return f"apply --fix {along_seams} (cut along the texture seams) or --fix {other}"
    return f"apply --fix {','.join(fixes)}"


def _chart_words(mesh: Mesh, kind: Kind) -> str:
    """A clause on why the texture coordinates of the file are not the way out; empty where they have one chart or none."""
    if kind != "parameterize" or mesh.texture is None or mesh.topology.component_count > 1:
        return ""
    charts = apply_fixes(mesh, ("seams",)).mesh.topology.component_count
    return f" (its texture coordinates fall into {charts} charts, and one is mapped at a time)" if charts > 1 else ""


def _first_fault(mesh: Mesh, kind: Kind) -> str:
    """A clause on the first thing in the way that a fix might mend; empty where there is none."""
    checks = [_unreferenced_fault]
    if kind == "parameterize":
        checks += [_nonmanifold_fault, _component_fault, _orientation_fault, _disc_fault]
    return next((fault for check in checks if (fault := check(mesh))), "")


def _unreferenced_fault(mesh: Mesh) -> str:
    count = len(mesh.topology.unreferenced)
    if not count:
        return ""
    noun = "triangle" if mesh.dimension == 2 else "tetrahedron"
    verb = "is" if count == 1 else "are"
    return (
        f"{count_of(count, 'vertex')} {verb} in no {noun} ({first_few(mesh.topology.unreferenced)}, from 0): "
        f"the file may be cut short, or the points are left over"
    )


def _nonmanifold_fault(mesh: Mesh) -> str:
    topology = mesh.topology
    if len(topology.nonmanifold_edges):
        tail, head = topology.nonmanifold_edges[0]
        more = len(topology.nonmanifold_edges) - 1
        others = f", and so have {more} others" if more > 1 else ", and so has 1 other" if more else ""
        return (
            f"The edge between vertices {tail} and {head} (from 0) has more than two triangles{others}: "
            f"only a manifold surface can be flattened"
        )
    if len(topology.nonmanifold_vertices):
        return (
            f"At vertex {first_few(topology.nonmanifold_vertices)} (from 0) several fans of triangles touch: "
            f"only a manifold surface can be flattened"
        )
    return ""


def _component_fault(mesh: Mesh) -> str:
    count = mesh.topology.component_count
    return f"The surface has {count} components, and a parameterization takes one" if count > 1 else ""


def _orientation_fault(mesh: Mesh) -> str:
    if not mesh.topology.is_orientable:
        return "The surface is one-sided (not orientable), and a parameterization takes a disc"
    if not mesh.topology.is_consistently_oriented:
        return "The triangles do not agree on an orientation: some neighbours run against each other"
    return ""


def _disc_fault(mesh: Mesh) -> str:
    topology = mesh.topology
    if topology.is_disc:
        return ""
    loops = len(topology.boundary_loops)
    if not loops:
        return f"The surface is closed (genus {topology.genus}), and a parameterization takes a disc"
    handles = f"genus {topology.genus} and " if topology.genus else ""
    return f"The surface has {handles}{count_of(loops, 'boundary loop')}, and a parameterization takes a disc"


def _check_dimension(mesh: Mesh, kind: Kind) -> None:
    if kind == "volume" and mesh.dimension == 2:
        raise MeshError("A volume map needs tetrahedra, and these are triangles; use --map plane or parameterize.")
    if kind != "volume" and mesh.dimension == 3:
        raise MeshError(f"The kind {kind} needs triangles, and these are tetrahedra; use --map volume.")
    if kind == "plane" and not is_flat(mesh):
        raise MeshError("The surface is not flat, and the kind plane needs a flat one; use --map parameterize.")
