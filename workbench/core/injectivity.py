"""Verdicts on a map: inverted simplices, local and global injectivity, with the offenders."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from workbench.core.arrays import Booleans, Floats, Integers
from workbench.core.covered_component import covered_component
from workbench.core.mesh import Mesh
from workbench.core.predicates import orientation, orientation_3d, rays_coincide, segments_meet
from workbench.core.segment_pairs import box_pairs
from workbench.core.solid_injectivity import boundary_of_solid, stars_of_solid
from workbench.core.verdict import Verdict
from workbench.core.vertex_stars import overlapping_stars


def orientation_signs(mesh: Mesh, positions: Floats) -> Integers:
    """Exact sign (m,) of each simplex in the map, relative to the source where that has signs: -1 turned over, 0 flat.

    Parameters
    ----------
    positions : (n, d) float64     d the dimension of the simplices, finite
    """
    signs = _signs(positions, mesh.simplices)
    if mesh.vertices.shape[1] == mesh.dimension:
        signs = signs * _signs(mesh.vertices, mesh.simplices)
    return signs


def local_injectivity(mesh: Mesh, positions: Floats) -> Verdict:
    """Whether the map is one-to-one near every point.

    All simplices have one orientation, no two lie on the same side of a shared edge, the star of every inner vertex
    winds round it exactly once (Fig. 13), and the star of no boundary vertex overlaps itself. A map that is mirrored as
    a whole passes, with a remark; its simplices are listed as inverted. For tetrahedra see `stars_of_solid`.

    Parameters
    ----------
    positions : (n, d) float64
    """
    problem = _unfit(mesh, positions)
    if problem:
        return Verdict(False, problem)
    signs = orientation_signs(mesh, positions)
    inverted, degenerate = np.flatnonzero(signs < 0), np.flatnonzero(signs == 0)
    is_mirrored = len(inverted) == mesh.simplex_count
    if len(degenerate) or (len(inverted) and not is_mirrored):
        return Verdict(False, _turned_sentence(mesh, inverted, degenerate), inverted, degenerate)
    upright = _upright(mesh, positions)
    return _remarked(stars_of_solid(mesh, upright, positions) if mesh.dimension == 3 else _stars(upright, positions), inverted)


def _stars(triangles: Integers, positions: Floats) -> Verdict:
    """Whether triangles in the plane, all counter-clockwise, are one-to-one near every point."""
    edges, has_twin = match_sides(triangles, len(positions))
    if len(edges):
        reason = f"Two triangles lie on the same side of {len(edges)} edges, first of {_edge(edges[0])}."
        return Verdict(False, reason, edges=edges)
    vertices = overlapping_stars(triangles, has_twin, positions)
    if len(vertices):
        reason = (
            f"The triangles round {len(vertices)} vertices overlap: they wind more than once, "
            f"first round vertex {vertices[0]} (from 0)."
        )
        return Verdict(False, reason, vertices=vertices)
    return Verdict(True, "Every triangle is upright and every star of a vertex winds once.")


def global_injectivity(mesh: Mesh, positions: Floats) -> Verdict:
    """Whether the map is one-to-one: positively oriented, and one-to-one on the boundary (Theorem 5.1).

    Boundary edges (triangles) are compared exactly, over all loops and components; components must not cover each other
    either.

    Parameters
    ----------
    positions : (n, d) float64
    """
    local = local_injectivity(mesh, positions)
    if local.holds is False:
        return local
    upright = _upright(mesh, positions)
    boundary = boundary_of_solid if mesh.dimension == 3 else _boundary
    return _remarked(boundary(mesh, upright, positions), local.inverted)


def _boundary(mesh: Mesh, triangles: Integers, positions: Floats) -> Verdict:
    """Whether triangles, all counter-clockwise, are one-to-one on the boundary, and no component covers another."""
    _, has_twin = match_sides(triangles, mesh.vertex_count)
    triangle, corner = np.nonzero(~has_twin)
    edges = np.stack([triangles[triangle, corner], triangles[triangle, (corner + 1) % 3]], axis=1)
    component = mesh.topology.components[triangle]
    pairs = _meeting_edges(edges, positions)
    if len(pairs):
        offenders = edges[pairs]
        reason = (
            f"The boundary meets itself in {len(pairs)} pairs of edges, "
            f"first {_edge(offenders[0, 0])} and {_edge(offenders[0, 1])}."
        )
        return Verdict(False, reason, boundary_pairs=offenders)
    covered = covered_component(
        component, edges, positions, lambda point, others: _winds_round(point, edges[others], positions)
    )
    if covered >= 0:
        first = int(np.flatnonzero(mesh.topology.components == covered)[0])
        reason = f"The component of triangle {first} (from 0) lies on top of another component."
        return Verdict(False, reason)
    return Verdict(True, "Every triangle is upright and the boundary is one-to-one.")


def _remarked(verdict: Verdict, inverted: Integers) -> Verdict:
    """The verdict on a map whose simplices are all upright, or all `inverted`."""
    mirrored = " The map is mirrored as a whole." if len(inverted) else ""
    return replace(verdict, reason=verdict.reason + mirrored, inverted=inverted)


def _unfit(mesh: Mesh, positions: Floats) -> str:
    if positions.shape != (mesh.vertex_count, mesh.dimension):
        return f"The map has shape {positions.shape}; ({mesh.vertex_count}, {mesh.dimension}) is needed."
    if not np.isfinite(positions).all():
        row = int(np.flatnonzero(~np.isfinite(positions).all(axis=1))[0])
        return f"The position of vertex {row} (from 0) is not finite."
    return ""


def _turned_sentence(mesh: Mesh, inverted: Integers, degenerate: Integers) -> str:
    noun = "triangles" if mesh.dimension == 2 else "tetrahedra"
    parts = [
        f"{len(found)} {noun} are {word}, first number {found[0]} (from 0)"
        for found, word in ((inverted, "inverted"), (degenerate, "degenerate"))
        if len(found)
    ]
    return " and ".join(parts) + "."


def _edge(ends: Integers) -> str:
    return f"edge {int(ends[0])}-{int(ends[1])}"


def _signs(positions: Floats, simplices: Integers) -> Integers:
    corners = [np.ascontiguousarray(positions[simplices[:, i]]) for i in range(simplices.shape[1])]
    return orientation(*corners) if len(corners) == 3 else orientation_3d(*corners)


def _upright(mesh: Mesh, positions: Floats) -> Integers:
    """Simplices with their corners in the order that is positive in the map: counter-clockwise for triangles."""
    turned = mesh.simplices.copy()
    turned[:, :2] = mesh.simplices[:, 1::-1]
    return np.where(_signs(positions, mesh.simplices)[:, None] < 0, turned, mesh.simplices)


def match_sides(triangles: Integers, vertex_count: int) -> tuple[Integers, Booleans]:
    """Sides that two triangles run along in the same direction, and whether each side has a triangle across it.

    Returns
    -------
    (k, 2) int64, (m, 3) bool     side i of a triangle goes from its corner i to the next
    """
    tails, heads = triangles, np.roll(triangles, -1, axis=1)
    keys, reverse = tails * vertex_count + heads, heads * vertex_count + tails
    ordered = np.sort(keys, axis=None)
    doubled = np.unique(ordered[1:][ordered[1:] == ordered[:-1]])
    place = np.minimum(np.searchsorted(ordered, reverse), len(ordered) - 1)
    return np.stack([doubled // vertex_count, doubled % vertex_count], axis=1), ordered[place] == reverse


def _meeting_edges(edges: Integers, positions: Floats) -> Integers:
    """Pairs (p, 2) of boundary edges that meet elsewhere than in a vertex of both."""
    pairs = box_pairs(positions[edges[:, 0]], positions[edges[:, 1]])
    first, second = edges[pairs[:, 0]], edges[pairs[:, 1]]
    shares = (first[:, :, None] == second[:, None, :]).any(axis=(1, 2))
    apart = np.flatnonzero(~shares)
    meets = np.zeros(len(pairs), dtype=bool)
    meets[apart] = segments_meet(*(positions[part[apart, end]] for part in (first, second) for end in (0, 1)))
    # edges of one vertex meet elsewhere too when they lie in the same direction from it
    for i in (0, 1):
        for j in (0, 1):
            rows = np.flatnonzero(shares & (first[:, i] == second[:, j]))
            tips = positions[first[rows, 1 - i]], positions[second[rows, 1 - j]]
            meets[rows] |= rays_coincide(positions[first[rows, i]], *tips)
    return pairs[meets]


def _winds_round(point: Floats, edges: Integers, positions: Floats) -> bool:
    """Whether closed polygons wind round a point (2,), by the edges that cross the ray to its right."""
    tails, heads, point = positions[edges[:, 0]], positions[edges[:, 1]], point[None]
    upward = (tails[:, 1] <= point[:, 1]) & (point[:, 1] < heads[:, 1])
    downward = (heads[:, 1] <= point[:, 1]) & (point[:, 1] < tails[:, 1])
    winding = np.count_nonzero(orientation(tails[upward], heads[upward], point) > 0)
    return winding != np.count_nonzero(orientation(tails[downward], heads[downward], point) < 0)
