"""Newton's method as a frame: subclasses say which positive semi-definite matrix stands for the Hessian."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from workbench.core.arrays import Floats
from workbench.core.descent import descend
from workbench.core.descent_solver import DescentSolver, direction_in_metric
from workbench.core.energy import Evaluation
from workbench.core.line_search import SAFETY
from workbench.core.method import parameter
from workbench.core.solver import Interrupt
from workbench.core.state import State

if TYPE_CHECKING:
    from workbench.core.problem import Problem


@dataclass(frozen=True)
class NewtonSolver(DescentSolver):
    """Newton steps with Armijo's rule below the largest step without inversion.

    Where the full step is accepted, a longer one is tried: a matrix made convex is too stiff, and a trial is cheap beside
    a factorisation.
    """

    second_order: ClassVar[bool] = True

    safety: float = parameter(SAFETY, "part of the largest step without inversion that is taken", minimum=0.1, maximum=0.99)
    reach: float = parameter(4.0, "longest step tried, in Newton steps; 1: never a longer one", minimum=1.0, maximum=10.0)

    @abstractmethod
    def convex_hessian(self, problem: Problem, state: State, evaluation: Evaluation) -> Floats:
        """(nnz,) float64 on the pattern, positive semi-definite, soft anchors included, at the map of `state`."""

    def advance(self, problem: Problem, state: State, evaluation: Evaluation, interrupt: Interrupt) -> State:
        """See `DescentSolver.advance`."""
        values = self.convex_hessian(problem, state, evaluation)
        direction = direction_in_metric(problem, values, evaluation.gradient)
        return descend(problem, state, evaluation, direction, interrupt, furthest=self.reach, safety=self.safety)
