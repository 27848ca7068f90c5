"""The back ends for linear systems, chosen by what is installed and by size: Cholesky with a kept analysis, or iterations."""

from __future__ import annotations

import os

import numpy as np
import scipy

from workbench.core.arrays import Floats
from workbench.core.back_end_names import CHOICE, available_back_ends
from workbench.core.cholesky import CholeskyFactor, NotPositiveDefiniteError, analyse_pattern
from workbench.core.cholmod_library import load_cvxopt
from workbench.core.conjugate_gradients import ConjugateGradients
from workbench.core.errors import WorkbenchError
from workbench.core.linear_back_end import LinearSolver, SingularMatrixError
from workbench.core.pattern import HessianPattern


class Cholmod(LinearSolver):
    """CHOLMOD, supernodal, through cvxopt. The pattern is in its elimination order already."""

    name = "cholmod"

    def __init__(self, pattern: HessianPattern) -> None:
        self._cvxopt = cvxopt = load_cvxopt()
        self._cholmod = cvxopt.cholmod
        size, count = pattern.size, pattern.entry_count
        self._values = cvxopt.matrix(0.0, (count, 1))
        self._view = np.asarray(memoryview(self._values)).reshape(-1)
        # Positive on the diagonal so that nothing is dropped and the analysis sees a proper matrix.
        self._matrix = cvxopt.spmatrix(
            cvxopt.matrix(1.0, (count, 1)),
            cvxopt.matrix(pattern.rows),
            cvxopt.matrix(pattern.columns),
            (size, size),
        )
        natural = cvxopt.matrix(np.arange(size, dtype=np.int64))
        self._factor = self._cholmod.symbolic(self._matrix, natural)

    def factorise(self, values: Floats) -> None:
        self._view[:] = values
        self._matrix.V = self._values
        try:
            self._cholmod.numeric(self._matrix, self._factor)
        except ArithmeticError as error:
            raise SingularMatrixError(str(error)) from None

    def solve(self, rhs: Floats) -> Floats:
        columns = rhs.reshape(len(rhs), -1)
        b = self._cvxopt.matrix(np.asfortranarray(columns))
        self._cholmod.solve(self._factor, b)
        return np.array(b).reshape(rhs.shape)


class SuperLU(LinearSolver):
    """SciPy's LU, where cvxopt is missing: slower, always there."""

    name = "superlu"

    def __init__(self, pattern: HessianPattern) -> None:
        lower = scipy.sparse.csc_matrix(
            (np.arange(1, pattern.entry_count + 1, dtype=np.float64), pattern.rows, pattern.column_starts),
            shape=(pattern.size, pattern.size),
        )
        full = scipy.sparse.csc_matrix(lower + scipy.sparse.tril(lower, -1).T)
        full.sort_indices()
        # Each value of the full matrix knows which entry of the lower triangle it comes from.
        self._source = full.data.astype(np.int64) - 1
        self._matrix = full
        self._factor: scipy.sparse.linalg.SuperLU | None = None

    def factorise(self, values: Floats) -> None:
        self._matrix.data = values[self._source]
        options = {"SymmetricMode": True}
        try:
            self._factor = scipy.sparse.linalg.splu(self._matrix, permc_spec="NATURAL", diag_pivot_thresh=0.0, options=options)
        except RuntimeError as error:
            raise SingularMatrixError(str(error)) from None

    def solve(self, rhs: Floats) -> Floats:
        assert self._factor is not None
        result: Floats = self._factor.solve(np.asarray(rhs))
        return result


class Pardiso(LinearSolver):
    """Intel MKL PARDISO through the extra `mkl`."""

    name = "pardiso"

    def __init__(self, pattern: HessianPattern) -> None:
        import pypardiso

        self._solver = pypardiso.PyPardisoSolver(mtype=2)
        for place, value in {1: 1, 2: 2, 24: 1}.items():  # own settings, METIS, factorisation in parallel at two levels
            self._solver.set_iparm(place, value)
        # PARDISO takes the upper triangle by rows: that is the lower triangle by columns.
        self._matrix = scipy.sparse.csr_matrix(
            (np.ones(pattern.entry_count), pattern.rows, pattern.column_starts), shape=(pattern.size, pattern.size)
        )
        self._analysed = False

    def factorise(self, values: Floats) -> None:
        self._matrix.data = np.ascontiguousarray(values)
        try:
            if not self._analysed:
                self._solver.set_phase(11)
                self._solver._call_pardiso(self._matrix, np.zeros((self._matrix.shape[0], 1)))
                self._analysed = True
            self._solver.set_phase(22)
            self._solver._call_pardiso(self._matrix, np.zeros((self._matrix.shape[0], 1)))
        except Exception as error:
            raise SingularMatrixError(str(error)) from None

    def solve(self, rhs: Floats) -> Floats:
        self._solver.set_phase(33)
        result = self._solver._call_pardiso(self._matrix, np.asfortranarray(rhs.reshape(len(rhs), -1)))
        return np.asarray(result).reshape(rhs.shape)


class Multifrontal(LinearSolver):
    """Cholesky on all cores, by kernels of our own over SciPy's LAPACK."""

    name = "multifrontal"

    def __init__(self, pattern: HessianPattern) -> None:
        self._factor = CholeskyFactor(analyse_pattern(pattern))

    def factorise(self, values: Floats) -> None:
        try:
            self._factor.factorise(values)
        except NotPositiveDefiniteError as error:
            raise SingularMatrixError(str(error)) from None

    def solve(self, rhs: Floats) -> Floats:
        return self._factor.solve(rhs)


BACK_ENDS: dict[str, type[LinearSolver]] = {
    back_end.name: back_end for back_end in (Multifrontal, Cholmod, Pardiso, SuperLU, ConjugateGradients)
}


LARGE_SOLID = 150_000
"""Unknowns of a solid above which conjugate gradients are taken.

On compact solids they are twice as fast as a factorisation at 58 k unknowns already, ten times at 255 k, where a factor takes
5 GB more (python -m tests.benchmarks.tetrahedra). But long thin limbs need many times the iterations, and a hand that drags
is better answered by a factor that is kept: so they wait until even then a factor would be the slower.
"""


def check_back_end(name: str) -> None:
    """Raises `WorkbenchError` unless there is a back end of that name, and its library."""
    names = (*available_back_ends(), ConjugateGradients.name)
    if name not in names:
        raise WorkbenchError(f"There is no linear solver {name!r} here; there are: {', '.join(names)}.")


def make_linear_solver(pattern: HessianPattern, name: str = "") -> LinearSolver:
    """The back end of that name, or of the environment variable `CHOICE`, or the one that suits the pattern's size.

    Raises `WorkbenchError` where there is none of that name.
    """
    name = name or os.environ.get(CHOICE, "")
    if name:
        check_back_end(name)
        return BACK_ENDS[name](pattern)
    if pattern.dimension == 3 and pattern.size > LARGE_SOLID:
        return ConjugateGradients(pattern)
    return BACK_ENDS[available_back_ends()[0]](pattern)
