"""Solve one symmetric positive definite sparse system: what a linear initializer needs."""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy

from workbench.core.arrays import Floats, Integers
from workbench.core.cholesky import CholeskyFactor, NotPositiveDefiniteError, analyse_matrix
from workbench.core.errors import WorkbenchError
from workbench.core.pattern import elimination_order

_REFINEMENTS = 2


class DefiniteFactor:
    """Cholesky factor of a symmetric positive definite matrix.

    The matrix is scaled to a unit diagonal first, and every solution is refined: rows may differ very much in size.

    Parameters
    ----------
    matrix : (N, N) sparse     symmetric; both triangles given
    order : (N,) int64         order of elimination, where a good one is known

    Raises `WorkbenchError` where the matrix is not positive definite to working precision.
    """

    def __init__(self, matrix: Any, order: Integers | None = None) -> None:
        matrix = scipy.sparse.csc_matrix(matrix)
        diagonal = matrix.diagonal()
        if not (diagonal > 0).all():
            raise WorkbenchError(_SINGULAR)
        self._scale = 1.0 / np.sqrt(diagonal)
        scaling = scipy.sparse.diags(self._scale)
        self._matrix = scipy.sparse.csc_matrix(scaling @ matrix @ scaling)
        lower = scipy.sparse.tril(self._matrix, format="csc")
        lower.sort_indices()
        if order is None:
            order = elimination_order(scipy.sparse.csr_matrix(self._matrix - scipy.sparse.diags(self._matrix.diagonal())))
        starts, rows = lower.indptr.astype(np.int64), lower.indices.astype(np.int64)
        self._factor = CholeskyFactor(analyse_matrix(starts, rows, 1, np.asarray(order, dtype=np.int64)))
        try:
            self._factor.factorise(lower.data)
        except NotPositiveDefiniteError:
            raise WorkbenchError(_SINGULAR) from None

    def solve(self, rhs: Floats) -> Floats:
        """(N, k) right-hand sides -> (N, k). Raises `WorkbenchError` where the result is not finite."""
        scaled = rhs * self._scale[:, None]
        unknown = self._factor.solve(scaled)
        for _ in range(_REFINEMENTS):
            unknown = unknown + self._factor.solve(scaled - self._matrix @ unknown)
        if not np.isfinite(unknown).all():
            raise WorkbenchError(_SINGULAR)
        result: Floats = unknown * self._scale[:, None]
        return result


def solve_with_fixed(matrix: Any, fixed: np.ndarray, values: Floats, order: Integers | None = None) -> Floats:
    """Minimiser of x^T M x with some rows of x given.

    Parameters
    ----------
    matrix : (N, N) sparse        symmetric, positive definite on the free rows
    fixed : (k,) int64            rows that are given
    values : (k, c) float64       their values
    order : (N,) int64            order of elimination of all rows, where a good one is known

    Returns
    -------
    (N, c) float64
    """
    matrix = scipy.sparse.csr_matrix(matrix)
    is_free = np.ones(matrix.shape[0], dtype=bool)
    is_free[fixed] = False
    free = np.flatnonzero(is_free)
    result = np.zeros((matrix.shape[0], values.shape[1]))
    result[fixed] = values
    if len(free):
        # Values near zero keep more digits: what all have in common is taken out first.
        centre = values.mean(axis=0) if np.allclose(matrix @ np.ones(matrix.shape[0]), 0.0, atol=1e-9) else 0.0
        rows = matrix[free]
        kept = None if order is None else (np.cumsum(is_free) - 1)[order[is_free[order]]]
        result[free] = DefiniteFactor(rows[:, free], kept).solve(-(rows[:, fixed] @ (values - centre))) + centre
    return result


_SINGULAR = (
    "The linear system of this start is singular; the mesh may have degenerate triangles or loose parts: remove them, "
    "or choose another start."
)
