"""A step taken apart: the same step as the run takes, nothing of the run changed, numbers that fit each other."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest

from workbench.core.constraints import Anchors
from workbench.core.dissection import dissect
from workbench.core.distortion import Distortion
from workbench.core.jacobians import determinants
from workbench.core.line_search import armijo, largest_step_without_inversion
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.solver import Interrupt, Solver, never
from workbench.core.state import State
from workbench.core.status import Status

SOLVERS = sorted(registry().solvers)


def half_way(id: str, mesh: Mesh) -> tuple[Solver, Problem, State]:
    """A solver some steps after a bent start, its memory filled."""
    solver = registry().solver(id)()
    distortion = Distortion.resolve(solver.distortions[0] if solver.distortions else "symmetric-dirichlet")
    held = np.array([0, mesh.vertex_count - 1])
    x, y = mesh.vertices.T
    start = np.c_[x + 0.3 * y * y, 0.8 * y + 0.2 * np.sin(2 * x)]
    problem = Problem.create(mesh, "plane", distortion, Anchors(held, start[held]))
    state = solver.init(problem, start)
    for _ in range(3):
        state = solver.step(problem, state)
    return solver, problem, state


@pytest.mark.parametrize("id", SOLVERS)
def test_it_is_the_step_that_the_run_takes(id: str, square: Mesh) -> None:
    solver, problem, state = half_way(id, square)
    before, counts = state.positions.copy(), dict(problem.workspace.all_counts())
    found = dissect(solver, problem, state)
    assert problem.workspace.all_counts() == counts
    np.testing.assert_array_equal(state.positions, before)
    expected = solver.step(problem, state)
    scale = np.abs(expected.positions - before).max()
    np.testing.assert_allclose(found.after.positions, expected.positions, atol=1e-9 * max(scale, 1e-12) + 1e-13)
    # the walk ends at the map after, and its energy is on the curve
    np.testing.assert_allclose(before + found.step_size * found.direction, found.after.positions, atol=1e-12)
    if found.step_size:
        on_curve = np.interp(found.step_size, found.curve_sizes, found.curve_energies)
        assert on_curve == pytest.approx(found.after.energy, rel=1e-2)
        assert found.slope < 0
    assert found.curve_energies[0] == pytest.approx(state.energy, rel=1e-12)


@pytest.mark.parametrize("id", SOLVERS)
def test_the_bound_is_where_a_triangle_collapses(id: str, square: Mesh) -> None:
    solver, problem, state = half_way(id, square)
    found = dissect(solver, problem, state)
    if not np.isfinite(found.bound):
        return
    below = determinants(problem.elements, state.positions + 0.999 * found.bound * found.direction)
    beyond = determinants(problem.elements, state.positions + 1.001 * found.bound * found.direction)
    assert (below > 0).all() and not beyond[found.limiting_simplex] > 0
    assert found.step_size <= found.bound


def test_trials_are_those_of_the_line_search(square: Mesh) -> None:
    solver, problem, state = half_way("gradient-descent", square)
    found = dissect(solver, problem, state)
    assert len(found.trial_sizes) and found.trial_on_line.all()
    for size, energy in zip(found.trial_sizes, found.trial_energies, strict=True):
        assert problem.energy(state.positions + size * found.direction) == pytest.approx(energy, rel=1e-10)
    assert np.isclose(found.trial_sizes, found.step_size).any()


@dataclass(frozen=True)
class Uphill(Solver):
    """Searches where nothing is to be found."""

    id = "uphill"
    label = "Uphill"

    def step(self, problem: Problem, state: State, interrupt: Interrupt = never) -> State:
        x, evaluation = state.positions, problem.evaluate(state.positions, 1)
        up, slope = evaluation.gradient, -float((evaluation.gradient**2).sum())
        first = 0.5 * largest_step_without_inversion(x, up, problem.elements.simplices)
        found = armijo(problem.energy_and_inverted, x, up, evaluation.energy, slope, first, interrupt, trials=6)
        assert found.size == 0.0
        return replace(state, status=Status.NO_DESCENT)


def test_a_step_that_finds_nothing_shows_what_it_tried(square: Mesh) -> None:
    _, problem, state = half_way("gradient-descent", square)
    found = dissect(Uphill(), problem, replace(state, memory=None))
    assert found.after.status is Status.NO_DESCENT and found.step_size == 0.0
    np.testing.assert_allclose(found.direction / np.linalg.norm(found.direction), _unit(problem.gradient(state.positions)))
    assert found.slope > 0 and len(found.trial_sizes) == 6 and found.trial_on_line.all()
    assert (found.trial_energies > state.energy).all()
    np.testing.assert_allclose(found.trial_sizes, 0.5 ** np.arange(6))
    assert found.bound == pytest.approx(2.0)


def _unit(values: np.ndarray) -> np.ndarray:
    return values / np.linalg.norm(values)


def test_anchors_that_lag_are_walked_to(square: Mesh) -> None:
    held = np.array([0, square.vertex_count - 1])
    targets = square.vertices[held] + np.array([[0.0, 0.0], [0.4, 0.2]])
    problem = Problem.create(square, "plane", Distortion.resolve("mips"), Anchors(held, targets))
    solver = registry().solver("slim")()
    state = solver.init(problem, square.vertices)
    found = dissect(solver, problem, state)
    assert found.after.anchor_error < state.anchor_error
    assert np.abs(found.direction[held[1]]).max() > 0
