"""Numeric factorisation and triangular solves of a range of supernodes; they hold no lock and write to places of their own.

Source: Duff, Reid 1983, "The multifrontal solution of indefinite sparse symmetric linear equations"; Liu 1992, "The
multifrontal method for sparse matrix solution".
"""

from __future__ import annotations

import numba
import numpy as np

from workbench.core.cholesky.dense import factor_dense, negated_square, solve_dense, subtract_product


@numba.njit(nogil=True, cache=True)
def assemble_panel(s, layout, values, factor, workspace):  # type: ignore[no-untyped-def]
    """Write the columns of supernode `s` of the matrix, and what its children leave to them, into its panel."""
    columns, height = _columns(layout, s), _height(layout, s)
    panel = factor[layout.panel_starts[s] : layout.panel_starts[s + 1]]
    panel[:] = 0.0
    for e in range(layout.entry_starts[s], layout.entry_starts[s + 1]):
        factor[layout.targets[e]] = values[layout.entries[e]]
    for c in range(layout.children_starts[s], layout.children_starts[s + 1]):
        child = layout.children[c]
        start, order = layout.row_starts[child] + _columns(layout, child), _height(layout, child) - _columns(layout, child)
        places = layout.in_parent[start : start + order]
        for j in range(order):
            if places[j] >= columns:
                break
            source = layout.update_starts[child] + j * order
            _add(panel[places[j] * height : (places[j] + 1) * height], places[j:], 0, workspace[source + j : source + order])


@numba.njit(nogil=True, cache=True)
def pass_on(s, layout, workspace):  # type: ignore[no-untyped-def]
    """Add what the children of `s` leave to later columns to its own update matrix, and put that in its place."""
    columns, below = _columns(layout, s), _height(layout, s) - _columns(layout, s)
    scratch, update = layout.scratch_starts[s], layout.update_starts[s]
    for c in range(layout.children_starts[s], layout.children_starts[s + 1]):
        child = layout.children[c]
        start, order = layout.row_starts[child] + _columns(layout, child), _height(layout, child) - _columns(layout, child)
        places = layout.in_parent[start : start + order]
        for j in range(order):
            if places[j] < columns:
                continue
            source, target = layout.update_starts[child] + j * order, scratch + (places[j] - columns) * below
            _add(workspace[target : target + below], places[j:], columns, workspace[source + j : source + order])
    if update != scratch:  # downwards, over what the children left: column by column, lower triangle only
        for j in range(below):
            for i in range(j * below + j, (j + 1) * below):
                workspace[update + i] = workspace[scratch + i]


@numba.njit(nogil=True, cache=True)
def _add(target, places, first, values):  # type: ignore[no-untyped-def]
    for i in range(len(values)):
        target[np.uint32(places[i] - first)] += values[i]


@numba.njit(nogil=True, cache=True)
def _columns(layout, s):  # type: ignore[no-untyped-def]
    return layout.first[s + 1] - layout.first[s]


@numba.njit(nogil=True, cache=True)
def _height(layout, s):  # type: ignore[no-untyped-def]
    return layout.row_starts[s + 1] - layout.row_starts[s]


@numba.njit(nogil=True, cache=True)
def factor_supernodes(begin, end, layout, routines, values, factor, workspace):  # type: ignore[no-untyped-def]
    """Factorise the supernodes from `begin` up to `end`, a whole subtree; False where a pivot is not positive and finite."""
    factor_address, workspace_address = factor.ctypes.data, workspace.ctypes.data
    for s in range(begin, end):
        assemble_panel(s, layout, values, factor, workspace)
        columns, height = _columns(layout, s), _height(layout, s)
        below = height - columns
        corner = factor_address + 8 * layout.panel_starts[s]
        if factor_dense(routines[0], columns, corner, height) != 0:
            return False
        if not has_finite_diagonal(factor, layout.panel_starts[s], columns, height):
            return False
        if below:
            side, scratch = corner + 8 * columns, workspace_address + 8 * layout.scratch_starts[s]
            solve_dense(routines[1], below, columns, corner, height, side, height)
            negated_square(routines[2], below, columns, side, height, scratch, below)
            pass_on(s, layout, workspace)
    return True


@numba.njit(nogil=True, cache=True)
def has_finite_diagonal(factor, panel, columns, height):  # type: ignore[no-untyped-def]
    """LAPACK takes NaN for a pivot without a word."""
    trace = 0.0
    for j in range(columns):
        trace += factor[panel + j * (height + 1)]
    return trace < np.inf


@numba.njit(nogil=True, cache=True)
def factor_tile(routines, n, a, lda):  # type: ignore[no-untyped-def]
    """See `factor_dense`; for callers that are not compiled."""
    return factor_dense(routines[0], n, a, lda)


@numba.njit(nogil=True, cache=True)
def solve_tile(routines, m, n, a, lda, b, ldb):  # type: ignore[no-untyped-def]
    """See `solve_dense`; for callers that are not compiled."""
    solve_dense(routines[1], m, n, a, lda, b, ldb)


@numba.njit(nogil=True, cache=True)
def subtract_tile(routines, m, n, k, a, lda, b, ldb, beta, c, ldc):  # type: ignore[no-untyped-def]
    """See `subtract_product`; for callers that are not compiled."""
    subtract_product(routines[3], m, n, k, a, lda, b, ldb, beta, c, ldc)


@numba.njit(nogil=True, cache=True)
def solve_forward(supernodes, layout, factor, x, above):  # type: ignore[no-untyped-def]
    """x := L^-1 x on the columns of `supernodes`, ascending.

    `x`, `above` : (k, N), a right-hand side a row; what is to be added to later rows goes to `above` and is taken from there
    """
    asked = np.empty(0)
    for s in supernodes:
        begin, columns, height = layout.first[s], _columns(layout, s), _height(layout, s)
        panel = layout.panel_starts[s]
        rows = layout.rows[layout.row_starts[s] : layout.row_starts[s + 1]]
        if height > len(asked):
            asked = np.empty(2 * height)
        for q in range(x.shape[0]):
            for j in range(columns):
                asked[j] = x[q, begin + j] + above[q, begin + j]
                above[q, begin + j] = 0.0
            asked[columns:height] = 0.0
            for j in range(columns):
                column = factor[panel + j * height + j : panel + (j + 1) * height]
                rest = asked[j:height]
                value = rest[0] / column[0]
                for i in range(len(column)):
                    rest[i] -= column[i] * value
                rest[0] = value
            for j in range(columns):
                x[q, begin + j] = asked[j]
            for i in range(columns, height):
                above[q, rows[i]] += asked[i]


@numba.njit(nogil=True, cache=True, fastmath={"reassoc", "contract"})
def solve_backward(supernodes, layout, factor, x):  # type: ignore[no-untyped-def]
    """x := L^-T x on the columns of `supernodes`, from the last to the first; later rows are solved already."""
    gathered = np.empty(0)
    for k in range(len(supernodes) - 1, -1, -1):
        s = supernodes[k]
        begin, columns, height = layout.first[s], _columns(layout, s), _height(layout, s)
        panel = layout.panel_starts[s]
        rows = layout.rows[layout.row_starts[s] : layout.row_starts[s + 1]]
        if height > len(gathered):
            gathered = np.empty(2 * height)
        for q in range(x.shape[0]):
            for i in range(columns, height):
                gathered[i] = x[q, rows[i]]
            for j in range(columns - 1, -1, -1):
                column = factor[panel + j * height + j : panel + (j + 1) * height]
                known = gathered[j:height]
                known[0] = 0.0
                total = 0.0
                for i in range(len(column)):
                    total += column[i] * known[i]
                value = (x[q, begin + j] - total) / column[0]
                x[q, begin + j] = value
                known[0] = value
