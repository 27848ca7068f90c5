"""Preconditioned conjugate gradients as a back end: no factor, so neither its memory nor its work on large solids.

A = L + A_d + L^T by blocks of a vertex's coordinates; the preconditioner is (D + L) D^-1 (D + L)^T, with D such that its
diagonal blocks are those of A: an incomplete factor without fill that changes the diagonal alone. In the metric of (D + L) an
iteration costs one solve forwards and one backwards, and no product with A (Eisenstat 1981).

Stopped early, the iterate still minimises the quadratic model over a subspace that holds the preconditioned gradient: a
direction found from 0 descends, however coarse. All sums run in a fixed order, so that the same input gives the same output.
"""

from __future__ import annotations

import numba
import numpy as np
import scipy

from workbench.core.arrays import Floats, Integers
from workbench.core.linear_back_end import LinearSolver, SingularMatrixError
from workbench.core.pattern import HessianPattern

TOLERANCE = 1e-3
"""Residual in the norm of the preconditioner's inverse at which a solution is good enough, as a part of that at 0."""
MOST_ITERATIONS = 1000
"""Beyond, the solution is taken as it is: as a direction it descends all the same."""
LEAST_PIVOT = 0.05
"""Part of a pivot of A's diagonal block below which the incomplete one is not trusted: A's own block stands in."""


class ConjugateGradients(LinearSolver):
    """Conjugate gradients with a block incomplete factor.

    Parameters
    ----------
    pattern : HessianPattern     d <= 3 coordinates a vertex; blocks are 3x3, with ones where a coordinate is missing
    tolerance, most : float, int see `TOLERANCE` and `MOST_ITERATIONS`

    `iterations` : int           of the last solve, the most for any of its right-hand sides
    """

    name = "cg"

    def __init__(self, pattern: HessianPattern, tolerance: float = TOLERANCE, most: int = MOST_ITERATIONS) -> None:
        self.tolerance = tolerance
        self.most = most
        self.iterations = 0
        self._pattern = pattern
        d, count = pattern.dimension, len(pattern.order)
        first = np.flatnonzero((pattern.rows % d == 0) & (pattern.columns % d == 0))
        rows, columns = pattern.rows[first] // d, pattern.columns[first] // d
        below = rows != columns
        first, rows, columns = first[below], rows[below], columns[below]
        graph = scipy.sparse.csr_matrix((np.ones(len(rows), dtype=np.int8), (rows, columns)), shape=(count, count))
        # A front that sweeps through the solid: neighbours stay near in memory, and the incomplete factor loses less.
        self._order = scipy.sparse.csgraph.reverse_cuthill_mckee(
            scipy.sparse.csr_matrix(graph + graph.T), symmetric_mode=True
        ).astype(np.int64)
        place = np.empty(count, dtype=np.int64)
        place[self._order] = np.arange(count)
        self._lower_entries, self._starts, self._columns = _lower_blocks(pattern, first, rows, columns, place)
        self._diagonal_entries = _diagonal_blocks(pattern)[self._order]
        self._blocks: tuple[Floats, Floats, Floats, Floats] | None = None
        self._diagonal = np.empty((0, 3, 3))
        self._coupled = np.empty(0, dtype=np.bool_)

    def factorise(self, values: Floats) -> None:
        """See `LinearSolver.factorise`: puts the blocks together and factorises incompletely, in O(nnz)."""
        known = np.concatenate([values, [0.0, 1.0]])
        lower, diagonal = known[self._lower_entries], known[self._diagonal_entries]
        metric, inverse, middle = np.empty_like(diagonal), np.empty_like(diagonal), np.empty_like(diagonal)
        self._blocks = None
        if not _incomplete_factor(self._starts, self._columns, lower, diagonal, metric, inverse, middle):
            raise SingularMatrixError("a diagonal block is not positive definite")
        self._diagonal, self._coupled = diagonal, np.zeros(len(diagonal), dtype=np.bool_)
        _mark_coupled(self._starts, self._columns, lower, self._coupled)
        self._blocks = lower, metric, inverse, middle

    def solve(self, rhs: Floats) -> Floats:
        """See `LinearSolver.solve`. Rows that nothing couples to others, those of eliminated vertices, are solved exactly.

        Raises `SingularMatrixError` where the matrix turns out not to be positive definite.
        """
        columns = rhs.reshape(len(rhs), -1)
        self.iterations = 0
        return np.column_stack([self._solve_one(column) for column in columns.T]).reshape(rhs.shape)

    def _solve_one(self, rhs: Floats) -> Floats:
        assert self._blocks is not None
        d, count = self._pattern.dimension, len(self._order)
        b, x = np.zeros((count, 3)), np.zeros((count, 3))
        b[:, :d] = rhs.reshape(-1, d)[self._order]
        alone = np.flatnonzero(~self._coupled)
        x[alone] = np.linalg.solve(self._diagonal[alone], b[alone, :, None])[:, :, 0]
        b[alone] = 0.0
        self.iterations = _conjugate_gradients(self._starts, self._columns, *self._blocks, b, x, self.tolerance, self.most)
        if self.iterations < 0:
            raise SingularMatrixError("the matrix is not positive definite")
        solution = np.empty((count, d))
        solution[self._order] = x[:, :d]
        return solution.reshape(-1)


def _lower_blocks(
    pattern: HessianPattern, first: Integers, rows: Integers, columns: Integers, place: Integers
) -> tuple[Integers, Integers, Integers]:
    """Entries (b, 3, 3) of the blocks below the diagonal in a new order of the vertices, by rows: starts and columns.

    first, rows, columns : (b,) int64     first entry of each block of the pattern, and its row and column
    place : (N,) int64                    new place of each row
    """
    d, starts = pattern.dimension, pattern.column_starts
    entries = np.full((len(first), 3, 3), pattern.entry_count, dtype=np.int64)  # a zero where there is no coordinate
    for r in range(d):
        for c in range(d):
            entries[:, r, c] = starts[columns * d + c] + first - starts[columns * d] + r - c
    row, column = place[rows], place[columns]
    turned = row < column
    entries[turned] = entries[turned].transpose(0, 2, 1)
    row, column = np.maximum(row, column), np.minimum(row, column)
    by_row = np.lexsort((column, row))
    return entries[by_row], np.searchsorted(row[by_row], np.arange(len(place) + 1)), column[by_row]


def _diagonal_blocks(pattern: HessianPattern) -> Integers:
    """Entries (N, 3, 3) of the diagonal blocks, in the pattern's order; a one for each missing coordinate."""
    d, count = pattern.dimension, len(pattern.order)
    entries = np.full((count, 3, 3), pattern.entry_count, dtype=np.int64)
    for r in range(3):
        entries[:, r, r] = pattern.entry_count + 1
    for r in range(d):
        for c in range(r + 1):
            entries[:, r, c] = entries[:, c, r] = pattern.column_starts[np.arange(count) * d + c] + r - c
    return entries


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _incomplete_factor(starts, columns, lower, diagonal, metric, inverse, middle):  # type: ignore[no-untyped-def]
    """Write D to `metric`, D^-1 to `inverse` and 2 D - A_d to `middle`, all (N, 3, 3).

    Returns whether A's diagonal blocks are definite.
    """
    D, T = np.empty((3, 3)), np.empty((3, 3))
    for i in range(len(starts) - 1):
        D[:] = diagonal[i]
        for k in range(starts[i], starts[i + 1]):
            block, known = lower[k], inverse[columns[k]]
            for r in range(3):
                for c in range(3):
                    T[r, c] = block[r, 0] * known[0, c] + block[r, 1] * known[1, c] + block[r, 2] * known[2, c]
            for r in range(3):
                for c in range(3):
                    D[r, c] -= T[r, 0] * block[c, 0] + T[r, 1] * block[c, 1] + T[r, 2] * block[c, 2]
        if not _is_trusted(D, diagonal[i]):
            D[:] = diagonal[i]
            if not _is_trusted(D, D):
                return False
        _invert(D, inverse[i])
        for r in range(3):
            for c in range(3):
                metric[i, r, c] = D[r, c]
                middle[i, r, c] = 2.0 * D[r, c] - diagonal[i, r, c]
    return True


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _is_trusted(D, A):  # type: ignore[no-untyped-def]
    """Whether the pivots of D (3, 3) are positive and not far below those of A (3, 3)."""
    d0, d1, d2 = _pivots(D)
    a0, a1, a2 = _pivots(A)
    positive = d0 > 0.0 and d1 > 0.0 and d2 > 0.0
    return positive and d0 >= LEAST_PIVOT * a0 and d1 >= LEAST_PIVOT * a1 and d2 >= LEAST_PIVOT * a2


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _pivots(A):  # type: ignore[no-untyped-def]
    """The pivots of A (3, 3), symmetric."""
    second = A[1, 1] - A[1, 0] * A[1, 0] / A[0, 0]
    left = A[2, 1] - A[2, 0] * A[1, 0] / A[0, 0]
    return A[0, 0], second, A[2, 2] - A[2, 0] * A[2, 0] / A[0, 0] - left * left / second


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _invert(A, out):  # type: ignore[no-untyped-def]
    """Write the inverse of A (3, 3), symmetric and definite."""
    c00, c01 = A[1, 1] * A[2, 2] - A[1, 2] * A[2, 1], A[1, 2] * A[2, 0] - A[1, 0] * A[2, 2]
    c02 = A[1, 0] * A[2, 1] - A[1, 1] * A[2, 0]
    det = A[0, 0] * c00 + A[0, 1] * c01 + A[0, 2] * c02
    out[0, 0], out[0, 1], out[0, 2] = c00 / det, c01 / det, c02 / det
    out[1, 0], out[1, 1] = out[0, 1], (A[0, 0] * A[2, 2] - A[0, 2] * A[2, 0]) / det
    out[1, 2] = (A[0, 1] * A[2, 0] - A[0, 0] * A[2, 1]) / det
    out[2, 0], out[2, 1], out[2, 2] = out[0, 2], out[1, 2], (A[0, 0] * A[1, 1] - A[0, 1] * A[1, 0]) / det


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _mark_coupled(starts, columns, lower, coupled):  # type: ignore[no-untyped-def]
    """Set coupled[i] where some block beside the diagonal in row or column i is not zero."""
    for i in range(len(starts) - 1):
        for k in range(starts[i], starts[i + 1]):
            if not coupled[i] or not coupled[columns[k]]:
                for r in range(3):
                    for c in range(3):
                        if lower[k, r, c] != 0.0:
                            coupled[i] = coupled[columns[k]] = True


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _conjugate_gradients(starts, columns, lower, metric, inverse, middle, b, x, tolerance, most):  # type: ignore[no-untyped-def]
    """Add the solution of A y = b (N, 3) to x; returns the iterations, -1 where A is not positive definite.

    In y^ = (D + L)^T y the matrix is v -> t + (D + L)^-1 (v - (2 D - A_d) t), t = (D + L)^-T v, the preconditioner D.
    """
    n = len(b)
    r, z, p = np.empty((n, 3)), np.empty((n, 3)), np.zeros((n, 3))
    t, w = np.empty((n, 3)), np.empty((n, 3))
    _solve_forwards(starts, columns, lower, inverse, b, r)
    rho = _precondition(metric, r, z)
    goal = tolerance * tolerance * rho
    beta = 0.0
    for iteration in range(most):
        if not rho > goal or rho == 0.0:
            return iteration if rho >= 0.0 else -1
        for i in range(n):
            for c in range(3):
                p[i, c] = z[i, c] + beta * p[i, c]
                w[i, c] = p[i, c]
        _solve_backwards(starts, columns, lower, inverse, w, t)
        for i in range(n):
            for c in range(3):
                w[i, c] = p[i, c] - (middle[i, c, 0] * t[i, 0] + middle[i, c, 1] * t[i, 1] + middle[i, c, 2] * t[i, 2])
        curvature = _solve_and_measure(starts, columns, lower, inverse, w, t, p)
        if not curvature > 0.0:
            return iteration if iteration > 0 else -1
        alpha = rho / curvature
        for i in range(n):
            for c in range(3):
                x[i, c] += alpha * t[i, c]
                r[i, c] -= alpha * (t[i, c] + w[i, c])
        before, rho = rho, _precondition(metric, r, z)
        beta = rho / before
    return most


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _solve_forwards(starts, columns, lower, inverse, b, out):  # type: ignore[no-untyped-def]
    """out = (D + L)^-1 b, which may be the same array."""
    for i in range(len(b)):
        s0, s1, s2 = b[i, 0], b[i, 1], b[i, 2]
        for k in range(starts[i], starts[i + 1]):
            j = columns[k]
            o0, o1, o2 = out[j, 0], out[j, 1], out[j, 2]
            s0 -= lower[k, 0, 0] * o0 + lower[k, 0, 1] * o1 + lower[k, 0, 2] * o2
            s1 -= lower[k, 1, 0] * o0 + lower[k, 1, 1] * o1 + lower[k, 1, 2] * o2
            s2 -= lower[k, 2, 0] * o0 + lower[k, 2, 1] * o1 + lower[k, 2, 2] * o2
        for r in range(3):
            out[i, r] = inverse[i, r, 0] * s0 + inverse[i, r, 1] * s1 + inverse[i, r, 2] * s2


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _solve_and_measure(starts, columns, lower, inverse, w, t, p):  # type: ignore[no-untyped-def]
    """w = (D + L)^-1 w in place; returns p . (t + w)."""
    _solve_forwards(starts, columns, lower, inverse, w, w)
    total = 0.0
    for i in range(len(w)):
        for c in range(3):
            total += p[i, c] * (t[i, c] + w[i, c])
    return total


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _solve_backwards(starts, columns, lower, inverse, b, out):  # type: ignore[no-untyped-def]
    """out = (D + L)^-T b; b is used up."""
    for i in range(len(b) - 1, -1, -1):
        for r in range(3):
            out[i, r] = inverse[i, r, 0] * b[i, 0] + inverse[i, r, 1] * b[i, 1] + inverse[i, r, 2] * b[i, 2]
        o0, o1, o2 = out[i, 0], out[i, 1], out[i, 2]
        for k in range(starts[i], starts[i + 1]):
            j = columns[k]
            b[j, 0] -= lower[k, 0, 0] * o0 + lower[k, 1, 0] * o1 + lower[k, 2, 0] * o2
            b[j, 1] -= lower[k, 0, 1] * o0 + lower[k, 1, 1] * o1 + lower[k, 2, 1] * o2
            b[j, 2] -= lower[k, 0, 2] * o0 + lower[k, 1, 2] * o1 + lower[k, 2, 2] * o2


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _precondition(metric, r, z):  # type: ignore[no-untyped-def]
    """z = D r; returns r . z."""
    total = 0.0
    for i in range(len(r)):
        for c in range(3):
            z[i, c] = metric[i, c, 0] * r[i, 0] + metric[i, c, 1] * r[i, 1] + metric[i, c, 2] * r[i, 2]
            total += r[i, c] * z[i, c]
    return total
