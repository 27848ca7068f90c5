"""Injectivity of maps of tetrahedral meshes: stars of edges and vertices, the boundary, components."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.covered_component import covered_component
from workbench.core.facets import facet_table
from workbench.core.mesh import Mesh
from workbench.core.solid_stars import doubled_facets, nested_fans, overlapping_edges
from workbench.core.triangle_pairs import meeting_triangles
from workbench.core.verdict import Verdict

MOST_PAIRS = 10_000
"""Pairs of boundary triangles that are listed; a map that has more is found out all the same."""


def stars_of_solid(mesh: Mesh, tetrahedra: Integers, positions: Floats) -> Verdict:
    """Whether a map whose tetrahedra are all of one orientation is one-to-one near every point.

    No two tetrahedra may lie on one side of a facet, and none may wind round an inner edge more than once. Then the
    directions round an inner vertex are covered without a fold, so once each: a sphere has no coverings but itself. Round
    a boundary vertex they are covered once as soon as the rim of that patch of directions does not meet itself, which is
    when no two boundary triangles at the vertex have more in common than an edge.

    Parameters
    ----------
    tetrahedra : (m, 4) int64      of the mesh, corners in the order that is positive in the map
    positions : (n, 3) float64
    """
    table = facet_table(tetrahedra)
    facets = doubled_facets(table)
    if len(facets):
        reason = f"Two tetrahedra lie on the same side of {len(facets)} triangles, first of {_facet(facets[0])}."
        return Verdict(False, reason, vertices=np.unique(facets))
    boundary = table.sides[table.first[table.counts == 1]]
    edges = overlapping_edges(tetrahedra, boundary, positions)
    if len(edges):
        reason = (
            f"The tetrahedra round {len(edges)} edges overlap: they wind more than once, "
            f"first round edge {int(edges[0, 0])}-{int(edges[0, 1])}."
        )
        return Verdict(False, reason, edges=edges)
    pairs = meeting_triangles(boundary, positions, "joined", MOST_PAIRS)
    if len(pairs):
        offenders = boundary[pairs]
        first, second = offenders[:, 0], offenders[:, 1]
        vertices = np.unique(first[(first[:, :, None] == second[:, None, :]).any(axis=2)])
        reason = (
            f"The tetrahedra round {_counted(len(vertices), 'boundary vertex', 'boundary vertices')} overlap, "
            f"first round vertex {vertices[0]} (from 0)."
        )
        return Verdict(False, reason, vertices=vertices, boundary_pairs=offenders)
    nested = nested_fans(table, tetrahedra, mesh.topology.nonmanifold_vertices, positions)
    if len(nested):
        reason = f"Of the parts that touch in vertex {nested[0]} (from 0) one lies inside another."
        return Verdict(False, reason, vertices=nested)
    return Verdict(True, "Every tetrahedron is upright and every star of an edge and a vertex winds once.")


def boundary_of_solid(mesh: Mesh, tetrahedra: Integers, positions: Floats) -> Verdict:
    """Whether a locally injective map of tetrahedra is one-to-one on its boundary, and no component covers another.

    Boundary triangles with a common vertex are known not to meet: that is part of being locally injective.

    Parameters
    ----------
    tetrahedra : (m, 4) int64      of the mesh, corners in the order that is positive in the map
    positions : (n, 3) float64
    """
    table = facet_table(tetrahedra)
    sides = table.first[table.counts == 1]
    boundary, component = table.sides[sides], mesh.topology.components[sides // 4]
    pairs = meeting_triangles(boundary, positions, "apart", MOST_PAIRS)
    if len(pairs):
        offenders = boundary[pairs]
        count = f"at least {len(pairs)}" if len(pairs) == MOST_PAIRS else str(len(pairs))
        reason = (
            f"The boundary meets itself in {count} pairs of triangles, "
            f"first {_facet(offenders[0, 0])} and {_facet(offenders[0, 1])}."
        )
        return Verdict(False, reason, boundary_pairs=offenders)
    covered = covered_component(
        component, boundary, positions, lambda point, others: winding_number(point, boundary[others], positions) > 0.5
    )
    if covered >= 0:
        first = int(np.flatnonzero(mesh.topology.components == covered)[0])
        return Verdict(False, f"The component of tetrahedron {first} (from 0) lies inside another component.")
    return Verdict(True, "Every tetrahedron is upright and the boundary is one-to-one.")


def _facet(corners: Integers) -> str:
    return "triangle " + "-".join(str(int(corner)) for corner in corners)


def _counted(count: int, one: str, many: str) -> str:
    return f"{count} {one if count == 1 else many}"


def winding_number(point: Floats, triangles: Integers, positions: Floats) -> float:
    """How often closed surfaces go round a point off them: their solid angles seen from it, in full spheres.

    Parameters
    ----------
    point : (3,) float64
    triangles : (b, 3) int64     outwards

    Source: van Oosterom & Strackee 1983, equation (8).
    """
    a, b, c = (positions[triangles[:, i]] - point for i in range(3))
    la, lb, lc = (np.linalg.norm(side, axis=1) for side in (a, b, c))
    volume = np.einsum("ij,ij->i", a, np.cross(b, c))
    ab, bc, ca = (np.einsum("ij,ij->i", u, v) for u, v in ((a, b), (b, c), (c, a)))
    return float(np.arctan2(volume, la * lb * lc + ab * lc + bc * la + ca * lb).sum() / (2.0 * np.pi))
