"""What a mesh is as a complex: components, boundary, orientation, genus, and where it is not a manifold."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from workbench.core.arrays import Floats, Integers, frozen
from workbench.core.facets import FacetTable, corner_classes, facet_table, simplex_components
from workbench.core.mesh import Mesh
from workbench.core.orientation import orientation_sheets

DEGENERATE_RATIO = 1e-13
"""A simplex is degenerate when its height is at most this part of its longest edge, or lost in rounding."""


@dataclass(frozen=True, eq=False)
class Topology:
    """Facts about a mesh, found once.

    Attributes
    ----------
    dimension : int                          2 triangles, 3 tetrahedra
    vertex_count, simplex_count : int
    edge_count : int                         0 for tetrahedra (not needed)
    component_count : int                    face-connected: parts that only touch in a vertex are two
    components : (m,) int64                  component of each simplex
    boundary_facets : (b, dimension) int64   oriented as the simplices
    boundary_vertices : (k,) int64           ascending
    boundary_loops : tuple of (k,) int64     ordered, oriented as the simplices, the longest first; triangles only
    euler_characteristic : int               of the vertices that are used
    genus : int or None                      sum over the components; None unless an orientable manifold of triangles
    is_orientable : bool
    is_consistently_oriented : bool          neighbours agree
    nonmanifold_facets : (k, dimension) int64   in more than two simplices
    nonmanifold_vertices : (k,) int64        whose simplices are not one fan
    degenerate : (k,) int64                  simplices with repeated vertices, or no area or volume
    repeated : (k,) int64                    simplices on the same vertices as an earlier one
    negative : (k,) int64                    simplices of negative volume (tets), of negative area (two columns)
    unreferenced : (k,) int64                vertices in no simplex
    """

    dimension: int
    vertex_count: int
    simplex_count: int
    edge_count: int
    component_count: int
    components: Integers
    boundary_facets: Integers
    boundary_vertices: Integers
    boundary_loops: tuple[Integers, ...]
    euler_characteristic: int
    genus: int | None
    is_orientable: bool
    is_consistently_oriented: bool
    nonmanifold_facets: Integers
    nonmanifold_vertices: Integers
    degenerate: Integers
    repeated: Integers
    negative: Integers
    unreferenced: Integers

    @property
    def nonmanifold_edges(self) -> Integers:
        """(k, 2) int64: edges in more than two triangles."""
        return self.nonmanifold_facets if self.dimension == 2 else np.empty((0, 2), dtype=np.int64)

    @property
    def is_manifold(self) -> bool:
        return not len(self.nonmanifold_facets) and not len(self.nonmanifold_vertices)

    @property
    def is_disc(self) -> bool:
        """One manifold component with one boundary loop and no handle (oriented or not)."""
        return (
            self.dimension == 2
            and self.component_count == 1
            and self.is_manifold
            and len(self.boundary_loops) == 1
            and self.euler_characteristic == 1
        )


def analyse_topology(mesh: Mesh) -> Topology:
    """All facts at once; `Mesh.topology` keeps them. Cost: a few sorts of the sides of the simplices."""
    simplices, vertices = mesh.simplices, mesh.vertices
    table = facet_table(simplices)
    component_count, components = simplex_components(table, len(simplices))
    is_boundary = table.counts == 1
    boundary = table.sides[table.first[is_boundary]]
    nonmanifold_facets = table.sides[table.first[table.counts > 2]]
    referenced = np.zeros(len(vertices), dtype=bool)
    referenced[simplices.ravel()] = True
    nonmanifold_vertices = _nonmanifold_vertices(table, mesh)
    is_orientable, is_consistent, _ = orientation_sheets(table, len(simplices))

    loops: tuple[Integers, ...] = ()
    euler = int(referenced.sum()) - len(table.counts) + len(simplices)
    edge_count = len(table.counts)
    genus: int | None = None
    if mesh.dimension == 2:
        loops = _boundary_loops(boundary)
        if is_orientable and not len(nonmanifold_facets) and not len(nonmanifold_vertices):
            genus = (2 * component_count - len(loops) - euler) // 2
    else:
        edge_count = 0
        euler = int(referenced.sum()) - _edge_count(simplices) + len(table.counts) - len(simplices)

    return Topology(
        dimension=mesh.dimension,
        vertex_count=mesh.vertex_count,
        simplex_count=mesh.simplex_count,
        edge_count=edge_count,
        component_count=component_count,
        components=frozen(components, np.int64),
        boundary_facets=frozen(boundary, np.int64),
        boundary_vertices=frozen(np.unique(boundary), np.int64),
        boundary_loops=loops,
        euler_characteristic=euler,
        genus=genus,
        is_orientable=is_orientable,
        is_consistently_oriented=is_consistent,
        nonmanifold_facets=frozen(nonmanifold_facets, np.int64),
        nonmanifold_vertices=frozen(nonmanifold_vertices, np.int64),
        degenerate=frozen(degenerate_simplices(vertices, simplices), np.int64),
        repeated=frozen(_repeated_simplices(simplices), np.int64),
        negative=frozen(_negative_simplices(vertices, simplices), np.int64),
        unreferenced=frozen(np.flatnonzero(~referenced), np.int64),
    )


def signed_contents(vertices: Floats, simplices: Integers) -> Floats:
    """n! times the signed area or volume of each simplex, (m,) float64; for triangles in space without sign."""
    edges = vertices[simplices[:, 1:]] - vertices[simplices[:, :1]]
    if simplices.shape[1] == 4:
        return np.einsum("ij,ij->i", np.cross(edges[:, 0], edges[:, 1]), edges[:, 2])
    if vertices.shape[1] == 2:
        return edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0]
    return np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1)


def degenerate_simplices(vertices: Floats, simplices: Integers) -> Integers:
    """Simplices with a repeated vertex or without area or volume, (k,) int64.

    The measure is compared with the longest edge, and with the rounding of the coordinates themselves, so that
    three points on a line far from the origin are found whatever the last digits say.
    """
    scale = float(np.abs(vertices).max()) or 1.0
    unit = vertices / scale
    content = np.abs(signed_contents(unit, simplices))
    longest = np.zeros(len(simplices))
    for i in range(simplices.shape[1]):
        for j in range(i + 1, simplices.shape[1]):
            longest = np.maximum(longest, np.linalg.norm(unit[simplices[:, i]] - unit[simplices[:, j]], axis=1))
    rounding = 4 * np.finfo(np.float64).eps * np.abs(unit[simplices]).max(axis=(1, 2))
    threshold = (DEGENERATE_RATIO * longest + rounding) * longest ** (simplices.shape[1] - 2)
    ordered = np.sort(simplices, axis=1)
    is_repeated = (ordered[:, 1:] == ordered[:, :-1]).any(axis=1)
    return np.flatnonzero(is_repeated | (content <= threshold))


def _negative_simplices(vertices: Floats, simplices: Integers) -> Integers:
    if simplices.shape[1] == 3 and vertices.shape[1] == 3:
        return np.empty(0, dtype=np.int64)
    return np.flatnonzero(signed_contents(vertices, simplices) < 0)


def _repeated_simplices(simplices: Integers) -> Integers:
    ordered = np.sort(simplices, axis=1)
    order = np.lexsort(ordered.T[::-1])
    same = (ordered[order[1:]] == ordered[order[:-1]]).all(axis=1)
    return np.sort(order[1:][same])


def _nonmanifold_vertices(table: FacetTable, mesh: Mesh) -> Integers:
    corners = mesh.simplices.ravel()
    count, classes = corner_classes(table, len(corners))
    if count == np.count_nonzero(np.bincount(corners)):
        return np.empty(0, dtype=np.int64)
    vertex_of_class = np.empty(count, dtype=np.int64)
    vertex_of_class[classes] = corners
    fans = np.bincount(vertex_of_class, minlength=mesh.vertex_count)
    return np.flatnonzero(fans > 1)


def _edge_count(simplices: Integers) -> int:
    pairs = [(i, j) for i in range(simplices.shape[1]) for j in range(i)]
    ends = np.sort(np.concatenate([simplices[:, p] for p in pairs]), axis=1)
    return len(np.unique(ends[:, 0] * (int(simplices.max()) + 1) + ends[:, 1]))


def _boundary_loops(edges: Integers) -> tuple[Integers, ...]:
    """Walks along the boundary edges, each edge once.

    Edges are followed in their own direction while that is possible; where triangles disagree on the orientation,
    the walk goes on against it. A vertex in which several loops touch joins them or not as the edges come.
    """
    outgoing: dict[int, list[int]] = {}
    incoming: dict[int, list[int]] = {}
    ends = edges.tolist()
    for number, (tail, head) in enumerate(ends):
        outgoing.setdefault(tail, []).append(number)
        incoming.setdefault(head, []).append(number)
    used = [False] * len(ends)
    loops = []
    for first, (start, vertex) in enumerate(ends):
        if used[first]:
            continue
        used[first] = True
        loop = [start]
        while vertex != start:
            loop.append(vertex)
            forward = next((e for e in outgoing.get(vertex, ()) if not used[e]), -1)
            backward = -1 if forward >= 0 else next((e for e in incoming.get(vertex, ()) if not used[e]), -1)
            if forward < 0 and backward < 0:
                break
            used[max(forward, backward)] = True
            vertex = ends[forward][1] if forward >= 0 else ends[backward][0]
        loops.append(frozen(loop, np.int64))
    return tuple(sorted(loops, key=lambda loop: -len(loop)))
