"""Scalable locally injective mappings: a reweighted Laplacian, new at each step."""

from __future__ import annotations

from dataclasses import dataclass

from workbench.api import (
    DescentSolver,
    Evaluation,
    Interrupt,
    Problem,
    State,
    descend,
    direction_in_metric,
    parameter,
    reweighted_laplacian,
)


@dataclass(frozen=True)
class Slim(DescentSolver):
    """SLIM: one linear solve with a Laplacian whose weights make its gradient that of the distortion.

    The proxy, its weights sqrt(D_i / (2 (sigma_i - s_i))), the proximal term and the line search (0.8 of the largest step
    without inversion, at most 1, halved) are the paper's and its published code's. Weights of any distortion follow from
    its derivatives instead of a table; where the quotient is no positive number, its limit or a small part of the other
    weights stands in. Armijo's rule replaces plain descent, which differs in steps that gain next to nothing.
    """

    id = "slim"
    label = "Scalable locally injective mappings"
    short = "SLIM"
    citation = "Rabinovich et al. 2017 [RPPSH17]; section 4.3"

    proximal: float = parameter(1e-4, "weight of the proximal term lambda |x - x_i|^2 / 2", minimum=0.0, maximum=1e6)
    safety: float = parameter(0.8, "part of the largest step without inversion that is taken", minimum=0.1, maximum=0.99)

    def advance(self, problem: Problem, state: State, evaluation: Evaluation, interrupt: Interrupt) -> State:
        values = reweighted_laplacian(problem, state.positions)
        d = problem.dimension
        # In space the Laplacian grows with the edges: so does the term.
        edge = (problem.total_measure / len(problem.elements.simplices)) ** (1.0 / d)
        values[problem.density.pattern.diagonal] += self.proximal * edge ** (d - 2)
        direction = direction_in_metric(problem, values, evaluation.gradient)
        return descend(problem, state, evaluation, direction, interrupt, safety=self.safety)
