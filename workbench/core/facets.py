"""Which simplices meet at which facets, and which corners meet round a vertex."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy

from workbench.core.arrays import Booleans, Integers


@dataclass(frozen=True, eq=False)
class FacetTable:
    """Every side of every simplex, sorted so that sides on the same facet can be found.

    A side is one facet seen from one simplex; h = m (n+1) of them. Side `s (n+1) + i` of simplex s lies opposite its
    corner i.

    Attributes
    ----------
    sides : (h, n) int64        vertices, oriented as the boundary of the simplex
    corners : (h, n) int64      corner `s (n+1) + local` of each vertex, vertices ascending: comparable between sides
    signs : (h,) int64          +1 where `sides` is an even permutation of the ascending vertices, else -1
    facets : (h,) int64         number of the facet
    counts : (f,) int64         sides on each facet: 1 on the boundary, 2 inside, more where it is not manifold
    first : (f,) int64          one side of each facet
    pairs : (p, 2) int64        neighbouring sides of the same facet: every facet is linked through
    """

    sides: Integers
    corners: Integers
    signs: Integers
    facets: Integers
    counts: Integers
    first: Integers
    pairs: Integers

    @property
    def simplex_size(self) -> int:
        return self.sides.shape[1] + 1

    @property
    def pair_simplices(self) -> Integers:
        """(p, 2) int64: the two simplices of each pair."""
        return self.pairs // self.simplex_size

    @property
    def pair_counts(self) -> Integers:
        """(p,) int64: how many sides share the facet of each pair."""
        return self.counts[self.facets[self.pairs[:, 0]]]


def facet_table(simplices: Integers) -> FacetTable:
    """The table of facets of triangles or tetrahedra.

    Parameters
    ----------
    simplices : (m, 3|4) int64

    Cost: one sort of the sides.
    """
    size = simplices.shape[1]
    local = _local_sides(size)
    sides = simplices[:, local].reshape(-1, size - 1)
    order_within = np.argsort(sides, axis=1, kind="stable")
    ascending = np.take_along_axis(sides, order_within, axis=1)
    corners = np.arange(len(simplices), dtype=np.int64)[:, None, None] * size + local[None]
    corners = np.take_along_axis(corners.reshape(-1, size - 1), order_within, axis=1)

    order = _lexicographic_order(ascending)
    sorted_sides = ascending[order]
    is_new = np.ones(len(order), dtype=bool)
    is_new[1:] = (sorted_sides[1:] != sorted_sides[:-1]).any(axis=1)
    number = np.cumsum(is_new) - 1
    facets = np.empty(len(order), dtype=np.int64)
    facets[order] = number
    follows = np.flatnonzero(~is_new)
    return FacetTable(
        sides=sides,
        corners=corners,
        signs=_permutation_signs(order_within),
        facets=facets,
        counts=np.bincount(number).astype(np.int64),
        first=order[is_new].astype(np.int64),
        pairs=np.column_stack([order[follows - 1], order[follows]]).astype(np.int64).reshape(-1, 2),
    )


def neighbouring_simplices(table: FacetTable) -> Integers:
    """Simplex on the other side of each facet: (m, n+1) int64, column i opposite corner i, -1 at the boundary.

    Where more than two simplices meet at a facet, each has one of the others.
    """
    found = np.full(len(table.facets), -1, dtype=np.int64)
    one, other = table.pairs.T
    found[one], found[other] = other // table.simplex_size, one // table.simplex_size
    return found.reshape(-1, table.simplex_size)


def simplex_components(table: FacetTable, simplex_count: int) -> tuple[int, Integers]:
    """Number of face-connected components and the label of each simplex, (m,) int64."""
    count, labels = _components(simplex_count, table.pair_simplices)
    return count, labels


def corner_classes(table: FacetTable, corner_count: int, linked: Booleans | None = None) -> tuple[int, Integers]:
    """Classes of corners that can be reached from each other round a vertex, through shared facets.

    A vertex of a manifold has one class; a vertex at which several sheets touch, or one on a cut, has more.

    Parameters
    ----------
    corner_count : int                 m (n+1)
    linked : (p,) bool, optional       which of `table.pairs` may be crossed; all where not given

    Returns
    -------
    count, labels : int, (corner_count,) int64     labels are numbered by their first corner
    """
    pairs = table.pairs if linked is None else table.pairs[linked]
    links = np.stack([table.corners[pairs[:, 0]], table.corners[pairs[:, 1]]], axis=-1).reshape(-1, 2)
    return _components(corner_count, links)


def split_vertices(simplices: Integers, vertex_count: int, classes: Integers) -> tuple[Integers, Integers]:
    """A vertex of its own for each class of corners.

    The first class of a vertex keeps its number; the others are appended, in the order of their vertices.

    Parameters
    ----------
    simplices : (m, n+1) int64
    classes : (m (n+1),) int64     see `corner_classes`

    Returns
    -------
    simplices, copied_from : (m, n+1) int64, (k,) int64     vertex that each vertex of the result is a copy of
    """
    corners = simplices.ravel()
    _, first_corner = np.unique(classes, return_index=True)
    vertex_of_class = corners[first_corner]
    order = np.lexsort((first_corner, vertex_of_class))
    is_extra = np.zeros(len(order), dtype=bool)
    is_extra[1:] = vertex_of_class[order[1:]] == vertex_of_class[order[:-1]]
    new_vertex = vertex_of_class.copy()
    extra = order[is_extra]
    new_vertex[extra] = vertex_count + np.arange(len(extra))
    copied_from = np.concatenate([np.arange(vertex_count, dtype=np.int64), vertex_of_class[extra]])
    return new_vertex[classes].reshape(simplices.shape), copied_from


def _local_sides(size: int) -> Integers:
    """Corners of the side opposite each corner, in the order of the boundary operator."""
    if size == 3:
        return np.array([[1, 2], [2, 0], [0, 1]], dtype=np.int64)
    return np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]], dtype=np.int64)


def _lexicographic_order(rows: Integers) -> Integers:
    base = int(rows.max()) + 1 if len(rows) else 1
    if base ** rows.shape[1] < 2**62:
        key = rows[:, 0]
        for column in range(1, rows.shape[1]):
            key = key * base + rows[:, column]
        return np.argsort(key, kind="stable")
    return np.lexsort(rows.T[::-1])


def _permutation_signs(order: Integers) -> Integers:
    """Sign of each row as a permutation, from its inversions."""
    inversions = np.zeros(len(order), dtype=np.int64)
    for i in range(order.shape[1]):
        for j in range(i + 1, order.shape[1]):
            inversions += order[:, i] > order[:, j]
    return 1 - 2 * (inversions % 2)


def _components(count: int, links: Integers) -> tuple[int, Integers]:
    ones = np.ones(len(links), dtype=np.int8)
    graph = scipy.sparse.coo_array((ones, (links[:, 0], links[:, 1])), shape=(count, count)).tocsr()
    found, labels = scipy.sparse.csgraph.connected_components(graph, directed=False)
    return int(found), labels.astype(np.int64)
