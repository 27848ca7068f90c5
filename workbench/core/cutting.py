"""Which edges to cut so that every component becomes a disc."""

from __future__ import annotations

import numpy as np
import scipy

from workbench.core.arrays import Booleans, Floats, Integers
from workbench.core.facets import FacetTable, corner_classes, facet_table, simplex_components, split_vertices
from workbench.core.geometry_library import cut_to_disk
from workbench.core.mesh import Mesh

BRANCH_RATIO = 0.25
"""A closed sphere is cut further towards vertices that are farther from the cut than this part of its first path."""

MOST_BRANCHES = 8


def disc_cut(mesh: Mesh) -> Booleans:
    """Pairs of neighbouring triangles (of `facet_table`) to part so that each component is a manifold disc, (p,) bool.

    Edges of more than two triangles are opened first, all the way. What is a disc then stays as it is; a sphere is
    cut along a tree of shortest paths between vertices far apart; anything else by libigl's `cut_to_disk`.
    Triangles must not repeat a vertex.
    """
    table = facet_table(mesh.simplices)
    parted = table.pair_counts > 2
    # Cut the opened mesh: it is manifold, and its pairs are those of `table` that are not parted yet.
    simplices, origin = _opened(mesh.simplices, mesh.vertex_count, table, parted)
    opened = facet_table(simplices)
    vertices = mesh.vertices[origin]
    _, components = simplex_components(opened, len(simplices))
    order = np.argsort(components, kind="stable")
    groups = np.split(order, np.flatnonzero(np.diff(components[order])) + 1)
    cut_facets = np.zeros(len(opened.counts), dtype=bool)
    for members in groups:
        used, local = np.unique(simplices[members], return_inverse=True)
        edges = component_cut(vertices[used], local.reshape(-1, 3))
        if len(edges):
            cut_facets |= _facets_of_edges(opened, used[edges])
    cut_sides = cut_facets[opened.facets]
    return parted | cut_sides[table.pairs[:, 0]]


def component_cut(vertices: Floats, triangles: Integers) -> Integers:
    """Edges that open one connected manifold surface to a disc, (k, 2) int64; boundary edges may be among them."""
    table = facet_table(triangles)
    euler = len(vertices) - len(table.counts) + len(triangles)
    is_closed = not (table.counts == 1).any()
    if euler == 1 and not is_closed:
        return np.empty((0, 2), dtype=np.int64)
    if euler == 2 and is_closed:
        return _sphere_cut(vertices, table)
    return cut_to_disk(triangles)


def _opened(simplices: Integers, vertex_count: int, table: FacetTable, parted: Booleans) -> tuple[Integers, Integers]:
    _, classes = corner_classes(table, simplices.size, ~parted)
    return split_vertices(simplices, vertex_count, classes)


def _facets_of_edges(table: FacetTable, edges: Integers) -> Booleans:
    base = int(table.sides.max()) + 1
    ends = np.sort(table.sides[table.first], axis=1)
    wanted = np.sort(edges, axis=1)
    return np.isin(ends[:, 0] * base + ends[:, 1], wanted[:, 0] * base + wanted[:, 1])


def _sphere_cut(vertices: Floats, table: FacetTable) -> Integers:
    """A tree of shortest edge paths that reaches the far ends of a closed surface of genus 0.

    The first path joins two vertices far apart; then the farthest vertex from the tree is joined to it while it is
    far: horns and legs are reached, a ball gets few branches.
    """
    edges = table.sides[table.first]
    lengths = np.linalg.norm(vertices[edges[:, 0]] - vertices[edges[:, 1]], axis=1)
    lengths = np.maximum(lengths, np.finfo(np.float64).tiny)  # a stored zero is no edge to the sparse graph
    graph = scipy.sparse.csr_array((lengths, (edges[:, 0], edges[:, 1])), shape=(len(vertices), len(vertices)))
    distance = scipy.sparse.csgraph.dijkstra(graph, directed=False, indices=0)
    first = int(distance.argmax())
    tree = [first]
    cut: list[tuple[int, int]] = []
    longest = 0.0
    for _ in range(MOST_BRANCHES):
        distance, before, _ = scipy.sparse.csgraph.dijkstra(
            graph, directed=False, indices=tree, min_only=True, return_predecessors=True
        )
        vertex = int(distance.argmax())
        if distance[vertex] < BRANCH_RATIO * longest or vertex in tree:
            break
        longest = longest or float(distance[vertex])
        while before[vertex] >= 0:
            cut.append((vertex, int(before[vertex])))
            tree.append(vertex)
            vertex = int(before[vertex])
    if len(cut) == 1:  # one cut edge parts nothing: go on by a second one
        tail, head = cut[0]
        touching = edges[(edges == head).any(axis=1) & ~(edges == tail).any(axis=1)]
        cut.append((head, int(touching[0].sum()) - head))
    return np.array(cut, dtype=np.int64).reshape(-1, 2)
