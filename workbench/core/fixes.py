"""What can be done to a mesh before it is mapped: only what was asked for, in the order asked for."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from workbench.core.arrays import Booleans, Integers, frozen
from workbench.core.cutting import disc_cut
from workbench.core.errors import WorkbenchError
from workbench.core.facets import corner_classes, facet_table, split_vertices
from workbench.core.mesh import Mesh
from workbench.core.nouns import count_of
from workbench.core.orientation import orientation_sheets, simplices_to_flip
from workbench.core.seams import seam_pairs


@dataclass(frozen=True, eq=False)
class FixedMesh:
    """A mesh after its fixes.

    Parameters
    ----------
    mesh : Mesh                  `vertex_origin` tells the vertex of the file wherever a fix changed the vertices
    cut_edges : (k, 2) int64     boundary edges of `mesh` that were inside before: both banks of each cut
    notes : tuple of str         what each fix did, one sentence a fix
    """

    mesh: Mesh
    cut_edges: Integers
    notes: tuple[str, ...]


def apply_fixes(mesh: Mesh, names: Sequence[str]) -> FixedMesh:
    """`mesh` after the named fixes, in their order; one that is not needed changes nothing, and says so.

    Raises `WorkbenchError` for a name that is not in `FIXES`.
    """
    for name in names:
        if name not in FIXES:
            raise WorkbenchError(f"There is no fix {name!r}; there are: {', '.join(FIXES)}.")
    fixed = mesh
    notes = []
    for name in names:
        fixed, note = FIXES[name](fixed)
        notes.append(f"{name}: {note}")
    return FixedMesh(fixed, _cut_edges(mesh, fixed), tuple(notes))


def reorient(mesh: Mesh) -> tuple[Mesh, str]:
    """Turns over the fewer triangles of each component that disagree, and every tetrahedron of negative volume."""
    if mesh.dimension == 3:
        flip = np.zeros(mesh.simplex_count, dtype=bool)
        flip[mesh.topology.negative] = True
    else:
        _, _, sheets = orientation_sheets(facet_table(mesh.simplices), mesh.simplex_count)
        flip = simplices_to_flip(sheets)
    noun = "triangle" if mesh.dimension == 2 else "tetrahedron"
    if not flip.any():
        is_one_sided = mesh.dimension == 2 and not mesh.topology.is_orientable
        return mesh, "the surface is one-sided and cannot be oriented." if is_one_sided else "nothing to turn over."
    return _flipped(mesh, flip), f"{count_of(int(flip.sum()), noun)} turned over."


def largest(mesh: Mesh) -> tuple[Mesh, str]:
    """Keeps the component of most simplices (the first of equals) and the vertices that it uses."""
    topology = mesh.topology
    if topology.component_count == 1:
        return mesh, "there is only one component."
    kept = int(np.bincount(topology.components).argmax())
    smaller = _with_simplices(mesh, np.flatnonzero(topology.components == kept))
    dropped = mesh.simplex_count - smaller.simplex_count
    noun = "triangle" if mesh.dimension == 2 else "tetrahedron"
    return (
        _without_unreferenced(smaller),
        f"the largest of {topology.component_count} components was kept, {count_of(dropped, noun)} dropped.",
    )


def unreferenced(mesh: Mesh) -> tuple[Mesh, str]:
    """Drops the vertices that no simplex uses."""
    count = len(mesh.topology.unreferenced)
    if not count:
        return mesh, "every vertex is used."
    return _without_unreferenced(mesh), f"{count_of(count, 'vertex')} dropped."


def seams(mesh: Mesh) -> tuple[Mesh, str]:
    """Cuts a surface where the texture coordinates of its file jump."""
    if mesh.texture is None:
        return mesh, "the file has no texture coordinates at every corner."
    table = facet_table(mesh.simplices)
    parted = seam_pairs(mesh.texture, table)
    if not parted.any():
        return mesh, "the texture coordinates have no seams."
    return _parted(mesh, parted), f"cut along {count_of(int(parted.sum()), 'seam edge')}."


def cut(mesh: Mesh) -> tuple[Mesh, str]:
    """Cuts each component of a surface open to a disc."""
    if mesh.dimension == 3:
        return mesh, "tetrahedra are not cut."
    if (np.diff(np.sort(mesh.simplices, axis=1), axis=1) == 0).any():
        return mesh, "triangles that name a vertex twice cannot be cut."
    parted = disc_cut(mesh)
    opened = _parted(mesh, parted)
    if opened.vertex_count == mesh.vertex_count:
        return mesh, "there is nothing to cut."
    edges = count_of(int(parted.sum()), "edge")
    return opened, f"cut open along {edges}." if parted.any() else "fans that touched in a vertex were parted."


FIXES: dict[str, Callable[[Mesh], tuple[Mesh, str]]] = {
    "reorient": reorient,
    "largest": largest,
    "unreferenced": unreferenced,
    "seams": seams,
    "cut": cut,
}
"""Every fix by the name that `--fix` knows: a mesh -> the mesh after it, and a sentence."""


def _cut_edges(before: Mesh, after: Mesh) -> Integers:
    """Boundary edges of `after` that come from inner edges of `before`."""
    if before is after or after.dimension == 3 or after.vertex_origin is None:
        return frozen(np.empty((0, 2)), np.int64)
    edges = after.topology.boundary_facets
    base = 1 + int(max(_origin(after).max(), _origin(before).max()))

    def keys(mesh: Mesh) -> Integers:
        ends = np.sort(_origin(mesh)[mesh.topology.boundary_facets], axis=1)
        return np.asarray(ends[:, 0] * base + ends[:, 1])

    return frozen(edges[~np.isin(keys(after), keys(before))], np.int64)


def _origin(mesh: Mesh) -> Integers:
    return np.arange(mesh.vertex_count, dtype=np.int64) if mesh.vertex_origin is None else mesh.vertex_origin


def _flipped(mesh: Mesh, flip: Booleans) -> Mesh:
    """The last two corners of each flipped simplex exchanged, in the texture as well."""

    def exchanged(rows: Integers) -> Integers:
        turned = rows.copy()
        turned[flip, -2], turned[flip, -1] = rows[flip, -1], rows[flip, -2]
        return turned

    texture, given = mesh.texture, mesh.attributes
    return replace(
        mesh,
        simplices=exchanged(mesh.simplices),
        texture=texture and replace(texture, corners=exchanged(texture.corners)),
        attributes=given and replace(given, normal_corners=exchanged(given.normal_corners)),
    )


def _with_simplices(mesh: Mesh, kept: Integers) -> Mesh:
    texture, given = mesh.texture, mesh.attributes
    return replace(
        mesh,
        simplices=mesh.simplices[kept],
        texture=texture and replace(texture, corners=texture.corners[kept]),
        polygons=None if mesh.polygons is None else mesh.polygons[kept],
        attributes=given and replace(given, part=given.part[kept], normal_corners=given.normal_corners[kept]),
    )


def _without_unreferenced(mesh: Mesh) -> Mesh:
    used, simplices = np.unique(mesh.simplices, return_inverse=True)
    return replace(
        mesh,
        vertices=mesh.vertices[used],
        simplices=simplices.reshape(mesh.simplices.shape),
        vertex_origin=_origin(mesh)[used],
    )


def _parted(mesh: Mesh, parted: Booleans) -> Mesh:
    """Vertices split wherever their triangles no longer hang together round them."""
    _, classes = corner_classes(facet_table(mesh.simplices), mesh.simplices.size, ~parted)
    simplices, copied_from = split_vertices(mesh.simplices, mesh.vertex_count, classes)
    if len(copied_from) == mesh.vertex_count:
        return mesh
    return replace(mesh, vertices=mesh.vertices[copied_from], simplices=simplices, vertex_origin=_origin(mesh)[copied_from])
