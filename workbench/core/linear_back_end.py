"""What a solver of linear systems is to the rest: one small interface, behind which back ends can be exchanged."""

from __future__ import annotations

from abc import ABC, abstractmethod

from workbench.core.arrays import Floats
from workbench.core.pattern import HessianPattern


class SingularMatrixError(Exception):
    """The matrix is not positive definite to working precision."""


class LinearSolver(ABC):
    """Factorises symmetric positive definite matrices that share one pattern."""

    name: str

    @abstractmethod
    def __init__(self, pattern: HessianPattern) -> None:
        """Symbolic analysis of the pattern."""

    @abstractmethod
    def factorise(self, values: Floats) -> None:
        """Numeric factorisation; (nnz,) values on the pattern. Raises `SingularMatrixError`."""

    @abstractmethod
    def solve(self, rhs: Floats) -> Floats:
        """(N,) or (N, k) right-hand sides, in the order of the matrix; returns a new array. Needs a factorisation."""
