"""Steepest descent in the metric of the Killing energy on the current map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from workbench.api import (
    SAFETY,
    DescentSolver,
    Evaluation,
    Interrupt,
    Kind,
    Problem,
    State,
    descend,
    direction_in_metric,
    grown_step,
    killing_energy,
    parameter,
)


@dataclass(frozen=True)
class Akvf(DescentSolver):
    """Isometry-aware preconditioning: the step is the field that descends fastest for what it deviates from a rigid motion.

    The metric, its rest measures as weights and the small multiple of the identity (`regularisation`) are the paper's.
    Armijo's rule replaces the line search of Wolfe's conditions: the metric changes at each step, so that nothing is learnt
    from curvature along it. The tetrahedral metric is the same formula in space.
    """

    id = "akvf"
    label = "Isometry-aware preconditioning"
    short = "AKVF"
    citation = "Claici et al. 2017 [CBSS17]; section 4.3"
    kinds: ClassVar[tuple[Kind, ...]] = ("plane", "parameterize", "volume")

    regularisation: float = parameter(1e-4, "multiple of the identity added to the metric", minimum=0.0, maximum=1.0)
    safety: float = parameter(SAFETY, "part of the largest step without inversion that is taken", minimum=0.1, maximum=0.99)
    growth: float = parameter(4.0, "factor on the last accepted step for the next first trial", minimum=1.0, maximum=100.0)

    def advance(self, problem: Problem, state: State, evaluation: Evaluation, interrupt: Interrupt) -> State:
        values = killing_energy(problem, state.positions)
        values[problem.density.pattern.diagonal] += self.regularisation
        direction = direction_in_metric(problem, values, evaluation.gradient)
        first = grown_step(state, self.growth)
        return descend(problem, state, evaluation, direction, interrupt, first=first, furthest=0.0, safety=self.safety)
