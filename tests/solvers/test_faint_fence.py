"""Anchors that go far under a distortion without a barrier: nothing but a faint fence keeps their way open."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from tests.solvers.test_convergence import case
from workbench.core.constraints import Anchors
from workbench.core.fence import along_faint_fence
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import run
from workbench.core.state import State
from workbench.core.status import Status
from workbench.engine.hand import HandFollower

STEPS = 60


def moved_hand(part: float, distortion: str = "arap") -> tuple[Problem, np.ndarray]:
    """The figure with its four outermost vertices held, the left hand on this part of a winding way across the figure."""
    mesh, _, _ = case("gingerbread")
    start = mesh.vertices
    held = np.array([start[:, 0].argmin(), start[:, 0].argmax(), start[:, 1].argmin(), start[:, 1].argmax()])
    targets = start[held]
    targets[0] += mesh.diameter * np.array([0.9 * part, 0.25 * np.sin(6.0 * part)])
    return Problem.create(mesh, "plane", registry().distortions[distortion], Anchors(held, targets)), start


@pytest.mark.parametrize("distortion", ["arap", "dirichlet"])
@pytest.mark.parametrize("id", ["projected-newton", "fast", "slim", "aqp", "gradient-descent", "block-gradient-descent"])
def test_anchors_get_where_they_shall(id: str, distortion: str) -> None:
    problem, start = moved_hand(0.3, distortion)
    states: list[State] = []
    run(registry().solvers[id](), problem, start, iterations=60, on_state=states.append)
    assert states[-1].status is not Status.STALLED
    assert states[-1].anchor_error <= problem.anchor_tolerance
    for state in states:
        assert problem.inverted(state.positions) == state.inverted == 0
        assert state.energy == pytest.approx(problem.energy(state.positions), rel=1e-12, abs=1e-15)
    there = [state for state in states if state.anchor_error <= problem.anchor_tolerance]
    for before, after in pairwise(there):
        assert after.energy <= before.energy * (1 + 1e-12)


def largest_lag() -> float:
    """Largest distance of the hand from where it shall be, as part of the diameter, on the whole way."""
    problem, start = moved_hand(0.0)
    solver = registry().solvers["projected-newton"]()
    hand = HandFollower(None, lambda: False)
    state = solver.init(problem, start)
    errors = []
    for part in np.linspace(0.0, 1.0, STEPS + 1)[1:]:
        problem = problem.with_anchors(moved_hand(part)[0].anchors)
        state = solver.rebase(problem, state)
        hand.moved()
        for _ in range(3):
            following = hand.step(problem, state)
            if following is None:
                break
            state = replace(following, status=Status.RUNNING)
            assert problem.inverted(state.positions) == 0
            assert state.energy == pytest.approx(problem.energy(state.positions), rel=1e-12, abs=1e-15)
        errors.append(state.anchor_error)
    return max(errors) / problem.mesh.diameter


def test_a_hand_is_followed_all_the_way(monkeypatch: pytest.MonkeyPatch) -> None:
    assert largest_lag() < 0.1
    monkeypatch.setattr(Problem, "needs_fence", False)
    assert largest_lag() > 0.3  # stopped by the first triangles on the brink


def test_where_the_distortion_has_a_barrier_there_is_no_other() -> None:
    asked: list[Problem] = []

    def step(problem: Problem, state: State) -> State:
        asked.append(problem)
        return state

    for distortion, needs_one in (("symmetric-dirichlet", False), ("arap", True)):
        problem, start = moved_hand(0.3, distortion)
        state = registry().solvers["projected-newton"]().init(problem, start)
        assert along_faint_fence(problem, state, step) == state if not needs_one else True
        assert (asked[-1] is problem) != needs_one
