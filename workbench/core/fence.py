"""Distortions without a barrier, whose minima lie against the step bound: a descent along an ever weaker fence.

Where nothing in D keeps simplices from inverting, as in (33), the first ones on the brink shorten every further step, until
the map is stuck far from any minimum. So a fence/det is added to D as soon as a step is shortened so, as in interior-point
methods: simplices turn away from the brink in time. When that energy is at its minimum, the fence is made weaker, down to
`LEAST` of the energy.
"""

from __future__ import annotations

import numpy as np

from workbench.core.jacobians import determinants
from workbench.core.problem import Problem
from workbench.core.solver import Interrupt, Solver
from workbench.core.stages import begin, kept_stage, staged_step
from workbench.core.state import State

SHORT = 0.1
"""A step that the step bound makes shorter than this part of its direction puts up the fence."""
FIRST = 0.1
"""Energy of the fence to begin with, as part of that of the map."""
LEAST = 1e-9
"""Energy of the fence with which a minimum counts as one of the energy proper, as part of the same."""


def fenced_step(solver: Solver, problem: Problem, state: State, interrupt: Interrupt) -> State:
    """`solver.step`; from the first one on that the step bound shortens, with a fence (see `workbench.core.stages`)."""
    if not solver.takes_fences or state.inverted or not problem.needs_fence:
        return solver.step(problem, state, interrupt)
    stage = kept_stage(problem, state)
    if stage is None:
        following = solver.step(problem, state, interrupt)
        is_short = following.limiting_simplex >= 0 and following.step_size < SHORT
        if not is_short or problem.anchors_lag(state.positions) or not state.energy > 0.0:
            return following
        fence = float(problem.elements.rest_measures @ (1.0 / determinants(problem.elements, state.positions)))
        if not np.isfinite(fence):
            return following
        share = state.energy / fence
        stage = begin(solver, problem, state, problem.fenced, FIRST * share, LEAST * share)
    return staged_step(solver, stage, state, interrupt)
