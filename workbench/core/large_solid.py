"""Linear systems of large solids: conjugate gradients first, a factorisation where they are slow and it can be afforded."""

from __future__ import annotations

from collections.abc import Callable

from workbench.core.arrays import Floats
from workbench.core.conjugate_gradients import ConjugateGradients
from workbench.core.linear_back_end import LinearSolver, SingularMatrixError
from workbench.core.pattern import HessianPattern

FACTORABLE = 150_000
"""Unknowns of a solid up to which a factor is worth its memory, some gigabytes at the most."""


class LargeSolid(LinearSolver):
    """Conjugate gradients until a system is too hard for them: long thin limbs bend easily, and that is slow to find out.

    Such solids are cheap to factorise, as little joins their parts; so from the first solve on that ends at the limit of
    iterations there is a factorisation instead. Without one that can be afforded, the direction is taken as it is.

    Parameters
    ----------
    pattern : HessianPattern
    make_direct : callable        pattern -> the back end that factorises
    """

    name = "cg, or a factorisation"

    def __init__(self, pattern: HessianPattern, make_direct: Callable[[HessianPattern], LinearSolver]) -> None:
        self._pattern = pattern
        self._make_direct = make_direct
        self._gradients: ConjugateGradients | None = ConjugateGradients(pattern)
        self._direct: LinearSolver | None = None
        self._values: Floats | None = None

    @property
    def is_direct(self) -> bool:
        """Whether it has turned to factorisations."""
        return self._direct is not None

    def factorise(self, values: Floats) -> None:
        """See `LinearSolver.factorise`."""
        self._values = values
        (self._direct or self._iterative).factorise(values)

    def solve(self, rhs: Floats) -> Floats:
        """See `LinearSolver.solve`."""
        assert self._values is not None
        if self._direct is None:
            solution = self._iterative.solve(rhs)
            if self._iterative.iterations < self._iterative.most or self._pattern.size > FACTORABLE:
                return solution
            direct = self._make_direct(self._pattern)
            try:
                direct.factorise(self._values)
            except SingularMatrixError:  # it floats, to working precision: conjugate gradients do not mind
                return solution
            self._direct, self._gradients = direct, None
        return self._direct.solve(rhs)

    @property
    def _iterative(self) -> ConjugateGradients:
        assert self._gradients is not None
        return self._gradients
