"""Columns of one structure, taken together: supernodes, merged with their parents where few zeros are stored in exchange."""

from __future__ import annotations

import numba
import numpy as np

SMALL, MIDDLE = 8, 32
"""Columns up to which much and some padding pays: dense routines are slow on narrow panels."""
MUCH, SOME, LITTLE = 0.7, 0.2, 0.07
"""Largest parts of stored zeros: in supernodes up to `SMALL`, up to `MIDDLE`, and in wider ones."""


@numba.njit(nogil=True, cache=True)
def supernode_starts(parent, counts, width):  # type: ignore[no-untyped-def]
    """(s + 1,) first column of each supernode, and n; a column stands for `width` coordinates.

    Parameters
    ----------
    parent, counts : (n,) int64      elimination tree in postorder, and entries of each column of the factor

    Source: Ashcraft, Grimes 1989, "The influence of relaxed supernode partitions on the multifrontal method".
    """
    n = len(parent)
    entries_before = np.zeros(n + 1, dtype=np.int64)
    entries_before[1:] = np.cumsum(counts)
    first = np.empty(n + 1, dtype=np.int64)  # of the supernodes so far; the last one may still be merged
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
    return first[: count + 1].copy()


@numba.njit(nogil=True, cache=True)
def supernode_rows(starts, neighbours, order, place, first, parent):  # type: ignore[no-untyped-def]
    """Rows of each supernode, ascending, its own columns first.

    Parameters
    ----------
    starts, neighbours           graph of the matrix
    order, place : (n,) int64    column -> vertex and back
    first : (s + 1,) int64
    parent : (s,) int64          of each supernode, s at the roots

    Returns
    -------
    (s + 1,) int64 starts of the rows; (r,) int64 rows; (r,) int64 place of each row among those of the parent, -1 where
    there is none (own columns, roots)
    """
    n, count = len(order), len(first) - 1
    row_starts = np.zeros(count + 1, dtype=np.int64)
    rows = np.empty(4 * n, dtype=np.int64)
    child_head = np.full(count + 1, -1, dtype=np.int64)
    sibling = np.full(count, -1, dtype=np.int64)
    mark = np.full(n, -1, dtype=np.int64)
    filled = 0
    for s in range(count):
        begin, end = first[s], first[s + 1]
        start = filled
        bound = end - begin
        for column in range(begin, end):
            bound += starts[order[column] + 1] - starts[order[column]]
        child = child_head[s]
        while child >= 0:
            bound += row_starts[child + 1] - row_starts[child]
            child = sibling[child]
        if filled + bound > len(rows):
            larger = np.empty(2 * (filled + bound), dtype=np.int64)
            larger[:filled] = rows[:filled]
            rows = larger
        for column in range(begin, end):
            mark[column] = s
            rows[filled] = column
            filled += 1
        for column in range(begin, end):
            vertex = order[column]
            for k in range(starts[vertex], starts[vertex + 1]):
                row = place[neighbours[k]]
                if row >= end and mark[row] != s:
                    mark[row] = s
                    rows[filled] = row
                    filled += 1
        child = child_head[s]
        while child >= 0:
            for k in range(row_starts[child] + first[child + 1] - first[child], row_starts[child + 1]):
                row = rows[k]
                if row >= end and mark[row] != s:
                    mark[row] = s
                    rows[filled] = row
                    filled += 1
            child = sibling[child]
        rows[start + end - begin : filled] = np.sort(rows[start + end - begin : filled])
        row_starts[s + 1] = filled
        if parent[s] < count:
            sibling[s] = child_head[parent[s]]
            child_head[parent[s]] = s
    rows = rows[:filled].copy()
    in_parent = np.full(filled, -1, dtype=np.int64)
    where = np.empty(n, dtype=np.int64)
    for s in range(count):
        above = parent[s]
        if above == count:
            continue
        for k in range(row_starts[above], row_starts[above + 1]):
            where[rows[k]] = k - row_starts[above]
        for k in range(row_starts[s] + first[s + 1] - first[s], row_starts[s + 1]):
            in_parent[k] = where[rows[k]]
    return row_starts, rows, in_parent
