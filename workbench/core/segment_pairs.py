"""Pairs of segments in the plane whose boxes meet."""

from __future__ import annotations

import numba
import numpy as np

from workbench.core.arrays import Floats, Integers


def box_pairs(starts: Floats, ends: Floats) -> Integers:
    """Pairs (p, 2) of segments, lower number first, that may meet: boxes overlap, neither is clear of the other's line.

    Parameters
    ----------
    starts, ends : (b, 2) float64

    Sorted by their left ends and swept; releases the interpreter lock. Cost: O(b log b + pairs that overlap in x).
    """
    low, high = np.minimum(starts, ends), np.maximum(starts, ends)
    order = np.argsort(low[:, 0], kind="stable")
    ordered = [np.ascontiguousarray(part[order]) for part in (low, high, starts, ends)]
    empty = np.empty((0, 2), dtype=np.int64)
    pairs = np.empty((_sweep(*ordered, empty), 2), dtype=np.int64)
    _sweep(*ordered, pairs)
    return np.sort(order[pairs], axis=1)


@numba.njit(nogil=True, cache=True)
def _is_clear(p, q, a, b):  # type: ignore[no-untyped-def]
    """Whether a and b are surely on one side of the line p q."""
    dx, dy = q[0] - p[0], q[1] - p[1]
    left_a, right_a = dx * (a[1] - p[1]), dy * (a[0] - p[0])
    left_b, right_b = dx * (b[1] - p[1]), dy * (b[0] - p[0])
    margin_a, margin_b = 1e-14 * (abs(left_a) + abs(right_a)) + 1e-280, 1e-14 * (abs(left_b) + abs(right_b)) + 1e-280
    side_a, side_b = left_a - right_a, left_b - right_b
    return (side_a > margin_a and side_b > margin_b) or (side_a < -margin_a and side_b < -margin_b)


@numba.njit(nogil=True, cache=True)
def _sweep(low, high, starts, ends, out):  # type: ignore[no-untyped-def]
    count = 0
    for i in range(len(low)):
        for j in range(i + 1, len(low)):
            if low[j, 0] > high[i, 0]:
                break
            if low[j, 1] > high[i, 1] or high[j, 1] < low[i, 1]:
                continue
            if _is_clear(starts[i], ends[i], starts[j], ends[j]) or _is_clear(starts[j], ends[j], starts[i], ends[i]):
                continue
            if len(out):
                out[count, 0], out[count, 1] = i, j
            count += 1
    return count
