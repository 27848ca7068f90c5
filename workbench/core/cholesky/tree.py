"""Elimination tree of a sparse symmetric matrix, its postorder and the column counts of the factor.

Source: Liu 1990, "The role of elimination trees in sparse factorization".
"""

from __future__ import annotations

import numba
import numpy as np

from workbench.core.arrays import Integers


@numba.njit(nogil=True, cache=True)
def elimination_tree(starts, neighbours, order, place):  # type: ignore[no-untyped-def]
    """(n,) parent of each column, n where there is none; the graph is given by (n + 1,) `starts` and `neighbours`.

    Columns are numbered by `place` (n,), the inverse of `order` (n,). Cost: nearly O(edges).
    """
    n = len(order)
    parent = np.full(n, n, dtype=np.int64)
    ancestor = np.full(n, n, dtype=np.int64)  # with paths compressed
    for column in range(n):
        vertex = order[column]
        for k in range(starts[vertex], starts[vertex + 1]):
            i = place[neighbours[k]]
            while i < column:
                following = ancestor[i]
                ancestor[i] = column
                if following == n:
                    parent[i] = column
                    break
                i = following
    return parent


@numba.njit(nogil=True, cache=True)
def column_counts(starts, neighbours, order, place, parent):  # type: ignore[no-untyped-def]
    """(n,) entries of each column of the factor, the diagonal among them. Cost: O(entries of the factor)."""
    n = len(order)
    counts = np.ones(n, dtype=np.int64)
    mark = np.full(n, -1, dtype=np.int64)
    for row in range(n):
        mark[row] = row
        vertex = order[row]
        for k in range(starts[vertex], starts[vertex + 1]):
            j = place[neighbours[k]]
            while j < row and mark[j] != row:  # up the tree: every column on the way has an entry in this row
                mark[j] = row
                counts[j] += 1
                j = parent[j]
    return counts


def postorder(parent: Integers, weight: Integers) -> Integers:
    """(n,) columns, children before parents and a subtree in one piece; of several children the one of most `weight` last.

    The last child is next to its parent, where the two can be merged.
    """
    result: Integers = _postorder(parent, np.argsort(weight, kind="stable"))
    return result


@numba.njit(nogil=True, cache=True)
def _postorder(parent, lightest_first):  # type: ignore[no-untyped-def]
    n = len(parent)
    head = np.full(n + 1, -1, dtype=np.int64)
    following = np.full(n, -1, dtype=np.int64)
    for column in lightest_first:  # pushed in front: the heaviest comes first, and leaves the stack last
        following[column] = head[parent[column]]
        head[parent[column]] = column
    result = np.empty(n, dtype=np.int64)
    stack = np.empty(n + 1, dtype=np.int64)
    count = 0
    top = 0
    root = head[n]
    while root >= 0:
        stack[top] = root
        top += 1
        root = following[root]
    while top > 0:
        column = stack[top - 1]
        child = head[column]
        if child < 0:
            top -= 1
            result[count] = column
            count += 1
            continue
        head[column] = -1  # its children go up once
        while child >= 0:
            stack[top] = child
            top += 1
            child = following[child]
    return result
