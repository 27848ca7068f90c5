"""Whether a surface bounds a solid."""

from __future__ import annotations

from workbench.core.errors import MeshError
from workbench.core.mesh import Mesh
from workbench.core.topology import degenerate_simplices
from workbench.core.triangle_pairs import meeting_triangles


def check_fillable(surface: Mesh) -> None:
    """Raises `MeshError` unless the triangles are closed, oriented alike, and do not meet but in vertices and edges.

    One surface inside another bounds a cavity.
    """
    if surface.dimension != 2:
        raise MeshError("This mesh has tetrahedra already; only a surface of triangles can be filled.")
    if surface.vertices.shape[1] == 2:
        raise MeshError("A figure in the plane bounds no solid; only a closed surface in space can be filled.")
    topology = surface.topology
    if len(topology.nonmanifold_facets):
        a, b = topology.nonmanifold_facets[0]
        raise MeshError(
            f"The surface cannot be filled: {len(topology.nonmanifold_facets)} edges have more than two triangles, "
            f"first edge {a}-{b}; take the inner triangles out in a modeller."
        )
    if len(topology.boundary_vertices):
        edge = topology.boundary_facets[0]
        loops = len(topology.boundary_loops)
        raise MeshError(
            f"The surface cannot be filled: it is open, with {loops} boundary loop{'s' * (loops != 1)}, one of them "
            f"at edge {edge[0]}-{edge[1]}; close its holes in a modeller first."
        )
    if not topology.is_consistently_oriented:
        raise MeshError("The surface cannot be filled: its triangles are not oriented alike.", fixes=("reorient",))
    flat = degenerate_simplices(surface.vertices, surface.simplices)
    if len(flat):
        raise MeshError(
            f"The surface cannot be filled: {len(flat)} triangles have no area, first number {flat[0]} (from 0); "
            "remove them in a modeller first."
        )
    pairs = meeting_triangles(surface.simplices, surface.vertices)
    if len(pairs):
        raise MeshError(
            f"The surface cannot be filled: it meets itself in {len(pairs)} pairs of triangles, first "
            f"{pairs[0, 0]} and {pairs[0, 1]} (from 0); mend that in a modeller first."
        )
