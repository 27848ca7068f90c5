"""The inside of a level set as tetrahedra of good shape: a body-centred cubic lattice, warped and cut (isosurface stuffing).

Source: Labelle & Shewchuk 2007. Where they choose diagonals of cut faces by the kind of edge, here the lower number decides.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np

from workbench.core.arrays import Booleans, Floats, Integers

Implicit = Callable[[Floats], Floats]
"""(k, 3) points -> (k,) values, negative inside, of slope about one near the surface."""

_NEAR_LONG, _NEAR_SHORT = 0.24999, 0.41189
"""A lattice point moves to the surface where that cuts a long or a short edge within this part of its length."""
_CHUNK = 100_000


@dataclass(frozen=True, eq=False)
class _Cuts:
    """Lattice edges that the surface crosses: `inside`, `outside` (c,) ends, `points` (c, 3), `shares` (c,) from inside."""

    inside: Integers
    outside: Integers
    points: Floats
    shares: Floats
    is_long: Booleans


def stuffed_solid(implicit: Implicit, low: Floats, high: Floats, tetrahedra: int) -> tuple[Floats, Integers]:
    """Vertices (n, 3) and about `tetrahedra` positively oriented tetrahedra of the inside of `implicit`.

    Parameters
    ----------
    low, high : (3,) float64     a box that holds the surface; the thinnest part has to be some tetrahedra thick
    """
    spacing = _spacing(implicit, low, high, tetrahedra)
    points, cells = _lattice(low - spacing, high + spacing, spacing)
    values = _evaluated(implicit, points)
    signs = np.where(values < 0.0, 1, -1)
    cells = cells[(signs[cells] > 0).any(axis=1)]
    cuts = _cut_edges(implicit, points, cells, values)
    points, signs, is_left = _warped(points, signs, cuts)
    return _assembled(points, cells, signs, cuts, is_left)


def _spacing(implicit: Implicit, low: Floats, high: Floats, tetrahedra: int) -> float:
    """Side of the lattice's cubes, of twelve tetrahedra each; those that are cut give some more."""
    count = np.maximum(np.round((high - low) / (high - low).max() * 48.0).astype(int), 1)
    axes = [low[i] + (np.arange(count[i]) + 0.5) * (high[i] - low[i]) / count[i] for i in range(3)]
    samples = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    values = _evaluated(implicit, samples)
    cell = float(np.prod((high - low) / count))
    volume = cell * float(np.count_nonzero(values < 0.0))
    width = 2.0 * float((high - low).max()) / 48.0
    area = cell * float(np.count_nonzero(np.abs(values) < 0.5 * width)) / width
    spacing = float(np.cbrt(12.0 * volume / tetrahedra))
    for _ in range(20):  # a layer of the surface counts for more
        spacing = float(np.cbrt((12.0 * volume + 2.0 * area * spacing) / tetrahedra))
    return spacing


def _evaluated(implicit: Implicit, points: Floats) -> Floats:
    return np.concatenate([implicit(part) for part in np.array_split(points, 1 + len(points) // _CHUNK)])


def _lattice(low: Floats, high: Floats, spacing: float) -> tuple[Floats, Integers]:
    """Points (n, 3) of the body-centred cubic lattice and its tetrahedra: an edge of one grid, one of the other across it."""
    size = 2 * np.ceil((high - low) / spacing).astype(np.int64) + 1  # in halves of the spacing
    strides = np.array([size[1] * size[2], size[2], 1])
    even = np.stack(np.meshgrid(*[np.arange(0, s, 2) for s in size], indexing="ij"), axis=-1).reshape(-1, 3)
    cells = []
    for axis in range(3):
        unit, one, two = (np.eye(3, dtype=np.int64)[(axis + i) % 3] for i in range(3))
        ring = [one + two, one - two, -one - two, two - one]
        for i in range(4):
            corners = np.stack([even, even + 2 * unit, even + unit + ring[i], even + unit + ring[(i + 1) % 4]], axis=1)
            cells.append(corners[((corners >= 0) & (corners < size)).all(axis=(1, 2))])
    numbers = np.concatenate(cells) @ strides
    used, simplices = np.unique(numbers, return_inverse=True)
    places = np.stack([used // strides[0], used // strides[1] % size[1], used % size[2]], axis=1)
    return low + 0.5 * spacing * places, simplices.reshape(-1, 4)


def _cut_edges(implicit: Implicit, points: Floats, cells: Integers, values: Floats) -> _Cuts:
    pairs = np.concatenate([cells[:, [i, j]] for i in range(4) for j in range(i)])
    pairs = pairs[(values[pairs[:, 0]] < 0.0) != (values[pairs[:, 1]] < 0.0)]
    pairs = np.unique(np.where((values[pairs[:, :1]] < 0.0), pairs, pairs[:, ::-1]), axis=0)
    a, b = points[pairs[:, 0]], points[pairs[:, 1]]
    low, high = np.zeros(len(pairs)), np.ones(len(pairs))
    for _ in range(30):
        middle = 0.5 * (low + high)
        is_inside = _evaluated(implicit, a + middle[:, None] * (b - a)) < 0.0
        low, high = np.where(is_inside, middle, low), np.where(is_inside, high, middle)
    lengths = np.linalg.norm(b - a, axis=1)
    return _Cuts(pairs[:, 0], pairs[:, 1], a + low[:, None] * (b - a), low, lengths > 1.05 * lengths.min(initial=np.inf))


def _warped(points: Floats, signs: Integers, cuts: _Cuts) -> tuple[Floats, Integers, Booleans]:
    """Points moved to the nearest cut of theirs that is too near; their sign is 0, and the other cuts of their edges go."""
    near = np.where(cuts.is_long, _NEAR_LONG, _NEAR_SHORT)
    ends = np.concatenate([cuts.inside, cuts.outside])
    distances = np.concatenate([cuts.shares, 1.0 - cuts.shares])
    numbers = np.tile(np.arange(len(cuts.inside)), 2)
    lengths = np.where(cuts.is_long, 1.0, np.sqrt(0.75))
    # edge by edge the nearest first, so that of two points near cuts the nearer one moves
    order = np.lexsort((ends, (distances * np.tile(lengths, 2))))
    points, signs = points.copy(), signs.copy()
    of_vertex: dict[int, list[int]] = {}
    for end, number in zip(ends.tolist(), numbers.tolist(), strict=True):
        of_vertex.setdefault(end, []).append(number)
    is_left = np.ones(len(cuts.inside), dtype=bool)
    candidates = order[(distances < np.tile(near, 2))[order]]
    for place in candidates.tolist():
        vertex, number = int(ends[place]), int(numbers[place])
        if is_left[number]:
            points[vertex], signs[vertex] = cuts.points[number], 0
            is_left[of_vertex[vertex]] = False
    return points, signs, is_left


def _assembled(points: Floats, cells: Integers, signs: Integers, cuts: _Cuts, is_left: Booleans) -> tuple[Floats, Integers]:
    """What lies inside of each lattice tetrahedron."""
    size = len(points)
    keys = (cuts.inside * size + cuts.outside)[is_left]  # ascending: the pairs were made unique
    vertices = np.concatenate([points, cuts.points[is_left]])

    def cut(inside: Integers, outside: Integers) -> Integers:
        return size + np.searchsorted(keys, inside * size + outside)

    # corners inside first, then those on the surface, then those outside; by number within
    ordered = np.take_along_axis(cells, np.lexsort((cells, -signs[cells]), axis=1), axis=1)
    counts = [np.count_nonzero(signs[ordered] == sign, axis=1) for sign in (1, 0, -1)]
    pieces = [ordered[(counts[0] > 0) & (counts[2] == 0)]]
    for zeros, outside in product(range(3), range(1, 4)):
        if zeros + outside == 3:
            a, *others = ordered[(counts[0] == 1) & (counts[2] == outside)].T
            pieces.append(np.stack([a, *others[:zeros], *(cut(a, d) for d in others[zeros:])], axis=1))
    a, b, c, d = ordered[(counts[0] == 2) & (counts[1] == 1) & (counts[2] == 1)].T
    pieces += [np.stack([a, b, c, cut(b, d)], axis=1), np.stack([a, c, cut(a, d), cut(b, d)], axis=1)]
    a, b, c, d = ordered[(counts[0] == 2) & (counts[2] == 2)].T
    pieces += [np.stack([a, b, cut(b, c), cut(b, d)], axis=1)]
    pieces += [np.stack([a, cut(a, c), cut(b, d), last], axis=1) for last in (cut(a, d), cut(b, c))]
    a, b, c, d = ordered[(counts[0] == 3) & (counts[2] == 1)].T
    pieces += [np.stack([a, b, c, cut(c, d)], axis=1), np.stack([a, b, cut(b, d), cut(c, d)], axis=1)]
    pieces += [np.stack([a, cut(a, d), cut(b, d), cut(c, d)], axis=1)]

    simplices = np.concatenate(pieces)
    edges = vertices[simplices[:, 1:]] - vertices[simplices[:, :1]]
    negative = np.linalg.det(edges) < 0.0
    simplices[negative] = simplices[negative][:, [1, 0, 2, 3]]
    used, renumbered = np.unique(simplices, return_inverse=True)
    return vertices[used], renumbered.reshape(-1, 4).astype(np.int64)
