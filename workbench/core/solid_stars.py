"""Stars of tetrahedra that overlap themselves though every tetrahedron is positively oriented."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.facets import FacetTable, corner_classes
from workbench.core.predicates import orientation_3d

_SURE = 1e-3
"""Sums of dihedral angles round inner edges this close to a full turn are one turn; others are counted exactly."""
_EDGES = ((0, 1, 2, 3), (0, 2, 3, 1), (0, 3, 1, 2), (1, 2, 0, 3), (1, 3, 2, 0), (2, 3, 0, 1))
"""Corners of each edge and the two others, in a positively oriented order."""


def doubled_facets(table: FacetTable) -> Integers:
    """Facets (k, 3) with two tetrahedra on one side.

    Parameters
    ----------
    table : FacetTable     of positively oriented tetrahedra: two on one side run round their facet in the same sense
    """
    count = len(table.counts)
    positive = np.bincount(table.facets[table.signs > 0], minlength=count)
    doubled = (positive > 1) | (table.counts - positive > 1)
    return table.sides[table.first[doubled]]


def overlapping_edges(tetrahedra: Integers, boundary: Integers, positions: Floats) -> Integers:
    """Edges (k, 2) round which the tetrahedra wind more than once.

    Dihedral angles are summed. Round an inner edge they make a number of whole turns: where the sum is not clearly one,
    those wedges are counted that contain the first half plane, by exact signs. On the boundary a sum above a full turn tells
    of overlap; what comes close to it from below is found by the triangles of the boundary (`meeting_triangles`).

    Parameters
    ----------
    tetrahedra : (m, 4) int64      positively oriented in the map
    boundary : (b, 3) int64        boundary facets
    positions : (n, 3) float64
    """
    size = len(positions)
    corners = np.concatenate([tetrahedra[:, list(order)] for order in _EDGES])
    keys = corners[:, :2].min(axis=1) * size + corners[:, :2].max(axis=1)
    unique, edge_of = np.unique(keys, return_inverse=True)
    total = np.bincount(edge_of, _dihedral_angles(corners, positions))
    is_inner = np.ones(len(unique), dtype=bool)
    sides = np.sort(np.concatenate([boundary[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    is_inner[np.searchsorted(unique, sides[:, 0] * size + sides[:, 1])] = False

    overlaps = ~is_inner & (total > 2.0 * np.pi + _SURE)
    doubtful = np.flatnonzero(is_inner & (np.abs(total - 2.0 * np.pi) > _SURE))
    if len(doubtful):
        is_doubtful = np.zeros(len(unique), dtype=bool)
        is_doubtful[doubtful] = True
        rows = np.flatnonzero(is_doubtful[edge_of])
        overlaps[doubtful] = _turns(corners[rows], edge_of[rows], positions)[doubtful] > 1
    return np.stack([unique[overlaps] // size, unique[overlaps] % size], axis=1)


def dihedral_range(tetrahedra: Integers, positions: Floats) -> tuple[float, float]:
    """Smallest and largest dihedral angle of all tetrahedra (m, 4) at positions (n, 3), in degrees."""
    corners = np.concatenate([tetrahedra[:, list(order)] for order in _EDGES])
    angles = np.degrees(_dihedral_angles(corners, positions))
    return float(angles.min()), float(angles.max())


def _dihedral_angles(corners: Integers, positions: Floats) -> Floats:
    """Angle (r,) of each tetrahedron at the edge of its first two corners."""
    a = positions[corners[:, 0]]
    axis, second, third = (_of_size_one(positions[corners[:, i]] - a) for i in (1, 2, 3))
    u, v = np.cross(axis, second), np.cross(axis, third)
    sine, cosine = np.linalg.norm(np.cross(u, v), axis=1), np.einsum("ij,ij->i", u, v)
    angles: Floats = np.arctan2(sine, cosine)
    return angles


def _of_size_one(edges: Floats) -> Floats:
    """Edges (r, 3) with the largest coordinate of each at 1, so that fourth powers of lengths stay in range."""
    largest = np.abs(edges).max(axis=1, keepdims=True)
    return edges / np.where(largest > 0.0, largest, 1.0)


def _turns(corners: Integers, edge_of: Integers, positions: Floats) -> Integers:
    """How many wedges round each edge contain the half plane through the first other vertex met at that edge.

    A wedge a b c d contains the half plane of r from c on, and not that of d: det(a, b, c, r) >= 0 and det(a, b, r, d) > 0.
    """
    along = corners[:, 0] < corners[:, 1]
    a, b = (np.where(along, corners[:, i], corners[:, 1 - i]) for i in (0, 1))
    c, d = (np.where(along, corners[:, 2 + i], corners[:, 3 - i]) for i in (0, 1))
    edges, first = np.unique(edge_of, return_index=True)
    r = c[first][np.searchsorted(edges, edge_of)]
    a, b, c, d, r = (np.ascontiguousarray(positions[part]) for part in (a, b, c, d, r))
    contains = (orientation_3d(a, b, c, r) >= 0) & (orientation_3d(a, b, r, d) > 0)
    return np.bincount(edge_of[contains], minlength=int(edge_of.max()) + 1)


def nested_fans(table: FacetTable, tetrahedra: Integers, vertices: Integers, positions: Floats) -> Integers:
    """Those of `vertices` (k,), each with several fans of tetrahedra, at which one fan lies inside another.

    The fans' boundaries do not meet but in the vertex, so one direction of each tells for all of it.
    """
    if not len(vertices):
        return vertices
    _, classes = corner_classes(table, tetrahedra.size)
    nested = []
    for vertex in vertices:
        corners = np.flatnonzero(tetrahedra.ravel() == vertex)
        fans = classes[corners]
        for fan in np.unique(fans):
            probe = tetrahedra[corners[fans == fan][0] // 4]
            inside = positions[probe].mean(axis=0)
            others = corners[fans != fan]
            if _sees(tetrahedra[others // 4], others % 4, positions, inside):
                nested.append(vertex)
                break
    return np.array(nested, dtype=np.int64)


def _sees(tetrahedra: Integers, corner: Integers, positions: Floats, point: Floats) -> bool:
    """Whether `point` lies in the cone of a positively oriented tetrahedron from its given corner."""
    cone = np.ones(len(tetrahedra), dtype=bool)
    for other in range(1, 4):
        replaced = np.ascontiguousarray(positions[tetrahedra])
        replaced[np.arange(len(tetrahedra)), (corner + other) % 4] = point
        cone &= orientation_3d(*(np.ascontiguousarray(replaced[:, i]) for i in range(4))) >= 0
    return bool(cone.any())
