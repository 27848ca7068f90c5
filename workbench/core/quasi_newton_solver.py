"""The frame of limited-memory methods: direction from the last pairs, line search, the next pair."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import replace
from typing import TYPE_CHECKING

from workbench.core.arrays import Floats
from workbench.core.descent import Derivatives, descend
from workbench.core.descent_solver import DescentSolver, free_gradient
from workbench.core.energy import Evaluation
from workbench.core.limited_memory import Pair, QuasiNewtonMemory, quasi_newton_direction
from workbench.core.solver import Interrupt
from workbench.core.state import State
from workbench.core.status import Status

if TYPE_CHECKING:
    from workbench.core.problem import Problem


class QuasiNewtonSolver(DescentSolver):
    """A solver that learns its metric from the steps that it took.

    Where the learnt direction finds no step, the pairs are dropped and the step is one of steepest descent in the metric
    that they begin with.
    """

    pairs: int
    safety: float

    @abstractmethod
    def initial(self, problem: Problem, gradient: Floats) -> Floats:
        """K^-1 gradient (N, d) for the metric K that the pairs begin with."""

    @abstractmethod
    def pair(self, problem: Problem, step: Floats, difference: Floats) -> Pair | None:
        """What is remembered of a step and the difference of the free gradients at its ends."""

    def filtered(self, problem: Problem, state: State, direction: Floats, gradient: Floats) -> Floats:
        """The direction that is searched along, made from the learnt one."""
        return direction

    def first_trial(self, problem: Problem, direction: Floats, pairs: tuple[Pair, ...]) -> float:
        """First step of the line search."""
        return 1.0

    def advance(self, problem: Problem, state: State, evaluation: Evaluation, interrupt: Interrupt) -> State:
        """See `DescentSolver.advance`."""
        gradient = free_gradient(problem, evaluation.gradient)
        kept = state.memory.pairs if isinstance(state.memory, QuasiNewtonMemory) else ()
        following = self._search(problem, state, evaluation, gradient, kept, interrupt)
        if following.status is Status.NO_DESCENT and kept:
            kept = ()
            following = self._search(problem, state, evaluation, gradient, kept, interrupt)
        memory = following.memory
        if following.status is not Status.RUNNING or following.step_size == 0.0 or not isinstance(memory, Derivatives):
            return following
        difference = free_gradient(problem, memory.evaluation.gradient) - gradient
        pair = self.pair(problem, following.positions - state.positions, difference)
        if pair is not None:
            kept = (*kept, pair)[-self.pairs :]
        return replace(following, memory=QuasiNewtonMemory(memory.problem, memory.evaluation, kept))

    def _search(
        self,
        problem: Problem,
        state: State,
        evaluation: Evaluation,
        gradient: Floats,
        pairs: tuple[Pair, ...],
        interrupt: Interrupt,
    ) -> State:
        scale = pairs[-1].scale if pairs else 1.0
        direction = quasi_newton_direction(gradient, pairs, lambda g: scale * self.initial(problem, g))
        direction = self.filtered(problem, state, direction, gradient)
        first = self.first_trial(problem, direction, pairs)
        return descend(problem, state, evaluation, direction, interrupt, first=first, furthest=first, safety=self.safety)
