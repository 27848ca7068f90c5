"""A mesh and a map of it, refined together."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from workbench.core.arrays import Floats, Integers, frozen
from workbench.core.errors import MeshError, WorkbenchError
from workbench.core.facets import corner_classes, facet_table
from workbench.core.mesh import Mesh, TextureCoordinates
from workbench.core.refine.catmull_clark import catmull_clark_step, split_quadrilaterals
from workbench.core.refine.linear import halve_tetrahedra, halve_triangles
from workbench.core.refine.loop import loop_step
from workbench.core.seams import seam_pairs

SCHEMES = {"linear": "linear", "loop": "Loop", "catmull-clark": "Catmull-Clark"}
"""Ids of the schemes, and what people call them."""

MOST_SIMPLICES = 50_000_000
"""A refinement beyond it is refused before it costs memory."""


@dataclass(frozen=True, eq=False)
class Refined:
    """A refined source, its map where there was one, and how they came about.

    The first vertices are those of the mesh before, in their order: anchors keep their numbers.
    `positions` : (n, columns) float64, or None
    """

    mesh: Mesh
    positions: Floats | None
    scheme: str
    levels: int


def refine(mesh: Mesh, positions: ArrayLike | None = None, scheme: str = "linear", levels: int = 1) -> Refined:
    """Refine a source and a map of it by the same scheme, so that their simplices correspond.

    `linear` halves every edge and keeps the shape, so that every energy stays (Theorem 9.1); `loop` and `catmull-clark`
    smooth source and map alike, the boundary to a curve of its own. Catmull-Clark splits its quadrilaterals into triangles
    after each level, as in Fig. 20. Texture coordinates are refined as a mesh of their own, whose seams are
    its boundary, while the surface has none there. Orientation stays. The polygons that triangles were fanned from do not.

    Parameters
    ----------
    positions : (n, columns) float64      of the vertices, any number of columns: each is refined for itself
    scheme : str                          one of `SCHEMES`; tetrahedra take `linear` only
    levels : int                          from 0 on

    Raises `MeshError` for a scheme that the mesh does not allow, `WorkbenchError` for one that there is not, and for a result
    of more than `MOST_SIMPLICES`.
    """
    return deque(refined_levels(mesh, positions, scheme, levels), maxlen=1).pop()


def refined_levels(
    mesh: Mesh, positions: ArrayLike | None = None, scheme: str = "linear", levels: int = 1
) -> Iterator[Refined]:
    """The mesh as it is, and a map (n, d) where there is one, then after each level; see `refine`."""
    check_refinement(mesh, scheme, levels)
    given = None if positions is None else frozen(positions)
    if given is not None and (given.ndim != 2 or len(given) != mesh.vertex_count):
        raise WorkbenchError(f"The map has shape {given.shape}; a row for each of the {mesh.vertex_count} vertices is needed.")
    yield Refined(mesh, given, scheme, 0)
    width = mesh.vertices.shape[1]
    columns = mesh.vertices if given is None else np.concatenate([mesh.vertices, given], axis=1)
    surface = _walk(mesh.simplices, columns, scheme, levels)
    texture = iter(()) if mesh.texture is None else _walk(*_texture_mesh(mesh, mesh.texture), scheme, levels)
    for level, (simplices, points) in enumerate(surface, start=1):
        corners = next(texture, None)
        refined = Mesh(
            points[:, :width],
            simplices,
            mesh.name,
            None if corners is None else TextureCoordinates(corners[1], corners[0]),
        )
        yield Refined(refined, None if given is None else frozen(points[:, width:]), scheme, level)


def refined_count(mesh: Mesh, scheme: str, levels: int) -> int:
    """Simplices after so many levels."""
    children = 6 if scheme == "catmull-clark" else 8 if mesh.dimension == 3 else 4
    return mesh.simplex_count * children**levels


def check_refinement(mesh: Mesh, scheme: str, levels: int) -> None:
    """Raises what `refine` would, but for edges of more than two triangles."""
    if scheme not in SCHEMES:
        raise WorkbenchError(f"There is no scheme {scheme!r}; there are: {', '.join(SCHEMES)}.")
    if mesh.dimension == 3 and scheme != "linear":
        raise MeshError(f"The scheme {scheme} refines triangles, and these are tetrahedra; use the scheme linear.")
    if levels < 0:
        raise WorkbenchError(f"{levels} levels were asked for; 0 is the least.")
    most = 0
    while most < levels and refined_count(mesh, scheme, most + 1) <= MOST_SIMPLICES:
        most += 1
    if levels > most:
        noun = "triangles" if mesh.dimension == 2 else "tetrahedra"
        raise WorkbenchError(
            f"After {levels} levels {mesh.simplex_count} {noun} would be more than {MOST_SIMPLICES // 10**6} million; "
            f"take {most} level{'s' * (most != 1)} at most."
        )


def _walk(cells: Integers, points: Floats, scheme: str, levels: int) -> Iterator[tuple[Integers, Floats]]:
    """Simplices and points after each level; columns beyond the third do not count for the shape of tetrahedra."""
    is_solid = cells.shape[1] == 4
    for _ in range(levels):
        if is_solid:
            cells, weights = halve_tetrahedra(cells, points[:, :3])
        elif scheme == "linear":
            cells, weights = halve_triangles(cells, len(points))
        elif scheme == "loop":
            cells, weights = loop_step(cells, len(points))
        else:
            quadrilaterals, weights = catmull_clark_step(cells, len(points))
            cells = split_quadrilaterals(quadrilaterals)
        points = weights @ points
        yield cells, points


def _texture_mesh(mesh: Mesh, texture: TextureCoordinates) -> tuple[Integers, Floats]:
    """The texture coordinates as triangles that are joined wherever there is no seam: (m, 3), (t, 2)."""
    table = facet_table(mesh.simplices)
    _, labels = corner_classes(table, mesh.simplices.size, ~seam_pairs(texture, table))
    _, first = np.unique(labels, return_index=True)
    return labels.reshape(-1, 3), texture.coordinates[texture.corners.ravel()[first]]
