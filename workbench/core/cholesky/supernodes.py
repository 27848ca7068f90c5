"""Columns of one structure, taken together: supernodes, merged with their parents where few zeros are stored in exchange."""

from __future__ import annotations

import numba
import numpy as np

from workbench.core.arrays import Integers

SMALL, MIDDLE = 8, 32
"""Columns up to which much and some padding pays: dense routines are slow on narrow panels."""
MUCH, SOME, LITTLE = 0.7, 0.2, 0.07
"""Largest parts of stored zeros: in supernodes up to `SMALL`, up to `MIDDLE`, and in wider ones."""


def supernode_starts(parent: Integers, counts: Integers, width: int) -> Integers:
    """(s + 1,) first column of each supernode, and n; a column stands for `width` coordinates.

    Parameters
    ----------
    parent, counts : (n,) int64      elimination tree in postorder, and entries of each column of the factor

    Source: Ashcraft, Grimes 1989, "The influence of relaxed supernode partitions on the multifrontal method".
    """
    first = np.empty(len(parent) + 1, dtype=np.int64)
    count = _merge(parent, counts, np.concatenate([[0], np.cumsum(counts)]), width, first)
    return first[: count + 1].copy()


@numba.njit(nogil=True, cache=True)
def _merge(parent, counts, entries_before, width, first):  # type: ignore[no-untyped-def]
    """Write `first`, where the last supernode so far may still be merged; how many there are."""
    n = len(parent)
    count = 0
    end = 0
    while end < n:
        begin = end
        end += 1
        while end < n and parent[end - 1] == end and counts[end] == counts[end - 1] - 1:
            end += 1
        below = counts[end - 1] - 1
        while count > 0 and parent[begin - 1] < end:
            columns = end - first[count - 1]
            stored = columns * (columns + 1) // 2 + columns * below
            padding = 1.0 - (entries_before[end] - entries_before[first[count - 1]]) / stored
            allowed = MUCH if columns * width <= SMALL else SOME if columns * width <= MIDDLE else LITTLE
            if padding > allowed:
                break
            count -= 1
            begin = first[count]
        first[count] = begin
        count += 1
    first[count] = n
    return count


def supernode_rows(
    starts: Integers,
    neighbours: Integers,
    order: Integers,
    place: Integers,
    first: Integers,
    parent: Integers,
    counts: Integers,
) -> tuple[Integers, Integers, Integers]:
    """Rows of each supernode, ascending, its own columns first.

    Parameters
    ----------
    starts, neighbours           graph of the matrix
    order, place : (n,) int64    column -> vertex and back
    first : (s + 1,) int64
    parent : (s,) int64          of each supernode, s at the roots
    counts : (n,) int64          entries of each column of the factor

    Returns
    -------
    (s + 1,) int64 starts of the rows; (r,) int64 rows; (r,) int64 place of each row among those of the parent, -1 where
    there is none (own columns, roots)
    """
    n, count = len(order), len(first) - 1
    row_starts = np.concatenate([[0], np.cumsum(np.diff(first) + counts[first[1:] - 1] - 1)])
    rows = np.empty(row_starts[-1], dtype=np.int64)
    _gather_rows(starts, neighbours, order, place, first, parent, row_starts, rows)
    owner = np.repeat(np.arange(count), np.diff(row_starts))
    keys = np.sort(owner * n + rows)
    rows = keys - owner * n
    in_parent = np.full(len(rows), -1, dtype=np.int64)
    passed_on = (rows >= first[owner + 1]) & (parent[owner] < count)
    above = parent[owner[passed_on]]
    in_parent[passed_on] = np.searchsorted(keys, above * n + rows[passed_on]) - row_starts[above]
    return row_starts, rows, in_parent


@numba.njit(nogil=True, cache=True)
def _gather_rows(starts, neighbours, order, place, first, parent, row_starts, rows):  # type: ignore[no-untyped-def]
    """Write the rows of every supernode: its columns, what the matrix has below them, and what its children pass on."""
    n, count = len(order), len(first) - 1
    child_head = np.full(count + 1, -1, dtype=np.int64)
    sibling = np.full(count, -1, dtype=np.int64)
    mark = np.full(n, -1, dtype=np.int64)
    for s in range(count):
        filled, end = row_starts[s], first[s + 1]
        for column in range(first[s], end):
            rows[filled] = column
            filled += 1
            vertex = order[column]
            for k in range(starts[vertex], starts[vertex + 1]):
                row = place[neighbours[k]]
                if row >= end and mark[row] != s:
                    mark[row] = s
                    rows[filled] = row
                    filled += 1
        child = child_head[s]
        while child >= 0:
            for k in range(row_starts[child], row_starts[child + 1]):
                row = rows[k]
                if row >= end and mark[row] != s:
                    mark[row] = s
                    rows[filled] = row
                    filled += 1
            child = sibling[child]
        sibling[s] = child_head[parent[s]]
        child_head[parent[s]] = s
