"""Distortions without a barrier, whose minima lie against the step bound: a descent along an ever weaker fence.

Where nothing in D keeps simplices from inverting, as in (33), the first ones on the brink shorten every further step, until
the map is stuck far from any minimum. So a fence/det is added to D as soon as a step is shortened so, as in interior-point
methods: simplices turn away from the brink in time. When that energy is at its minimum, the fence is made weaker, down to
`LEAST` of the energy. While anchors are on their way, a faint fence stands all the time, or they would soon push some simplex
to the brink and get no further.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from workbench.core.jacobians import determinants
from workbench.core.problem import Problem
from workbench.core.solver import Interrupt, Solver, characteristic_curvature
from workbench.core.stages import begin, kept_stage, staged_step
from workbench.core.state import State

SHORT = 0.1
"""A step that the step bound makes shorter than this part of its direction puts up the fence."""
FIRST = 0.1
"""Energy of the fence to begin with, as part of that of the map."""
LEAST = 1e-9
"""Energy of the fence with which a minimum counts as one of the energy proper, as part of the same."""

FAINT = 5e-3
"""Weight of the fence while anchors are on their way, as part of the curvature of D at the identity."""


def fenced_step(solver: Solver, problem: Problem, state: State, interrupt: Interrupt) -> State:
    """`solver.step`; from the first one on that the step bound shortens, with a fence (see `workbench.core.stages`)."""
    if problem.anchors_lag(state.positions) and kept_stage(problem, state) is None:
        walked = along_faint_fence(problem, state, lambda fenced, begun: solver.step(fenced, begun, interrupt))
        assert walked is not None
        return walked
    if not solver.takes_fences or state.inverted or not problem.needs_fence:
        return solver.step(problem, state, interrupt)
    stage = kept_stage(problem, state)
    if stage is None:
        following = solver.step(problem, state, interrupt)
        is_short = following.limiting_simplex >= 0 and following.step_size < SHORT
        if not is_short or not state.energy > 0.0:
            return following
        fence = float(problem.elements.rest_measures @ (1.0 / determinants(problem.elements, state.positions)))
        if not np.isfinite(fence):
            return following
        share = state.energy / fence
        stage = begin(solver, problem, state, problem.fenced, FIRST * share, LEAST * share)
    return staged_step(solver, stage, state, interrupt)


def along_faint_fence(problem: Problem, state: State, step: Callable[[Problem, State], State | None]) -> State | None:
    """`step(problem, state)` with a faint fence, where the distortion needs one; the outcome has the energy proper."""
    if state.inverted or not problem.needs_fence:
        return step(problem, state)
    fenced = problem.fenced(FAINT * characteristic_curvature(problem))
    following = step(fenced, replace(state, energy=fenced.energy(state.positions)))
    if following is None:
        return None
    is_still = following.positions is state.positions
    return replace(following, energy=state.energy if is_still else problem.energy(following.positions))
