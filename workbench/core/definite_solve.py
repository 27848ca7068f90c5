"""Solve one symmetric positive definite sparse system: what a linear initializer needs."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse import linalg

from workbench.core.arrays import Floats, Integers
from workbench.core.cholmod_library import load_cvxopt
from workbench.core.errors import WorkbenchError

_REFINEMENTS = 2


class DefiniteFactor:
    """Cholesky factor of a symmetric positive definite matrix: CHOLMOD, or SuperLU where cvxopt is missing.

    The matrix is scaled to a unit diagonal first, and every solution is refined: rows may differ very much in size.

    Parameters
    ----------
    matrix : (N, N) sparse     symmetric; both triangles given
    order : (N,) int64         order of elimination, where a good one is known

    Raises `WorkbenchError` where the matrix is not positive definite to working precision.
    """

    def __init__(self, matrix: Any, order: Integers | None = None) -> None:
        matrix = sparse.csc_matrix(matrix)
        diagonal = matrix.diagonal()
        if not (diagonal > 0).all():
            raise WorkbenchError(_SINGULAR)
        self._scale = 1.0 / np.sqrt(diagonal)
        scaling = sparse.diags(self._scale)
        self._matrix = sparse.csc_matrix(scaling @ matrix @ scaling)
        try:
            cvxopt = load_cvxopt()
        except ImportError:
            self._factorise_superlu()
        else:
            self._factorise_cholmod(cvxopt, order)

    def _factorise_cholmod(self, cvxopt: Any, order: Integers | None) -> None:
        lower = sparse.tril(self._matrix, format="coo")
        rows, columns = (cvxopt.matrix(np.ascontiguousarray(part, dtype=np.int64)) for part in (lower.row, lower.col))
        values = cvxopt.matrix(np.ascontiguousarray(lower.data))
        matrix = cvxopt.spmatrix(values, rows, columns, self._matrix.shape)
        known = () if order is None else (cvxopt.matrix(np.ascontiguousarray(order, dtype=np.int64)),)
        factor = cvxopt.cholmod.symbolic(matrix, *known)
        try:
            cvxopt.cholmod.numeric(matrix, factor)
        except ArithmeticError:
            raise WorkbenchError(_SINGULAR) from None

        def solve(rhs: Floats) -> Floats:
            unknown = cvxopt.matrix(np.asfortranarray(rhs))
            cvxopt.cholmod.solve(factor, unknown)
            return np.array(unknown).reshape(rhs.shape)

        self._solve = solve

    def _factorise_superlu(self) -> None:
        try:
            factor = linalg.splu(
                self._matrix, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
            )
        except RuntimeError:
            raise WorkbenchError(_SINGULAR) from None
        self._solve = factor.solve

    def solve(self, rhs: Floats) -> Floats:
        """(N, k) right-hand sides -> (N, k). Raises `WorkbenchError` where the result is not finite."""
        scaled = rhs * self._scale[:, None]
        unknown = self._solve(scaled)
        for _ in range(_REFINEMENTS):
            unknown = unknown + self._solve(scaled - self._matrix @ unknown)
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
    matrix = sparse.csr_matrix(matrix)
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
