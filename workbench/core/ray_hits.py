"""Where rays from one point leave a closed surface."""

from __future__ import annotations

import numba
import numpy as np

from workbench.core.arrays import Floats, Integers

_MARGIN = 1e-9
"""A ray hits a triangle whose barycentric coordinates are all above minus this: none slips through between two."""


def farthest_hits(centre: Floats, directions: Floats, triangles: Integers, vertices: Floats) -> tuple[Integers, Floats, Floats]:
    """The last triangle that each ray from `centre` goes through.

    Parameters
    ----------
    centre : (3,) float64
    directions : (k, 3) float64      of unit length
    triangles : (b, 3) int64
    vertices : (n, 3) float64

    Returns
    -------
    hit : (k,) int64                 -1 where a ray meets no triangle
    shares : (k, 3) float64          barycentric coordinates of the point in it
    distances : (k,) float64         from the centre; 0 where there is none

    Triangles are sorted by the height of their middle as seen from the centre, and those of other heights than the ray's are
    passed over. Releases the interpreter lock.
    """
    corners = vertices[triangles] - centre
    seen = corners / np.maximum(np.linalg.norm(corners, axis=2, keepdims=True), 1e-300)
    low, high = seen[:, :, 2].min(axis=1), seen[:, :, 2].max(axis=1)
    # a triangle seen from near bulges beyond its corners: by less than its own size on the sphere
    size = np.linalg.norm(seen - np.roll(seen, 1, axis=1), axis=2).max(axis=1)
    low, high = low - size, high + size
    order = np.argsort(low, kind="stable")
    hit = np.full(len(directions), -1, dtype=np.int64)
    shares, distances = np.zeros((len(directions), 3)), np.zeros(len(directions))
    longest = float((high - low).max())
    first = np.searchsorted(low[order], directions[:, 2] - longest - 1e-12)
    _cast(directions, corners[order], low[order], high[order], first, hit, shares, distances)
    found = hit >= 0
    hit[found] = order[hit[found]]
    return hit, shares, distances


@numba.njit(nogil=True, cache=True)
def _cast(directions, corners, low, high, first, hit, shares, distances):  # type: ignore[no-untyped-def]
    weights = np.empty(3)
    for ray in range(len(directions)):
        u = directions[ray]
        for k in range(first[ray], len(corners)):
            if low[k] > u[2]:
                break
            if high[k] < u[2]:
                continue
            # u = sum of weights times corners: determinants of the ray with each side
            volume = 0.0
            for i in range(3):
                p, q = corners[k, (i + 1) % 3], corners[k, (i + 2) % 3]
                weights[i] = (
                    u[0] * (p[1] * q[2] - p[2] * q[1]) + u[1] * (p[2] * q[0] - p[0] * q[2]) + u[2] * (p[0] * q[1] - p[1] * q[0])
                )
            p, q, r = corners[k, 0], corners[k, 1], corners[k, 2]
            volume = (
                r[0] * (p[1] * q[2] - p[2] * q[1]) + r[1] * (p[2] * q[0] - p[0] * q[2]) + r[2] * (p[0] * q[1] - p[1] * q[0])
            )
            total = weights[0] + weights[1] + weights[2]
            if total * volume <= 0.0 or (weights / total).min() < -_MARGIN:
                continue
            distance = volume / total
            if distance > distances[ray]:
                distances[ray], hit[ray] = distance, k
                shares[ray] = weights / total
