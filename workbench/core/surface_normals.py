"""Normals of a surface at its vertices."""

from __future__ import annotations

import math

import numba
import numpy as np

from workbench.core.arrays import Floats, Integers


def vertex_normals(vertices: Floats, triangles: Integers) -> Floats:
    """Unit normals (n, 3) of a surface: means of those of the triangles at each vertex, weighted by their areas.

    Parameters
    ----------
    vertices : (n, 3) float64
    triangles : (m, 3) int64     a vertex that none of them names has the normal 0

    Cost: O(n + m), releases the interpreter lock.
    """
    normals = np.zeros((len(vertices), 3))
    _add_normals(np.ascontiguousarray(vertices, dtype=np.float64), triangles, normals)
    return normals


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _add_normals(x, triangles, normals):  # type: ignore[no-untyped-def]
    for e in range(triangles.shape[0]):
        i, j, k = triangles[e, 0], triangles[e, 1], triangles[e, 2]
        p0, p1, p2 = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1], x[j, 2] - x[i, 2]
        q0, q1, q2 = x[k, 0] - x[i, 0], x[k, 1] - x[i, 1], x[k, 2] - x[i, 2]
        n0, n1, n2 = p1 * q2 - p2 * q1, p2 * q0 - p0 * q2, p0 * q1 - p1 * q0
        for c in range(3):
            v = triangles[e, c]
            normals[v, 0] += n0
            normals[v, 1] += n1
            normals[v, 2] += n2
    for v in range(normals.shape[0]):
        length = math.sqrt(normals[v, 0] ** 2 + normals[v, 1] ** 2 + normals[v, 2] ** 2)
        if length > 0.0:
            for c in range(3):
                normals[v, c] /= length
