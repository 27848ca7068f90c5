"""The symbolic analysis: once a pattern, for all factorisations on it."""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np

from workbench.core.arrays import Integers
from workbench.core.cholesky.layout import Layout
from workbench.core.cholesky.supernodes import supernode_rows, supernode_starts
from workbench.core.cholesky.tree import column_counts, elimination_tree, postorder
from workbench.core.pattern import HessianPattern

SHARES = 16
"""Subtrees that are factorised side by side have at most this part of all the work each."""
LITTLE_WORK = 4e7
"""Columns times squared heights, summed, up to which sharing the work costs more than it saves."""


@dataclass(frozen=True, eq=False)
class SymbolicFactor:
    """What a pattern tells about the factors on it.

    Parameters
    ----------
    order : (N,) int64           coordinate of the matrix at each place of the postorder
    layout : Layout
    workspace_size : int         numbers that update matrices take
    subtrees : (t, 2) int64      first supernode and end of pieces that know nothing of each other
    top : (k,) int64             supernodes above them, ascending
    """

    order: Integers
    layout: Layout
    workspace_size: int
    subtrees: Integers
    top: Integers

    @property
    def size(self) -> int:
        return len(self.order)

    @property
    def factor_size(self) -> int:
        """Numbers that the factor stores, padding and upper triangles of panels among them."""
        return int(self.layout.panel_starts[-1])


def analyse_pattern(pattern: HessianPattern) -> SymbolicFactor:
    """Analysis of a pattern whose vertices are in a fill-reducing order already."""
    return analyse_matrix(pattern.column_starts, pattern.rows, pattern.dimension, np.arange(len(pattern.order)))


def analyse_matrix(column_starts: Integers, matrix_rows: Integers, d: int, eliminated: Integers) -> SymbolicFactor:
    """Analysis of a symmetric matrix of d x d blocks.

    Parameters
    ----------
    column_starts : (dn + 1,) int64, matrix_rows : (nnz,) int64
        its lower triangle by columns, rows ascending, all of the diagonal and of every block there
    eliminated : (n,) int64      blocks in a fill-reducing order
    """
    starts, neighbours = _block_graph(column_starts, matrix_rows, d)
    n = len(starts) - 1
    turn = _inverse(eliminated)
    tree = elimination_tree(starts, neighbours, eliminated, turn)
    weight = column_counts(starts, neighbours, eliminated, turn, tree)
    relabelled = postorder(tree, weight)
    parent = np.append(_inverse(relabelled), n)[tree[relabelled]]
    counts = weight[relabelled]
    order = eliminated[relabelled]
    place = _inverse(order)

    first = supernode_starts(parent, counts, d)
    count = len(first) - 1
    supernode_of = np.repeat(np.arange(count), np.diff(first))
    parents = np.append(supernode_of, count)[parent[first[1:] - 1]]
    row_starts, rows, in_parent = supernode_rows(starts, neighbours, order, place, first, parents, counts)

    columns = d * np.diff(first)
    heights = d * np.diff(row_starts)
    panel_starts = np.concatenate([[0], np.cumsum(columns * heights)])
    update_sizes = heights - columns
    work = columns.astype(np.float64) * heights**2
    subtrees, top = _split(parents, work)
    update_starts, scratch_starts, workspace_size = _workspace(parents, update_sizes, subtrees, top)
    children = np.argsort(parents, kind="stable")
    children_starts = np.searchsorted(parents[children], np.arange(count + 1))

    coordinate_order = (d * order[:, None] + np.arange(d)).reshape(-1)
    expanded = (d * rows[:, None] + np.arange(d)).reshape(-1)
    expanded_in_parent = np.where(in_parent[:, None] < 0, 0, d * in_parent[:, None] + np.arange(d)).reshape(-1)
    entries, targets, entry_starts = _entry_targets(
        column_starts, matrix_rows, _inverse(coordinate_order), d * first, d * row_starts, expanded, panel_starts
    )
    layout = Layout(
        first=d * first,
        row_starts=d * row_starts,
        rows=expanded.astype(np.uint32),
        in_parent=expanded_in_parent.astype(np.uint32),
        panel_starts=panel_starts,
        children_starts=children_starts,
        children=children,
        entry_starts=entry_starts,
        entries=entries,
        targets=targets,
        update_starts=update_starts,
        scratch_starts=scratch_starts,
    )
    return SymbolicFactor(coordinate_order, layout, workspace_size, subtrees, top)


def _inverse(order: Integers) -> Integers:
    place = np.empty_like(order)
    place[order] = np.arange(len(order))
    return place


@numba.njit(nogil=True, cache=True)
def _block_graph(column_starts, rows, d):  # type: ignore[no-untyped-def]
    """Both triangles of the graph of blocks, without the diagonal: (n + 1,) starts and neighbours."""
    n = (len(column_starts) - 1) // d
    starts = np.zeros(n + 1, dtype=np.int64)
    for column in range(n):
        for k in range(column_starts[d * column] + d, column_starts[d * column + 1], d):
            starts[column + 1] += 1
            starts[rows[k] // d + 1] += 1
    starts = np.cumsum(starts)
    filled = starts[:-1].copy()
    neighbours = np.empty(starts[n], dtype=np.int64)
    for column in range(n):
        for k in range(column_starts[d * column] + d, column_starts[d * column + 1], d):
            row = rows[k] // d
            neighbours[filled[column]] = row
            filled[column] += 1
            neighbours[filled[row]] = column
            filled[row] += 1
    return starts, neighbours


@numba.njit(nogil=True, cache=True)
def _entry_targets(column_starts, rows, place, first, row_starts, panel_rows, panel_starts):  # type: ignore[no-untyped-def]
    size, count = len(column_starts) - 1, len(first) - 1
    supernode = np.empty(size, dtype=np.int64)
    for s in range(count):
        supernode[first[s] : first[s + 1]] = s
    entry_starts = np.zeros(count + 1, dtype=np.int64)
    for column in range(size):
        for k in range(column_starts[column], column_starts[column + 1]):
            entry_starts[supernode[min(place[column], place[rows[k]])] + 1] += 1
    entry_starts = np.cumsum(entry_starts)
    filled = entry_starts[:-1].copy()
    entries = np.empty(len(rows), dtype=np.int32)
    for column in range(size):
        for k in range(column_starts[column], column_starts[column + 1]):
            s = supernode[min(place[column], place[rows[k]])]
            entries[filled[s]] = k
            filled[s] += 1
    column_of = np.empty(len(rows), dtype=np.int64)
    for column in range(size):
        column_of[column_starts[column] : column_starts[column + 1]] = column
    targets = np.empty(len(rows), dtype=np.int64)
    where = np.empty(size, dtype=np.int64)
    for s in range(count):
        height = row_starts[s + 1] - row_starts[s]
        for k in range(height):
            where[panel_rows[row_starts[s] + k]] = k
        for e in range(entry_starts[s], entry_starts[s + 1]):
            i, j = place[rows[entries[e]]], place[column_of[entries[e]]]
            low, high = min(i, j), max(i, j)
            targets[e] = panel_starts[s] + (low - first[s]) * height + where[high]
    return entries, targets, entry_starts


def _split(parents: Integers, work: np.ndarray) -> tuple[Integers, Integers]:
    """Subtrees of at most a share of the work as (t, 2) ranges, and (k,) the supernodes above them."""
    count = len(parents)
    if work.sum() < LITTLE_WORK:
        return np.array([[0, count]]), np.empty(0, dtype=np.int64)
    below = work.copy()
    first = np.arange(count)  # leftmost descendant
    for s in range(count):
        if parents[s] < count:
            below[parents[s]] += below[s]
            first[parents[s]] = min(first[parents[s]], first[s])
    limit = below[parents == count].sum() / SHARES
    is_top = below > limit
    roots = np.flatnonzero(~is_top & np.append(is_top, True)[parents])
    return np.stack([first[roots], roots + 1], axis=1), np.flatnonzero(is_top)


def _workspace(parents: Integers, sizes: Integers, subtrees: Integers, top: Integers) -> tuple[Integers, Integers, int]:
    """Where update matrices lie: on a stack in each subtree, side by side above."""
    count = len(parents)
    update, scratch = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.int64)
    areas = sizes**2
    base = 0
    for begin, end in subtrees:
        stack: list[int] = []
        height = peak = 0
        for s in range(begin, end):
            scratch[s] = base + height
            peak = max(peak, height + int(areas[s]))
            while stack and parents[stack[-1]] == s:
                height -= int(areas[stack.pop()])
            update[s] = base + height
            height += int(areas[s])
            stack.append(s)
        base += peak
    for s in top:
        update[s] = scratch[s] = base
        base += int(areas[s])
    return update, scratch, base
