"""Steepest descent in the metric of the source's Laplacian."""

from __future__ import annotations

from dataclasses import dataclass

from workbench.api import (
    SAFETY,
    Evaluation,
    Interrupt,
    LaplacianDescentSolver,
    Problem,
    State,
    descend,
    direction_in_laplacian,
    grown_step,
    parameter,
)


@dataclass(frozen=True)
class SobolevGradientDescent(LaplacianDescentSolver):
    """Gradient descent with the Dirichlet energy of the source as metric: factored once, two solves a step.

    With Armijo's rule below the largest step without inversion; each step first tries `growth` times the accepted length
    of the one before.
    """

    id = "sobolev-gradient-descent"
    label = "Sobolev gradient descent"
    short = "SGD"
    citation = "Neuberger 1985 [N85]; Kovalsky, Galun, Lipman 2016 [KGL16] without acceleration; section 4.3"

    growth: float = parameter(2.0, "factor on the last accepted step for the next first trial", minimum=1.0, maximum=100.0)
    safety: float = parameter(SAFETY, "part of the largest step without inversion that is taken", minimum=0.1, maximum=0.99)

    def advance(self, problem: Problem, state: State, evaluation: Evaluation, interrupt: Interrupt) -> State:
        direction = direction_in_laplacian(problem, evaluation.gradient)
        first = grown_step(state, self.growth)
        return descend(problem, state, evaluation, direction, interrupt, first=first, furthest=0.0, safety=self.safety)
