"""Plane figures made solid layer by layer: a beam with a hole."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Floats, Integers

BEAM = (4.0, 1.0, 0.6)
"""Length, height and depth."""
_HOLE = 0.28


def beam_with_hole(tetrahedra: int) -> tuple[Floats, Integers]:
    """Vertices (n, 3) and about `tetrahedra` tetrahedra of a beam with a round hole through the middle: genus 1."""
    # quadrilaterals: 3 k^2 in the two ends, 4 k layers about the hole, with as many segments of the height; six to a cube
    count = max(3, round((tetrahedra / 15.6) ** (1.0 / 3.0)))
    vertices, quads = _face(count)
    layers = max(1, round(BEAM[2] * count))
    shorter = _shorter_diagonals(vertices, quads)
    return extruded(vertices, shorter, np.linspace(0.0, BEAM[2], layers + 1))


def extruded(vertices: Floats, triangles: Integers, heights: Floats) -> tuple[Floats, Integers]:
    """Vertices (n, 3) and tetrahedra of the prisms over counter-clockwise triangles in the plane, three to a prism.

    Diagonals of the prisms' sides rise from the lower number, so that neighbours fit.

    Parameters
    ----------
    vertices : (p, 2) float64
    triangles : (t, 3) int64
    heights : (l,) float64       ascending
    """
    size = len(vertices)
    solid = np.column_stack([np.tile(vertices, (len(heights), 1)), np.repeat(heights, size)])
    ordered = np.sort(triangles, axis=1)
    cells = []
    for layer in range(len(heights) - 1):
        a, b, c = (ordered + layer * size).T
        above_a, above_b, above_c = a + size, b + size, c + size
        for corners in ((a, b, c, above_c), (a, b, above_b, above_c), (a, above_a, above_b, above_c)):
            cells.append(np.stack(corners, axis=1))
    tetrahedra = np.concatenate(cells)
    edges = solid[tetrahedra[:, 1:]] - solid[tetrahedra[:, :1]]
    negative = np.linalg.det(edges) < 0.0
    tetrahedra[negative] = tetrahedra[negative][:, [1, 0, 2, 3]]
    return solid, tetrahedra


def _face(count: int) -> tuple[Floats, Integers]:
    """Vertices (p, 2) and quadrilaterals of the beam's face; `count` segments to its height."""
    length, height, _ = BEAM
    middle, half = np.array([0.5 * length, 0.5 * height]), 0.5 * height
    side = np.linspace(-half, half, count, endpoint=False)
    flat = np.full(count, half)
    rim = np.concatenate([np.stack(part, axis=1) for part in ((side, -flat), (flat, side), (-side, flat), (-flat, -side))])
    angle = 2.0 * np.pi * np.arange(4 * count) / (4 * count) - 0.75 * np.pi
    hole = _HOLE * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    rings = max(2, round((half - _HOLE) / height * count * 1.6))
    part = np.linspace(0.0, 1.0, rings + 1)[:, None, None]
    blocks = [_quads(middle + (1.0 - part) * hole + part * rim, closes=True)]
    columns = max(1, round((0.5 * length - half) / height * count))
    for low, high in ((0.0, 0.5 * length - half), (0.5 * length + half, length)):
        x, y = np.meshgrid(np.linspace(low, high, columns + 1), np.linspace(0.0, height, count + 1), indexing="ij")
        blocks.append(_quads(np.stack([x, y], axis=-1), closes=False))
    points = np.concatenate([block for block, _ in blocks])
    starts = np.cumsum([0, *(len(block) for block, _ in blocks)])
    quads = np.concatenate([rows + start for (_, rows), start in zip(blocks, starts, strict=False)])
    _, first, merged = np.unique(np.round(points, 9), axis=0, return_index=True, return_inverse=True)
    return points[first], merged.reshape(-1)[quads]


def _quads(grid: Floats, closes: bool) -> tuple[Floats, Integers]:
    """Points and quadrilaterals of a grid (r, c, 2); `closes` joins its last column to the first."""
    rows, columns = grid.shape[:2]
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns if closes else columns - 1), indexing="ij")
    here, beyond = i * columns + j, i * columns + (j + 1) % columns
    return grid.reshape(-1, 2), np.stack([here, here + columns, beyond + columns, beyond], axis=-1).reshape(-1, 4)


def _shorter_diagonals(vertices: Floats, quads: Integers) -> Integers:
    one = np.linalg.norm(vertices[quads[:, 0]] - vertices[quads[:, 2]], axis=1)
    two = np.linalg.norm(vertices[quads[:, 1]] - vertices[quads[:, 3]], axis=1)
    halves = np.where((one <= two)[:, None, None], quads[:, [[0, 1, 2], [0, 2, 3]]], quads[:, [[0, 1, 3], [1, 2, 3]]])
    triangles = halves.reshape(-1, 3)
    first, second = (vertices[triangles[:, i]] - vertices[triangles[:, 0]] for i in (1, 2))
    clockwise = first[:, 0] * second[:, 1] < first[:, 1] * second[:, 0]
    triangles[clockwise] = triangles[clockwise, ::-1]
    return triangles
