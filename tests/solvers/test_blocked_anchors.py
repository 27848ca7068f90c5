"""One anchor that cannot go on stops neither the others nor ruins the map: it waits."""

from __future__ import annotations

import numpy as np

from tests.conftest import grid
from workbench.core.anchor_steps import approach_anchors, predict_with_last_factor
from workbench.core.arrays import Floats, Integers
from workbench.core.constraints import Anchors
from workbench.core.distortion import Distortion
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import run
from workbench.core.solver import never
from workbench.core.status import Status

MESH = grid(8)
CENTRE = 40
FAR_CORNERS = np.array([0, 8])


def penned_in() -> tuple[Integers, Floats]:
    """A vertex inside, all its neighbours held where they are, and its target outside of them: anchors and targets."""
    corners = MESH.simplices[(MESH.simplices == CENTRE).any(axis=1)]
    ring = np.setdiff1d(corners, CENTRE)
    return np.append(ring, CENTRE), np.vstack([MESH.vertices[ring], MESH.vertices[CENTRE] + [0.5, 0.0]])


def with_corners(shift: float) -> Problem:
    vertices, targets = penned_in()
    anchors = Anchors(np.append(vertices, FAR_CORNERS), np.vstack([targets, MESH.vertices[FAR_CORNERS] + [-shift, 0.0]]))
    return Problem.create(MESH, "plane", Distortion.resolve("symmetric-dirichlet"), anchors)


def way_left(problem: Problem, positions: Floats) -> Floats:
    return np.linalg.norm(positions[problem.anchors.hard_vertices] - problem.anchors.hard_targets, axis=1)


def test_the_others_arrive_and_the_map_stays_sound() -> None:
    problem = with_corners(0.4)
    result = run(registry().solver("projected-newton")(), problem, MESH.vertices)
    left = way_left(problem, result.state.positions)
    assert result.state.status is Status.STALLED and result.state.inverted == 0
    assert left[-2:].max() <= problem.anchor_tolerance, "nothing is in the way of the corners"
    assert 0.3 < left[-3] < 0.5, "the vertex comes no further than its neighbours"
    assert result.state.energy < 1e6, "what cannot move is not pressed flat"


def test_others_go_on_while_one_has_stalled() -> None:
    solver = registry().solver("projected-newton")()
    stalled = run(solver, with_corners(0.0), MESH.vertices)
    assert stalled.state.status is Status.STALLED
    problem = with_corners(0.4)
    after = run(solver, problem, stalled.state.positions)
    assert way_left(problem, after.state.positions)[-2:].max() <= problem.anchor_tolerance


def test_a_prediction_leaves_out_what_is_blocked() -> None:
    problem = with_corners(0.0)
    solver = registry().solver("projected-newton")()
    stalled = run(solver, problem, MESH.vertices).state.positions
    moved = with_corners(0.01)
    state = approach_anchors(problem, solver.init(problem, stalled), never)  # for its factor
    shared = problem.with_anchors(moved.anchors)
    predicted = predict_with_last_factor(shared, solver.rebase(shared, state), never)
    assert predicted is not None and predicted.inverted == 0
    assert way_left(shared, predicted.positions)[-2:].max() <= shared.anchor_tolerance
