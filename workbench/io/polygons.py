"""Polygons to triangles and back."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from workbench.core.arrays import Integers


def fan(sizes: Integers) -> tuple[Integers, Integers]:
    """Triangles of polygons, each fanned from its first corner.

    Parameters
    ----------
    sizes : (f,) int64      corners of each polygon, at least 3; corners of all polygons stand one after another

    Returns
    -------
    corners, polygons : (m, 3) int64, (m,) int64      corner numbers of each triangle, and the polygon it is from
    """
    triangles = sizes - 2
    polygons = np.repeat(np.arange(len(sizes), dtype=np.int64), triangles)
    starts = (np.cumsum(sizes) - sizes)[polygons]
    within = np.arange(len(polygons)) - (np.cumsum(triangles) - triangles)[polygons]
    return np.column_stack([starts, starts + within + 1, starts + within + 2]), polygons


def unfan(triangles: Integers, polygons: Integers | None) -> list[list[int]]:
    """Faces of a mesh: triangles of one polygon put together again where they still form its fan.

    Parameters
    ----------
    triangles : (m, 3) int64
    polygons : (m,) int64, optional      polygon that each triangle was fanned from

    Returns
    -------
    list of lists      corners of each face, in the order of the triangles; a fan that was turned over as a whole runs
                       backwards from the same first corner, one that was cut or partly turned over falls into triangles
    """
    rows: list[list[int]] = triangles.tolist()
    if polygons is None:
        return rows
    bounds = [0, *(np.flatnonzero(np.diff(polygons)) + 1).tolist(), len(rows)]
    faces: list[list[int]] = []
    for begin, end in pairwise(bounds):
        part = rows[begin:end]
        face = _fan_of(part) or _reversed_fan_of(part)
        faces += [face] if face else part
    return faces


def _fan_of(part: list[list[int]]) -> list[int]:
    face = list(part[0])
    for apex, tail, head in part[1:]:
        if apex != face[0] or tail != face[-1]:
            return []
        face.append(head)
    return face


def _reversed_fan_of(part: list[list[int]]) -> list[int]:
    face = _fan_of([[apex, head, tail] for apex, tail, head in part])
    return face[:1] + face[:0:-1]
