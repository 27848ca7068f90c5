"""Structured samples: bar, annulus, bumpy disc, Hilbert strip, solid bar."""

from __future__ import annotations

from itertools import permutations

import numpy as np

from workbench.core.arrays import Floats, Integers


def bar(triangles: int, length: float = 4.0, height: float = 1.0) -> tuple[Floats, Integers]:
    """Vertices (n, 2) and triangles of a rectangle."""
    spacing = np.sqrt(length * height / triangles * 4.0 / np.sqrt(3.0))
    rows = max(2, round(height / (spacing * np.sqrt(0.75))))
    columns = max(2, round(length / spacing))
    return _staggered_strip(length, height, columns, rows)


def annulus(triangles: int, inner: float = 0.4, outer: float = 1.0) -> tuple[Floats, Integers]:
    """Vertices (n, 2) and triangles of a ring; the rows grow geometrically, so triangles stay near-equilateral."""
    # a ring has 2 count triangles; ring widths are sqrt(3)/2 of the spacing 2 pi r / count
    count = max(8, round(np.sqrt(triangles * np.pi * np.sqrt(0.75) / np.log(outer / inner))))
    rings = max(1, round(np.log(outer / inner) * count / (2.0 * np.pi * np.sqrt(0.75))))
    ring, step = np.meshgrid(np.arange(rings + 1), np.arange(count), indexing="ij")
    radius = inner * (outer / inner) ** (ring / rings)
    angle = 2.0 * np.pi * (step + 0.5 * (ring % 2)) / count
    vertices = np.stack([(radius * np.cos(angle)).ravel(), (radius * np.sin(angle)).ravel()], axis=1)
    a, b = np.meshgrid(np.arange(rings), np.arange(count), indexing="ij")
    here, beyond = a * count + b, a * count + (b + 1) % count
    up, up_beyond = here + count, beyond + count
    even = np.stack([here, up, beyond, beyond, up, up_beyond], axis=-1)
    odd = np.stack([here, up, up_beyond, here, up_beyond, beyond], axis=-1)
    return vertices, np.where((a % 2 == 0)[..., None], even, odd).reshape(-1, 3).astype(np.int64)


def bumpy_disc(triangles: int) -> tuple[Floats, Integers]:
    """Vertices (n, 3) and triangles of a disc with hills and hollows."""
    plane, simplices = hexagonal_disc(max(2, round(np.sqrt(triangles / 6.0))))
    x, y = plane.T
    height = (
        0.16 * np.sin(5.2 * x + 0.4) * np.cos(4.4 * y - 0.3)
        + 0.07 * np.sin(9.0 * x - 5.0 * y)
        + 0.42 * np.exp(-((x - 0.30) ** 2 + (y - 0.22) ** 2) / 0.035)
        + 0.30 * np.exp(-((x + 0.42) ** 2 + (y - 0.10) ** 2) / 0.030)
        - 0.30 * np.exp(-((x + 0.05) ** 2 + (y + 0.48) ** 2) / 0.045)
    )
    return np.column_stack([plane, height]), simplices


def hexagonal_disc(rings: int) -> tuple[Floats, Integers]:
    """Unit disc of 6 rings^2 triangles: `rings` circles about the centre, the k-th of 6 k vertices; (n, 2), (m, 3)."""
    ring = np.repeat(np.arange(1, rings + 1), 6 * np.arange(1, rings + 1))
    first = 1 + 3 * ring * (ring - 1)  # index of the first vertex of each ring
    place = np.arange(1, len(ring) + 1) - first
    angle = 2.0 * np.pi * place / (6 * ring)
    radius = ring / rings
    vertices = np.vstack([np.zeros((1, 2)), np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)])

    # triangles with a side on ring k and the tip on ring k - 1, then those with a side on ring k - 1
    sector, inner_place = place // ring, place % ring
    beyond = first + (place + 1) % (6 * ring)
    below_first = np.where(ring > 1, 1 + 3 * (ring - 1) * (ring - 2), 0)
    below_count = np.maximum(6 * (ring - 1), 1)
    tip = below_first + (sector * (ring - 1) + inner_place) % below_count
    outward = np.stack([first + place, beyond, tip], axis=1)
    inward_mask = inner_place > 0
    tip_before = below_first + (sector * (ring - 1) + inner_place - 1) % below_count
    inward = np.stack([tip_before, first + place, tip], axis=1)[inward_mask]
    return vertices, np.vstack([outward, inward]).astype(np.int64)


def hilbert_strip(triangles: int, order: int = 4, thickness: float = 0.56) -> tuple[Floats, Integers]:
    """Vertices (n, 3) and triangles of a ribbon that follows a Hilbert curve over gentle waves (Fig. 11)."""
    centre = _rounded_curve(_hilbert_corners(order))
    steps = np.linalg.norm(np.diff(centre, axis=0), axis=1)
    arc = np.concatenate([[0.0], np.cumsum(steps)])
    length = arc[-1]
    flat, simplices = bar(triangles, length, thickness)
    along, across = flat[:, 0], flat[:, 1] - 0.5 * thickness
    tangents = np.gradient(centre, arc, axis=0, edge_order=2)
    place = np.stack([np.interp(along, arc, centre[:, axis]) for axis in (0, 1)], axis=1)
    tangent = np.stack([np.interp(along, arc, tangents[:, axis]) for axis in (0, 1)], axis=1)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    plane = place + across[:, None] * np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
    side = 2.0**order - 1.0
    plane = 2.0 * plane / side - 1.0
    waves = 0.12 * np.cos(2.2 * plane[:, 0] + 0.5) * np.cos(2.6 * plane[:, 1])
    return np.column_stack([plane, waves]), simplices


def solid_bar(tetrahedra: int, length: float = 4.0) -> tuple[Floats, Integers]:
    """Vertices (n, 3) and tetrahedra (six to a cube) of a bar with a unit square section."""
    across = max(1, round((tetrahedra / (6.0 * length)) ** (1.0 / 3.0)))
    counts = np.array([round(length * across), across, across])
    axes = [np.linspace(0.0, size, count + 1) for size, count in zip((length, 1.0, 1.0), counts, strict=True)]
    vertices = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    strides = np.array([(counts[1] + 1) * (counts[2] + 1), counts[2] + 1, 1])
    corners = np.stack(np.meshgrid(*[np.arange(count) for count in counts], indexing="ij"), axis=-1).reshape(-1, 3)
    cells = []
    for order in permutations(range(3)):
        walk = [corners @ strides]
        for axis in order:
            walk.append(walk[-1] + strides[axis])
        if order in ((1, 0, 2), (0, 2, 1), (2, 1, 0)):  # odd orders of the axes
            walk[0], walk[1] = walk[1], walk[0]
        cells.append(np.stack(walk, axis=1))
    return vertices, np.stack(cells, axis=1).reshape(-1, 4).astype(np.int64)


def _staggered_strip(length: float, height: float, columns: int, rows: int) -> tuple[Floats, Integers]:
    """Rows of near-equilateral triangles; odd rows are shifted by half a column and have one vertex more."""
    starts, points = [], []
    total = 0
    for row in range(rows + 1):
        inner = (np.arange(columns) + 0.5) / columns
        x = np.linspace(0.0, 1.0, columns + 1) if row % 2 == 0 else np.concatenate([[0.0], inner, [1.0]])
        points.append(np.stack([length * x, np.full(len(x), height * row / rows)], axis=1))
        starts.append(total)
        total += len(x)
    column = np.arange(columns)
    simplices = []
    for row in range(rows):
        even, odd = (row, row + 1) if row % 2 == 0 else (row + 1, row)
        a, b = starts[even] + column, starts[odd] + column
        pieces = [
            np.stack([a, a + 1, b + 1], axis=1),  # side on the even row
            np.stack([a, b + 1, b], axis=1),  # side on the odd row, with the half triangle of the left end
            np.array([[starts[even] + columns, starts[odd] + columns + 1, starts[odd] + columns]]),  # right end
        ]
        block = np.vstack(pieces)
        simplices.append(block if row % 2 == 0 else block[:, ::-1])
    return np.vstack(points), np.vstack(simplices).astype(np.int64)


def _hilbert_corners(order: int) -> Floats:
    """Corners (4^order, 2) of the Hilbert curve on the integer grid, in order."""
    points = np.zeros((1, 2))
    for level in range(order):
        size = 2.0**level
        transposed = points[:, ::-1]
        points = np.vstack(
            [
                transposed,
                points + [0.0, size],
                points + [size, size],
                np.array([2.0 * size - 1.0, size - 1.0]) - transposed,
            ]
        )
    return points


def _rounded_curve(corners: Floats, samples: int = 24) -> Floats:
    """The polyline with every right angle replaced by a quarter circle between the middles of its sides."""
    middles = 0.5 * (corners[1:] + corners[:-1])
    pieces = [corners[:1] + (middles[:1] - corners[:1]) * t for t in np.linspace(0.0, 1.0, samples, endpoint=False)]
    angle = np.linspace(0.0, 0.5 * np.pi, samples, endpoint=False)[:, None]
    for before, corner, after in zip(middles[:-1], corners[1:-1], middles[1:], strict=True):
        centre = before + after - corner
        if np.allclose(centre, corner):  # straight on
            pieces.append(before + (after - before) * np.linspace(0.0, 1.0, samples, endpoint=False)[:, None])
        else:
            pieces.append(centre + (before - centre) * np.cos(angle) + (after - centre) * np.sin(angle))
    last = np.linspace(0.0, 1.0, samples + 1)[:, None]
    pieces.append(middles[-1:] + (corners[-1:] - middles[-1:]) * last)
    return np.vstack(pieces)
