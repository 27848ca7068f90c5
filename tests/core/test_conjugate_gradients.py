"""Conjugate gradients as a back end: exact where it must be, a descent direction however early it stops."""

from __future__ import annotations

import numpy as np
import pytest

from tests.conftest import grid, tetrahedral_grid
from workbench.core import linear_solver
from workbench.core.arrays import Floats
from workbench.core.conjugate_gradients import ConjugateGradients
from workbench.core.constraints import Anchors, LinearConstraints
from workbench.core.errors import WorkbenchError
from workbench.core.linear_back_end import SingularMatrixError
from workbench.core.linear_solver import CHOICE, make_linear_solver
from workbench.core.newton_system import NewtonSystem
from workbench.core.pattern import HessianPattern
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import run
from workbench.core.status import Status

CUBE = tetrahedral_grid(3)


def problem_of(mesh) -> tuple[Problem, Floats]:
    """A distortion with a barrier on a mesh, and a rough map of it without inversions."""
    problem = Problem.create(mesh, "plane" if mesh.dimension == 2 else "volume", registry().distortions["symmetric-dirichlet"])
    shear = np.array([[1.3, 0.4, 0.0], [0.0, 0.7, 0.1], [0.1, 0.0, 1.1]])[: mesh.dimension, : mesh.dimension]
    x = (mesh.vertices + 0.01 * np.random.default_rng(0).normal(size=mesh.vertices.shape)) @ shear
    assert problem.inverted(x) == 0
    return problem, x


def system_with(problem: Problem, tolerance: float) -> NewtonSystem:
    system = NewtonSystem(problem.density.pattern)
    system._solver = ConjugateGradients(problem.density.pattern, tolerance)
    return system


@pytest.mark.parametrize("mesh", [grid(5), CUBE], ids=["triangles", "tets"])
def test_it_solves_as_exactly_as_asked(mesh) -> None:
    problem, x = problem_of(mesh)
    pattern = problem.density.pattern
    values = problem.evaluate(x, 2).hessian_values.copy()
    values[pattern.diagonal] += 1.0
    rhs = np.random.default_rng(1).normal(size=(pattern.size, 2))
    solver = ConjugateGradients(pattern, 1e-12)
    dense = pattern.matrix(values).toarray()
    order = (pattern.order[:, None] * mesh.dimension + np.arange(mesh.dimension)).ravel()
    reference = np.linalg.solve(dense[np.ix_(order, order)], rhs)
    for scale in (1.0, 1e-30, 1e30):
        solver.factorise(scale * values)
        assert np.allclose(scale * solver.solve(rhs), reference, rtol=1e-8, atol=1e-9)
        assert np.array_equal(solver.solve(rhs[:, 1]), solver.solve(rhs)[:, 1])


def test_a_single_coordinate_a_vertex() -> None:
    """The pattern of a Laplacian: one number a vertex."""
    pattern = problem_of(CUBE)[0].density.scalar_pattern
    values = np.where(pattern.rows == pattern.columns, 30.0, -1.0)
    solver = ConjugateGradients(pattern, 1e-12)
    solver.factorise(values)
    rhs = np.random.default_rng(0).normal(size=pattern.size)
    assert np.allclose(pattern.multiply(values, solver.solve(rhs)), rhs, atol=1e-9)


@pytest.mark.parametrize("tolerance", [0.9, 1e-1, 1e-3, 1e-6])
def test_every_direction_descends_and_better_ones_gain_more(tolerance: float) -> None:
    problem, x = problem_of(CUBE)
    evaluation = problem.evaluate(x, 2)
    fixed = np.array([0, 21, 63])

    def gain(tolerance: float) -> float:
        system = system_with(problem, tolerance)
        system.factorise(evaluation.hessian_values, fixed)
        direction = system.solve(evaluation.gradient)
        assert np.abs(direction[fixed]).max() == 0.0
        slope = float((evaluation.gradient * direction).sum())
        curved = problem.density.pattern.matrix(evaluation.hessian_values) @ direction.ravel()
        assert slope < 0
        return -slope - 0.5 * float(direction.ravel() @ curved)

    best = gain(1e-12)
    found = gain(tolerance)
    assert 0.0 < found <= best * (1 + 1e-12)
    assert best - found <= tolerance * best  # the model's error is the square of that of the direction


def test_anchors_move_exactly_as_far_as_asked_and_constraints_hold() -> None:
    problem, x = problem_of(CUBE)
    evaluation = problem.evaluate(x, 2)
    rng = np.random.default_rng(0)
    fixed, displacement = np.array([0, 7, 30]), 0.1 * rng.normal(size=(3, 3))
    rows = LinearConstraints(rng.normal(size=(2, x.size)), np.array([0.3, -0.2]))
    system = system_with(problem, 1e-3)
    system.factorise(evaluation.hessian_values, fixed)
    for constraints in (None, rows):
        direction = system.solve(evaluation.gradient, displacement, constraints, rows.residual(x))
        assert np.array_equal(direction[fixed], displacement)
    assert np.abs(rows.residual(x + direction)).max() < 1e-9


def test_a_singular_matrix_whose_system_has_a_solution_is_no_obstacle() -> None:
    """Without anchors a map floats; its gradient does not push it."""
    problem, x = problem_of(CUBE)
    evaluation = problem.evaluate(x, 2)
    system = system_with(problem, 1e-8)
    system.factorise(evaluation.hessian_values, np.empty(0, dtype=np.int64))
    direction = system.solve(evaluation.gradient)
    hessian = problem.density.pattern.matrix(evaluation.hessian_values)
    assert np.allclose((hessian @ direction.ravel()), -evaluation.gradient.ravel(), atol=1e-5)


def test_matrices_that_are_not_definite_are_told() -> None:
    pattern = problem_of(CUBE)[0].density.pattern
    solver = ConjugateGradients(pattern)
    for wrong in (np.zeros(pattern.entry_count), np.full(pattern.entry_count, np.nan)):
        with pytest.raises(SingularMatrixError):
            solver.factorise(wrong)
    own_block = pattern.rows // 3 == pattern.columns // 3
    solver.factorise(np.where(pattern.rows == pattern.columns, 1.0, np.where(own_block, 0.0, -3.0)))
    with pytest.raises(SingularMatrixError):
        solver.solve(np.ones(pattern.size))


def test_the_same_input_gives_the_same_bits() -> None:
    problem, x = problem_of(CUBE)
    evaluation = problem.evaluate(x, 2)

    def direction() -> Floats:
        system = system_with(problem, 1e-3)
        system.factorise(evaluation.hessian_values, np.array([0]))
        return system.solve(evaluation.gradient)

    assert np.array_equal(direction(), direction())


def test_it_can_be_asked_for_by_name(monkeypatch) -> None:
    monkeypatch.delenv(CHOICE, raising=False)
    pattern: HessianPattern = problem_of(CUBE)[0].density.pattern
    assert isinstance(make_linear_solver(pattern, "cg"), ConjugateGradients)
    assert not isinstance(make_linear_solver(pattern), ConjugateGradients)
    with pytest.raises(WorkbenchError, match=r"no linear solver 'cgs' here; there are: .*cg"):
        make_linear_solver(pattern, "cgs")
    monkeypatch.setenv(CHOICE, "cg")
    assert isinstance(make_linear_solver(pattern), ConjugateGradients)


def test_it_is_chosen_for_large_solids_and_for_nothing_else(monkeypatch) -> None:
    monkeypatch.delenv(CHOICE, raising=False)
    monkeypatch.setattr(linear_solver, "LARGE_SOLID", 3 * CUBE.vertex_count - 1)
    solid, plane = problem_of(CUBE)[0].density, problem_of(grid(12))[0].density
    assert plane.pattern.size > linear_solver.LARGE_SOLID
    assert isinstance(make_linear_solver(solid.pattern), ConjugateGradients)
    assert not isinstance(make_linear_solver(solid.scalar_pattern), ConjugateGradients)
    assert not isinstance(make_linear_solver(plane.pattern), ConjugateGradients)


def test_a_run_ends_at_the_same_minimum() -> None:
    problem, x = problem_of(CUBE)
    held = np.array([0, 3, 60])
    anchors = Anchors(held, CUBE.vertices[held] + [[-0.2, 0.0, 0.1], [0.0, 0.1, 0.0], [0.3, 0.2, 0.2]])
    ends = []
    for name in ("cg", "multifrontal"):
        own = Problem.create(CUBE, "volume", problem.distortion, anchors)
        own.system._solver = make_linear_solver(own.density.pattern, name)
        result = run(registry().solver("projected-newton")(), own, x, tolerance=1e-10)
        assert result.state.status is Status.CONVERGED and result.state.inverted == 0
        assert np.array_equal(result.state.positions[held], anchors.targets)
        ends.append(result.state)
    assert ends[0].energy == pytest.approx(ends[1].energy, rel=1e-8)
