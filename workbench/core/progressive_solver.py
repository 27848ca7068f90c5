"""Steps on progressive references until the map is close, then others on the true source."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, ClassVar

from workbench.core.descent import Derivatives, descend
from workbench.core.descent_solver import DescentSolver, direction_in_metric
from workbench.core.energy import Evaluation
from workbench.core.line_search import SAFETY
from workbench.core.linear_back_end import SingularMatrixError
from workbench.core.method import parameter
from workbench.core.progressive_reference import progressive_problem
from workbench.core.solver import Interrupt
from workbench.core.state import State
from workbench.core.status import Status

if TYPE_CHECKING:
    from workbench.core.problem import Problem


@dataclass(frozen=True, eq=False)
class Progress(Derivatives):
    """The derivatives at the newest map, and how the steps go.

    `is_close` : the true source is used from now on
    `rung`, `rest` : what `ProgressiveSolver.near` wants to know at the next step
    """

    is_close: bool
    rung: int = 0
    rest: int = 0


@dataclass(frozen=True)
class ProgressiveSolver(DescentSolver):
    """Newton steps for a reference from which no triangle is distorted by more than `bound`, while the map is far.

    The reference is drawn anew at every step. Once it meets the source, or a step gains less than `close`, the steps are those
    of `near`. Step lengths are found on the energy of the true source, so that it never rises; a reference whose step does
    not lower it is given up. Tetrahedra and inverted simplices have no reference: there every step is one of `near`.
    """

    second_order: ClassVar[bool] = True

    bound: float = parameter(250.0, "largest symmetric Dirichlet density against the reference", minimum=4.1, maximum=1e12)
    close: float = parameter(0.01, "relative decrease of a step below which the source is used", minimum=0.0, maximum=1.0)
    uniform: bool = parameter(True, "every triangle of a reference weighs the same, instead of its area")
    safety: float = parameter(SAFETY, "part of the largest step without inversion that is taken", minimum=0.1, maximum=0.99)
    reach: float = parameter(4.0, "longest step tried, in Newton steps; 1: never a longer one", minimum=1.0, maximum=10.0)

    @abstractmethod
    def near(
        self, problem: Problem, state: State, evaluation: Evaluation, progress: Progress, interrupt: Interrupt
    ) -> tuple[State, Progress]:
        """A step on the true source, and the progress to remember, whose derivatives are of no account."""

    def advance(self, problem: Problem, state: State, evaluation: Evaluation, interrupt: Interrupt) -> State:
        """See `DescentSolver.advance`."""
        memory = state.memory
        progress = memory if isinstance(memory, Progress) else Progress(problem, evaluation, False)
        if problem.dimension == 2 and not (progress.is_close or state.inverted):
            reference, _ = progressive_problem(problem, state.positions, self.bound, self.uniform)
            following = None if reference is problem else self._approach(problem, reference, state, evaluation, interrupt)
            if following is not None:
                return following
            if interrupt():
                return replace(state, status=Status.INTERRUPTED)
        following, progress = self.near(problem, state, evaluation, progress, interrupt)
        return _remembering(following, replace(progress, is_close=True))

    def newton(self, problem: Problem, reference: Problem, state: State, evaluation: Evaluation, interrupt: Interrupt) -> State:
        """Towards the minimum of the energy on `reference`, as far as the energy of `problem` goes down."""
        there = reference.evaluate(state.positions, 2)
        assert there.hessian_values is not None
        direction = direction_in_metric(reference, there.hessian_values, there.gradient)
        return descend(problem, state, evaluation, direction, interrupt, furthest=self.reach, safety=self.safety)

    def _approach(
        self, problem: Problem, reference: Problem, state: State, evaluation: Evaluation, interrupt: Interrupt
    ) -> State | None:
        """A step on the reference; None where it is of no use for the energy of the source."""
        try:
            following = self.newton(problem, reference, state, evaluation, interrupt)
        except SingularMatrixError:
            return None
        if following.status is Status.INTERRUPTED:
            return following
        if following.status is not Status.RUNNING or following.step_size == 0.0:
            return None
        is_close = state.energy - following.energy <= self.close * abs(following.energy)
        # A small gain here says that the source is due, not that the map is the optimum.
        following = replace(following, previous_energy=float("nan"))
        return _remembering(following, Progress(problem, evaluation, is_close))


def _remembering(following: State, progress: Progress) -> State:
    """`following` with `progress` beside the derivatives that its step ended with."""
    memory = following.memory
    if not isinstance(memory, Derivatives):
        return following
    return replace(following, memory=replace(progress, problem=memory.problem, evaluation=memory.evaluation))
