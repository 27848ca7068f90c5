"""Norms of the Jacobian, which are not smooth where a simplex collapses: a descent on ever less softened ones.

The norms of (84) are convex, but like |x| at 0 they have a kink where singular values vanish, and their minima collapse
simplices: Newton's method stops far from them. So each sigma_i is softened to sqrt(sigma_i^2 + s^2), which keeps the energy
convex and makes it smooth; when the softened energy is at its minimum, s shrinks, down to `LEAST` of the size of the map.
"""

from __future__ import annotations

import numpy as np

from workbench.core.fence import fenced_step
from workbench.core.jacobians import signed_singular_values
from workbench.core.problem import Problem
from workbench.core.solver import Interrupt, Solver
from workbench.core.stages import begin, kept_stage, staged_step
from workbench.core.state import State

FIRST = 0.1
"""Softening to begin with, as part of the mean largest singular value."""
LEAST = 1e-9
"""Softening at which a minimum counts as one of the energy proper, as part of the same."""


def softened_step(solver: Solver, problem: Problem, state: State, interrupt: Interrupt) -> State:
    """`solver.step` on the softened energy; see `workbench.core.stages`."""
    stage = kept_stage(problem, state)
    if stage is None:
        size = float(np.abs(signed_singular_values(problem.elements, state.positions)[:, 0]).mean())
        stage = begin(solver, problem, state, problem.softened, FIRST * size, LEAST * size)
    return staged_step(solver, stage, state, interrupt, fenced_step)
