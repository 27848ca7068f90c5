"""Accelerated quadratic proxy: Sobolev gradient descent from an extrapolated map."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from workbench.api import (
    Evaluation,
    Extrapolated,
    Interrupt,
    LaplacianDescentSolver,
    Problem,
    State,
    Status,
    descend,
    direction_in_laplacian,
    extrapolate,
    grown_step,
    parameter,
    with_previous_map,
)


@dataclass(frozen=True)
class AcceleratedQuadraticProxy(LaplacianDescentSolver):
    """AQP: descent in the metric of the source's Laplacian, begun at y = x_i + theta (x_i - x_(i-1)).

    theta = (1 - sqrt(1/eta)) / (1 + sqrt(1/eta)), shortened to half of the largest step without inversion, as is the step
    from y, which must keep a fifth of the promised decrease: the paper's. Beside it: where the energy would rise above that
    of x_i, the step is taken from x_i instead and the momentum starts anew; a trial begins at `growth` times the step before,
    where the published code begins far longer but never above 1, which would bind distortions softer than the Laplacian.
    """

    id = "aqp"
    label = "Accelerated quadratic proxy"
    short = "AQP"
    citation = "Kovalsky, Galun, Lipman 2016 [KGL16]; section 4.3"

    accelerate: bool = parameter(True, "extrapolate before each step; off: Sobolev gradient descent")
    eta: float = parameter(100.0, "bound on the condition number in the metric, sets theta", minimum=1.0, maximum=1e8)
    limit: float = parameter(0.5, "part of the largest step without inversion that is taken", minimum=0.05, maximum=0.99)
    sufficient: float = parameter(0.2, "part of the promised decrease that a step must reach", minimum=0.0, maximum=0.5)
    growth: float = parameter(1.5, "factor on the last accepted step for the next first trial", minimum=1.0, maximum=100.0)

    @property
    def theta(self) -> float:
        """Length of the extrapolation."""
        root = math.sqrt(1.0 / self.eta)
        return (1.0 - root) / (1.0 + root)

    def advance(self, problem: Problem, state: State, evaluation: Evaluation, interrupt: Interrupt) -> State:
        if self.accelerate and isinstance(state.memory, Extrapolated):
            ahead = extrapolate(problem, state, self.theta, self.limit)
            if ahead is not None:
                following = self._descend(problem, ahead, ahead.memory.evaluation, interrupt)
                if following.status is Status.INTERRUPTED:
                    return replace(state, status=Status.INTERRUPTED)
                if following.status is Status.RUNNING and following.energy <= state.energy:
                    return with_previous_map(following, state)
        return with_previous_map(self._descend(problem, state, evaluation, interrupt), state)

    def _descend(self, problem: Problem, state: State, evaluation: Evaluation, interrupt: Interrupt) -> State:
        direction = direction_in_laplacian(problem, evaluation.gradient)
        first = grown_step(state, self.growth)
        return descend(
            problem, state, evaluation, direction, interrupt,
            first=first, furthest=0.0, safety=self.limit, sufficient=self.sufficient,
        )  # fmt: skip
