"""Well-shaped triangles in a smooth region of the plane that is given by an implicit function."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy

from workbench.core.arrays import Floats, Integers

Implicit = Callable[[Floats], Floats]
"""(k, 2) points -> (k,) values, negative inside, of slope about one near the boundary."""

_SMOOTHING_ROUNDS = 5


def trace_outline(implicit: Implicit, first: tuple[float, float], step: float) -> Floats:
    """Points (k, 2) along the level set 0 through a point near `first`, counter-clockwise; dense, for arc lengths.

    The level set must be one smooth closed curve whose radius of curvature is well above `step`.
    """
    point = _project(implicit, np.array([first], dtype=np.float64))
    outline = [point[0]]
    while True:
        normal = _gradient(implicit, point)
        normal /= np.linalg.norm(normal)
        tangent = np.stack([-normal[:, 1], normal[:, 0]], axis=1)
        point = _project(implicit, point + step * tangent)
        if len(outline) > 4 and np.linalg.norm(point[0] - outline[0]) < 0.75 * step:
            return _project(implicit, resample_closed(np.array(outline), 16 * len(outline)))
        outline.append(point[0])
        if len(outline) > 200_000:
            raise RuntimeError("the outline does not close")


def resample_closed(outline: Floats, count: int) -> Floats:
    """`count` points at equal arc length along a closed polyline `(k, 2)`."""
    closed = np.vstack([outline, outline[:1]])
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    wanted = np.linspace(0.0, arc[-1], count, endpoint=False)
    return np.stack([np.interp(wanted, arc, closed[:, axis]) for axis in (0, 1)], axis=1)


def enclosed_area(outline: Floats) -> float:
    """Signed area of a closed polygon `(k, 2)`."""
    following = np.roll(outline, -1, axis=0)
    return float(0.5 * np.sum(outline[:, 0] * following[:, 1] - outline[:, 1] * following[:, 0]))


def mesh_region(implicit: Implicit, outline: Floats, triangles: int) -> tuple[Floats, Integers]:
    """Triangulate the inside of `implicit`.

    A hexagonal lattice inside, points at equal distances on the outline, then rounds of Delaunay triangulation
    and moves of the inner vertices to the area-weighted mean of their triangles' centroids.

    Parameters
    ----------
    outline : (k, 2) float64     the level set 0, finer than the mesh
    triangles : int              about how many

    Returns
    -------
    vertices (n, 2), the outline's first; triangles (m, 3), counter-clockwise
    """
    spacing = np.sqrt(enclosed_area(outline) / triangles * 4.0 / np.sqrt(3.0))
    length = np.linalg.norm(np.diff(np.vstack([outline, outline[:1]]), axis=0), axis=1).sum()
    border = _project(implicit, resample_closed(outline, max(12, round(length / spacing))))
    lattice = _hexagonal_lattice(outline.min(axis=0), outline.max(axis=0), spacing)
    points = np.vstack([border, lattice[implicit(lattice) < -0.6 * spacing]])
    simplices = _inner_delaunay(implicit, points, len(border))
    for _ in range(_SMOOTHING_ROUNDS):
        points = _smoothed(points, simplices, len(border))
        simplices = _inner_delaunay(implicit, points, len(border))
    return points, simplices


def _hexagonal_lattice(low: Floats, high: Floats, spacing: float) -> Floats:
    height = spacing * np.sqrt(0.75)
    rows = np.arange(int((high[1] - low[1]) / height) + 2)
    columns = np.arange(int((high[0] - low[0]) / spacing) + 3)
    row, column = np.meshgrid(rows, columns, indexing="ij")
    x = low[0] + (column - 1 + 0.5 * (row % 2)) * spacing
    y = low[1] + row * height
    return np.stack([x.ravel(), y.ravel()], axis=1)


def _inner_delaunay(implicit: Implicit, points: Floats, border_count: int) -> Integers:
    simplices = scipy.spatial.Delaunay(points).simplices.astype(np.int64)
    first, second = points[simplices[:, 1]] - points[simplices[:, 0]], points[simplices[:, 2]] - points[simplices[:, 0]]
    clockwise = first[:, 0] * second[:, 1] < first[:, 1] * second[:, 0]
    simplices[clockwise] = simplices[clockwise, ::-1]
    # the outline is resolved, so only triangles with all corners on it can lie outside
    doubtful = np.flatnonzero((simplices < border_count).all(axis=1))
    outside = implicit(points[simplices[doubtful]].mean(axis=1)) >= 0
    return np.delete(simplices, doubtful[outside], axis=0)


def _smoothed(points: Floats, simplices: Integers, fixed: int) -> Floats:
    corners = points[simplices]
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    centroid = corners.mean(axis=1)
    index = simplices.ravel()
    weight = np.bincount(index, np.repeat(area, 3), len(points))
    moved = points.copy()
    for axis in (0, 1):
        total = np.bincount(index, np.repeat(area * centroid[:, axis], 3), len(points))
        moved[fixed:, axis] = total[fixed:] / weight[fixed:]
    return moved


def _gradient(implicit: Implicit, points: Floats) -> Floats:
    step = 1e-5
    moves = step * np.array([(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)])
    value = implicit((points[None] + moves[:, None]).reshape(-1, 2)).reshape(4, -1)
    return np.stack([value[0] - value[1], value[2] - value[3]], axis=1) / (2 * step)


def _project(implicit: Implicit, points: Floats) -> Floats:
    for _ in range(2):
        gradient = _gradient(implicit, points)
        points = points - (implicit(points) / np.sum(gradient**2, axis=1))[:, None] * gradient
    return points
