"""Sparse Cholesky on all cores: a multifrontal factorisation that keeps its symbolic analysis and holds no interpreter lock."""

from workbench.core.cholesky.analysis import SymbolicFactor, analyse_matrix, analyse_pattern
from workbench.core.cholesky.factor import CholeskyFactor, NotPositiveDefiniteError

__all__ = ["CholeskyFactor", "NotPositiveDefiniteError", "SymbolicFactor", "analyse_matrix", "analyse_pattern"]
