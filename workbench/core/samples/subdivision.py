"""Edgewise subdivision of simplices: each into k^d parts that fit across shared faces."""

from __future__ import annotations

from itertools import permutations, product

import numpy as np

from workbench.core.arrays import Floats, Integers


def subdivide(vertices: Floats, simplices: Integers, parts: int) -> tuple[Floats, Integers]:
    """Split every edge into `parts`, every simplex of dimension d into `parts`^d.

    Kuhn's triangulation of the unit cubes, restricted to the simplex parts >= x_1 >= ... >= x_d >= 0; neighbours fit
    because
    the corners of each simplex are taken in the order of their global index. Orientation is that of the input.

    Parameters
    ----------
    vertices : (n, e) float64
    simplices : (m, d+1) int64
    """
    dimension = simplices.shape[1] - 1
    lattice, cells = _kuhn_simplex(dimension, parts)
    # barycentric weights of a lattice point: differences of parts >= x_1 >= ... >= x_d >= 0
    steps = np.column_stack([np.full(len(lattice), parts), lattice, np.zeros(len(lattice), dtype=np.int64)])
    weights = -np.diff(steps, axis=1)
    ordered = np.sort(simplices, axis=1)
    points = np.einsum("li,mie->mle", weights / parts, vertices[ordered])

    # a point is known by the vertices that carry it and their integer weights
    owner = np.where(weights[None] > 0, ordered[:, None, :], -1)
    keys = np.concatenate([owner, np.broadcast_to(weights, owner.shape)], axis=2).reshape(-1, 2 * (dimension + 1))
    keys = np.take_along_axis(
        keys.reshape(len(keys), 2, -1), np.argsort(keys.reshape(len(keys), 2, -1)[:, :1], axis=2), axis=2
    ).reshape(len(keys), -1)
    _, first, inverse = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    new_simplices = inverse.reshape(len(simplices), -1)[:, cells].reshape(-1, dimension + 1)
    new_vertices = points.reshape(-1, vertices.shape[1])[first]

    flipped = np.array([_parity(row) for row in np.argsort(simplices, axis=1)]) < 0
    odd = np.repeat(flipped, len(cells))
    new_simplices[odd] = new_simplices[odd][:, np.r_[1, 0, 2 : dimension + 1]]
    return new_vertices, new_simplices.astype(np.int64)


def _kuhn_simplex(dimension: int, parts: int) -> tuple[Integers, Integers]:
    points: dict[tuple[int, ...], int] = {}
    cells = []
    for corner in product(range(parts), repeat=dimension):
        for order in permutations(range(dimension)):
            walk = [np.array(corner)]
            for axis in order:
                walk.append(walk[-1] + np.eye(dimension, dtype=np.int64)[axis])
            if all((np.diff(point) <= 0).all() for point in walk):
                cell = [points.setdefault(tuple(int(c) for c in point), len(points)) for point in walk]
                if _parity(np.array(order)) < 0:
                    cell[0], cell[1] = cell[1], cell[0]
                cells.append(cell)
    return np.array(list(points), dtype=np.int64), np.array(cells, dtype=np.int64)


def _parity(order: Integers) -> int:
    inversions = sum(int(order[i] > order[j]) for i in range(len(order)) for j in range(i + 1, len(order)))
    return -1 if inversions % 2 else 1
