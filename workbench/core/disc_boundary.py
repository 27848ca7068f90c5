"""The boundary of a disc laid out on a convex curve by arc length."""

from __future__ import annotations

from typing import Literal

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.errors import MeshError
from workbench.core.mesh import Mesh

BoundaryShape = Literal["circle", "square"]

_SHORTEST = 0.02
"""Boundary edges count as at least this part of the mean: shorter ones would vanish in rounding."""

_BULGE = 0.1
"""Height of a bulged side of the square, in sides."""


def disc_boundary(mesh: Mesh) -> Integers:
    """Boundary loop (k,) of a disc, in the sense of its triangles. Raises `MeshError` where the mesh is no disc."""
    topology = mesh.topology
    if topology.is_disc and topology.is_consistently_oriented and mesh.dimension == 2:
        return topology.boundary_loops[0]
    if mesh.dimension != 2:
        raise MeshError("This start needs triangles, and the mesh has tetrahedra; choose the start rest.")
    fixes: tuple[str, ...]
    if not topology.is_consistently_oriented:
        found, fixes = "its triangles are not oriented alike", ("reorient",)
    elif topology.component_count > 1:
        found, fixes = f"it has {topology.component_count} components", ("largest",)
    elif not topology.is_manifold:
        found, fixes = "it is not a manifold", ()
    else:
        found, fixes = f"it has {len(topology.boundary_loops)} boundary loops and genus {topology.genus}", ("cut",)
    raise MeshError(
        f"This start needs a disc, but the mesh is none: {found}. Choose another start, or fix the mesh.", fixes=fixes
    )


def convex_outline(mesh: Mesh, loop: Integers, shape: BoundaryShape) -> Floats:
    """Places (k, 2) of the vertices of `loop` on a convex curve of area about pi, counter-clockwise, by arc length.

    The square is bulged a little where an inner edge joins two vertices of one side: all that such an edge cuts off
    would lie flat on the side otherwise.
    """
    points = mesh.vertices[loop]
    lengths = np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1)
    lengths = np.maximum(lengths, _SHORTEST * lengths.mean())
    arc = np.concatenate([[0.0], np.cumsum(lengths)]) / lengths.sum()
    if shape == "circle" or len(loop) < 4:
        angle = 2.0 * np.pi * arc[:-1]
        return np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return _square(mesh, loop, arc)


def _square(mesh: Mesh, loop: Integers, arc: Floats) -> Floats:
    count = len(loop)
    corners = np.searchsorted(arc[:-1], [0.0, 0.25, 0.5, 0.75])
    for side in (1, 2, 3):  # each side has an edge at least
        corners[side] = min(max(corners[side], corners[side - 1] + 1), count - 4 + side)
    ends = np.append(corners, count)
    side_of = np.repeat(np.arange(4), np.diff(ends))
    along = (arc[:-1] - arc[ends[side_of]]) / (arc[ends[side_of + 1]] - arc[ends[side_of]])
    half = 0.5 * np.sqrt(np.pi)
    starts = half * np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    directions = np.roll(starts, -1, axis=0) - starts
    outline: Floats = starts[side_of] + along[:, None] * directions[side_of]
    if _has_chord_on_a_side(mesh, loop, side_of, corners):
        outward = np.stack([directions[:, 1], -directions[:, 0]], axis=1)
        outline += (4.0 * _BULGE * along * (1.0 - along))[:, None] * outward[side_of]
    return outline


def _has_chord_on_a_side(mesh: Mesh, loop: Integers, side_of: Integers, corners: Integers) -> bool:
    place = np.full(mesh.vertex_count, -1, dtype=np.int64)
    place[loop] = np.arange(len(loop))
    ends = place[np.concatenate([mesh.simplices[:, [i, (i + 1) % 3]] for i in range(3)])]
    ends = ends[(ends >= 0).all(axis=1)]
    apart = (ends[:, 1] - ends[:, 0]) % len(loop)
    chords = ends[(apart != 1) & (apart != len(loop) - 1)]
    if not len(chords):
        return False
    # a corner lies on two sides
    on_side = side_of[:, None] == np.arange(4)
    on_side[corners, np.arange(4) - 1] = True
    return bool((on_side[chords[:, 0]] & on_side[chords[:, 1]]).any())
