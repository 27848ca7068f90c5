"""Groups of anchors that turn take the map along: each vertex follows a screw of its own, between those of the groups.

A group's motion to its next way point is a screw, written as a twist: a rotation vector and a velocity. Twists are extended
from the anchors to all vertices as harmonic functions of the source, and every vertex moves by the exponential of its own: a
bar whose end turns is turned evenly along its length, where straight paths by a linear system would shrink it. The Laplacian
is factored once, so that such a step costs little beside one that factorises a Hessian.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import scipy

from workbench.core.anchor_motion import LARGEST_TURN, twist_between
from workbench.core.arrays import Floats, Integers, frozen
from workbench.core.solver import energy_scale
from workbench.core.state import Approach, State
from workbench.core.status import Status

if TYPE_CHECKING:
    from workbench.core.problem import Problem

LEAST_TURN = 0.9 * LARGEST_TURN
"""Radians in a step from which on a group counts as turning: less is left to the linear system, which weighs the energy."""
MOST_RISE = 0.05
"""Part of the energy that a step may cost; a dearer one is left to a step that corrects as well."""


def turned_step(problem: Problem, state: State, displacement: Floats, groups: list[Integers]) -> State | None:
    """The state after all hard anchors went by `displacement` (k, d) and took the map along.

    groups : list of (j,) int64      rows of the hard anchors that move together

    Returns None where no group turns much, or where the step would invert a simplex or cost too much energy.
    """
    if state.inverted or problem.constraints is not None or not problem.forbids_inversions:
        return None
    x, hard = state.positions, problem.anchors.hard_vertices
    twists = np.zeros((len(hard), 6))
    for rows in groups:
        twists[rows] = twist_between(x[hard[rows]], x[hard[rows]] + displacement[rows])
    if not (np.linalg.norm(twists[:, :3], axis=1) >= LEAST_TURN).any():
        return None
    laplacian = problem.workspace.laplacian
    laplacian.serve(problem.anchors)

    def extended(values: Floats) -> Floats:
        """(k, c) at the anchors -> (N, c), harmonic between them."""
        near = np.zeros((len(x), values.shape[1]))
        near[hard] = values
        return laplacian.minimise(np.zeros_like(near), near)

    candidate = moved_by_twists(x, extended(twists))
    candidate += extended(x[hard] + displacement - candidate[hard])  # a stretch, say, that is no rigid motion
    candidate[hard] = x[hard] + displacement
    return walked_state(problem, state, candidate)


def walked_state(problem: Problem, state: State, candidate: Floats) -> State | None:
    """The state at the map `candidate` (N, d), to which the anchors led; None where it inverts a simplex or costs too much."""
    problem.workspace.counts["trials"] += 1
    if not np.isfinite(candidate).all():
        return None
    after = problem.evaluate(candidate, 1)
    risen = after.energy - state.energy > MOST_RISE * energy_scale(problem, state.energy)
    if not math.isfinite(after.energy) or after.inverted > state.inverted or risen:
        return None
    candidate = frozen(candidate)
    return replace(
        state,
        positions=candidate,
        iteration=state.iteration + 1,
        energy=after.energy,
        gradient_norm=problem.free_gradient_norm(after.gradient),
        step_size=1.0,
        inverted=after.inverted,
        anchor_error=problem.anchor_error(candidate),
        status=Status.RUNNING,
        previous_energy=float("nan"),
        limiting_simplex=-1,
        memory=None,
        approach=Approach(refresh=True, positions=candidate, evaluation=after),
    )


def moved_by_twists(points: Floats, twists: Floats) -> Floats:
    """(N, d) points, each moved by the exponential of its own twist (N, 6): a rotation vector and a velocity.

    Source: Murray, Li, Sastry 1994, section 2.3.
    """
    d = points.shape[1]
    spatial = np.pad(points, ((0, 0), (0, 3 - d)))
    turn, velocity = twists[:, :3], twists[:, 3:]
    angle = np.linalg.norm(turn, axis=1, keepdims=True)
    # sin(a/2)^2 = (1 - cos a)/2 keeps its digits for small angles; below 1e-3 two terms of a series are exact
    with np.errstate(divide="ignore", invalid="ignore"):
        once = np.where(angle < 1e-3, 0.5 - angle**2 / 24.0, 2.0 * np.sin(0.5 * angle) ** 2 / angle**2)
        twice = np.where(angle < 1e-3, 1.0 / 6.0 - angle**2 / 120.0, (angle - np.sin(angle)) / angle**3)
    across = np.cross(turn, velocity)
    slide = velocity + once * across + twice * np.cross(turn, across)
    result: Floats = (scipy.spatial.transform.Rotation.from_rotvec(turn).apply(spatial) + slide)[:, :d]
    return result
