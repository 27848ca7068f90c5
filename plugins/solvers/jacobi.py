"""The diagonal of the Hessian as metric, with Chebyshev acceleration."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from workbench.api import (
    SAFETY,
    Derivatives,
    DescentSolver,
    Evaluation,
    Floats,
    Interrupt,
    Problem,
    State,
    Status,
    descend,
    grown_step,
    largest_step,
    moved_state,
    parameter,
)


@dataclass(frozen=True, eq=False)
class ChebyshevMemory(Derivatives):
    """The inverse diagonal and its age, the map before, Chebyshev's weight and the steps since it was 1, the step length."""

    inverse: Floats
    age: int
    previous: Floats
    omega: float
    steps: int
    length: float


@dataclass(frozen=True)
class Jacobi(DescentSolver):
    """Descent preconditioned by the diagonal of the projected Hessian, accelerated as Chebyshev's semi-iterative method.

    x_(i+1) = x_(i-1) + omega (x_i + t delta - x_(i-1)), omega = 4 / (4 - rho^2 omega) after `delay` plain steps, and a diagonal
    that is kept for `refresh` steps: Wang and Yang's. Plain steps have a line search of their own, which sets t; with each new
    diagonal a longer one is tried. An accelerated step that would raise the energy, or cannot be taken without an inversion,
    is replaced by a plain one and the acceleration starts anew, where they go back and shorten t. rho is one number instead
    of a trained schedule.
    """

    id = "jacobi"
    label = "Jacobi with Chebyshev acceleration"
    short = "Jacobi"
    citation = "Wang & Yang 2016 [WY16]; section 4.3"

    accelerate: bool = parameter(True, "Chebyshev acceleration; off: plain preconditioned descent")
    rho: float = parameter(0.999, "estimate of the spectral radius of the plain iteration", minimum=0.0, maximum=0.99999)
    delay: int = parameter(4, "plain steps before the acceleration begins", minimum=1, maximum=1000)
    refresh: int = parameter(8, "steps for which the diagonal is kept", minimum=1, maximum=1000)
    growth: float = parameter(1.5, "factor on the last plain step for the next first trial", minimum=1.0, maximum=100.0)
    safety: float = parameter(SAFETY, "part of the largest step without inversion that is taken", minimum=0.1, maximum=0.99)

    def prepare(self, problem: Problem) -> None:
        problem.density.pattern  # noqa: B018

    def advance(self, problem: Problem, state: State, evaluation: Evaluation, interrupt: Interrupt) -> State:
        memory = state.memory if isinstance(state.memory, ChebyshevMemory) else None
        if memory is not None and memory.age < self.refresh:
            inverse, age = memory.inverse, memory.age + 1
        else:
            inverse, age = self._inverse_diagonal(problem, state), 1
        direction = -inverse * evaluation.gradient
        hard = problem.anchors.hard_vertices
        direction[hard] = 0.0
        if problem.constraints is not None:
            direction = problem.constraints.tangential(direction, hard, inverse)

        if memory is not None and self.accelerate and memory.steps >= self.delay:
            omega = 4.0 / (4.0 - self.rho**2 * memory.omega) if memory.steps > self.delay else 2.0 / (2.0 - self.rho**2)
            # A new diagonal is the time to try a longer step: the plain ones may have been taken where hardly any was possible.
            for length in (self.growth * memory.length, memory.length) if age == 1 else (memory.length,):
                if interrupt():
                    return replace(state, status=Status.INTERRUPTED)
                ahead = self._accelerated(problem, state, memory.previous, length * direction, omega)
                if ahead is not None:
                    ahead = replace(ahead, step_size=length)
                    return self._remembering(ahead, state, inverse, age, omega, memory.steps + 1, length)
            memory = replace(memory, steps=0)
        first = self.growth * memory.length if memory is not None else grown_step(state, self.growth)
        following = descend(problem, state, evaluation, direction, interrupt, first=first, furthest=0.0, safety=self.safety)
        if following.status is not Status.RUNNING or following.step_size == 0.0:
            return following
        steps = memory.steps + 1 if memory is not None else 1
        return self._remembering(following, state, inverse, age, 1.0, steps, following.step_size)

    def _accelerated(self, problem: Problem, state: State, before: Floats, plain_step: Floats, omega: float) -> State | None:
        """The state after Chebyshev's step, None where it is not allowed or would raise the energy."""
        ahead = before + omega * (state.positions + plain_step - before)
        if problem.forbids_inversions:
            step = ahead - state.positions
            bound = self.safety * largest_step(state.positions, step, problem.elements.simplices)[0]
            if bound < 1.0:
                return None
        problem.workspace.counts["trials"] += 1
        moved = moved_state(problem, state, ahead)
        if moved is None or moved.energy > state.energy:
            return None
        return replace(moved, iteration=state.iteration + 1, previous_energy=state.energy)

    @staticmethod
    def _remembering(
        following: State, state: State, inverse: Floats, age: int, omega: float, steps: int, length: float
    ) -> State:
        own = following.memory
        memory = ChebyshevMemory(own.problem, own.evaluation, inverse, age, state.positions, omega, steps, length)
        return replace(following, memory=memory)

    @staticmethod
    def _inverse_diagonal(problem: Problem, state: State) -> Floats:
        """(N, d) inverse of the projected Hessian's diagonal; where that is next to nothing, of a small part of the largest."""
        evaluation = problem.evaluate(state.positions, 2)
        pattern = problem.density.pattern
        assert evaluation.hessian_values is not None
        diagonal = pattern.from_matrix_order(evaluation.hessian_values[pattern.diagonal])
        typical = float(np.median(diagonal[diagonal > 0.0])) if (diagonal > 0.0).any() else 1.0
        return 1.0 / np.maximum(diagonal, 1e-3 * typical if math.isfinite(typical) else 1.0)
