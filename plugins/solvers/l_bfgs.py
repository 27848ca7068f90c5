"""Limited-memory quasi-Newton with an inversion-aware line search."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from workbench.api import (
    SAFETY,
    Floats,
    Pair,
    Problem,
    QuasiNewtonSolver,
    direction_in_laplacian,
    make_pair,
    parameter,
)


@dataclass(frozen=True)
class LimitedMemoryBfgs(QuasiNewtonSolver):
    """L-BFGS whose line search ends before the first inversion, as Smith and Schaefer minimise their energies.

    The metric that the pairs begin with is the identity, as there, or the source's Laplacian, factored once; either is
    scaled to the newest pair. Armijo's rule stands alone: a pair without positive curvature is left out.
    """

    id = "l-bfgs"
    label = "Limited-memory BFGS"
    short = "L-BFGS"
    citation = "Smith & Schaefer 2015 [SS15]; Liu & Nocedal 1989 [LN89]; section 4.3"

    pairs: int = parameter(10, "steps that are remembered", minimum=1, maximum=50)
    begin_with: Literal["identity", "laplacian"] = parameter("identity", "metric that the remembered steps correct")
    safety: float = parameter(SAFETY, "part of the largest step without inversion that is taken", minimum=0.1, maximum=0.99)

    def prepare(self, problem: Problem) -> None:
        if self.begin_with == "laplacian":
            problem.workspace.laplacian.prepare()

    def initial(self, problem: Problem, gradient: Floats) -> Floats:
        return -direction_in_laplacian(problem, gradient) if self.begin_with == "laplacian" else gradient.copy()

    def pair(self, problem: Problem, step: Floats, difference: Floats) -> Pair | None:
        return make_pair(step, difference, lambda y: self.initial(problem, y))

    def first_trial(self, problem: Problem, direction: Floats, pairs: tuple[Pair, ...]) -> float:
        if pairs or self.begin_with == "laplacian":
            return 1.0
        # Nothing is known of lengths yet: no vertex moves further than a tenth of the source's diameter.
        longest = float(np.linalg.norm(direction, axis=1).max(initial=0.0))
        return 0.1 * problem.mesh.diameter / longest if longest > 0.0 else 1.0
