"""The filter against blocked steps: the nearest direction along which no simplex loses its content at once."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numba
import numpy as np

from workbench.core.arrays import Floats

if TYPE_CHECKING:
    from workbench.core.problem import Problem

DAMPING = 0.5
"""Part of each Jacobi update that is taken."""
SETTLED = 1e-6
"""Largest violation, in parts of a simplex's own content, at which the iterations end."""


def unblocked_direction(problem: Problem, positions: Floats, direction: Floats, iterations: int) -> Floats:
    """Minimiser p of |p - direction|^2 with a_t + (grad a_t) . p >= 0 for every simplex, a_t its signed content.

    Parameters
    ----------
    positions : (N, d) float64      every simplex positively oriented
    direction : (N, d) float64
    iterations : int                at most so many damped projected Jacobi iterations on the multipliers

    Returns
    -------
    (N, d) float64      `direction` itself where nothing is blocked; hard anchors do not move

    Source: Zhu, Bridson, Kaufman 2018, section 5. Cost: O(m) an iteration; none of it where nothing is blocked.
    """
    simplices = problem.elements.simplices
    d = problem.dimension
    corners = np.empty((len(simplices), d + 1, d))
    contents = np.empty(len(simplices))
    held = np.zeros(len(positions), dtype=np.bool_)
    held[problem.anchors.hard_vertices] = True
    if not _content_gradients(positions, direction, simplices, held, corners, contents):
        return direction
    moved = direction.copy()
    _projected_jacobi(simplices, corners, contents, moved, iterations, DAMPING, SETTLED)
    return moved


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _content_gradients(x, p, simplices, held, corners, contents):  # type: ignore[no-untyped-def]
    """Write contents a (m,) and their gradients (m, d + 1, d), zero at held vertices; whether `p` takes all of some a."""
    d = x.shape[1]
    blocked = False
    for e in range(simplices.shape[0]):
        g = corners[e]
        if d == 2:
            i, j, k = simplices[e, 0], simplices[e, 1], simplices[e, 2]
            g[0, 0], g[0, 1] = x[j, 1] - x[k, 1], x[k, 0] - x[j, 0]
            g[1, 0], g[1, 1] = x[k, 1] - x[i, 1], x[i, 0] - x[k, 0]
            g[2, 0], g[2, 1] = x[i, 1] - x[j, 1], x[j, 0] - x[i, 0]
        else:
            o = x[simplices[e, 0]]
            for c in range(3):
                # the gradient by one corner is the cross product of the edges to the next two
                b, t = x[simplices[e, (c + 1) % 3 + 1]], x[simplices[e, (c + 2) % 3 + 1]]
                b0, b1, b2 = b[0] - o[0], b[1] - o[1], b[2] - o[2]
                t0, t1, t2 = t[0] - o[0], t[1] - o[1], t[2] - o[2]
                g[c + 1, 0], g[c + 1, 1], g[c + 1, 2] = b1 * t2 - b2 * t1, b2 * t0 - b0 * t2, b0 * t1 - b1 * t0
            for c in range(3):
                g[0, c] = -g[1, c] - g[2, c] - g[3, c]
        a = 0.0
        for c in range(d):
            a += g[1, c] * (x[simplices[e, 1], c] - x[simplices[e, 0], c])
        contents[e] = a
        change = a
        for v in range(d + 1):
            for c in range(d):
                if held[simplices[e, v]]:
                    g[v, c] = 0.0
                change += g[v, c] * p[simplices[e, v], c]
        blocked |= change < 0.0
    return blocked


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _projected_jacobi(simplices, corners, contents, p, iterations, damping, settled):  # type: ignore[no-untyped-def]
    """Add C^T lambda to p, lambda >= 0 complementary to a + C p >= 0."""
    m, d = simplices.shape[0], p.shape[1]
    multipliers = np.zeros(m)
    change = np.zeros_like(p)
    for _ in range(iterations):
        worst = 0.0
        for e in range(m):
            left, size = contents[e], 0.0
            for v in range(d + 1):
                for c in range(d):
                    left += corners[e, v, c] * p[simplices[e, v], c]
                    size += corners[e, v, c] ** 2
            if size == 0.0 or (left >= 0.0 and multipliers[e] == 0.0):
                continue
            following = max(0.0, multipliers[e] - damping * left / size)
            step = following - multipliers[e]
            multipliers[e] = following
            worst = max(worst, -left / contents[e])
            for v in range(d + 1):
                for c in range(d):
                    change[simplices[e, v], c] += step * corners[e, v, c]
        for i in range(p.shape[0]):
            for c in range(d):
                p[i, c] += change[i, c]
                change[i, c] = 0.0
        if worst <= settled:
            return
