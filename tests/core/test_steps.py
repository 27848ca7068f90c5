"""The largest step without inversion, anchor motion, the Newton system: properties against plain references."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from tests.conftest import grid, tetrahedral_grid
from workbench.core.anchor_motion import LARGEST_TURN, anchor_groups, next_displacement
from workbench.core.constraints import Anchors, LinearConstraints
from workbench.core.errors import WorkbenchError
from workbench.core.jacobians import build_elements, determinants
from workbench.core.line_search import (
    largest_step,
    largest_step_without_inversion,
    smallest_positive_root_cubic,
    smallest_positive_root_quadratic,
)
from workbench.core.linear_back_end import SingularMatrixError
from workbench.core.linear_solver import BACK_ENDS, available_back_ends
from workbench.core.newton_system import NewtonSystem
from workbench.core.problem import Problem
from workbench.core.registry import registry

coefficient = st.one_of(st.just(0.0), st.floats(-1e6, 1e6, allow_nan=False), st.floats(-1e-9, 1e-9, allow_nan=False))


@given(coefficient, coefficient, st.floats(1e-9, 1e6))
@example(0.0, -1e-200, 1e-9)
def test_quadratic_is_positive_before_its_first_root(a: float, b: float, c: float) -> None:
    root = smallest_positive_root_quadratic(a, b, c)
    assert root > 0
    for part in (0.1, 0.5, 0.9, 0.999):
        t = part * min(root, 1e3)
        assert (a * t + b) * t + c > -1e-9 * (abs(a) * t * t + abs(b) * t + c)
    if root < 1e80:
        scale = abs(a) * root * root + abs(b) * root + c
        assert abs((a * root + b) * root + c) <= 1e-6 * scale


@given(coefficient, coefficient, coefficient, st.floats(1e-9, 1e6))
@example(0.0, 1.1205800351123752e-242, -1.0, 1.0)
@settings(max_examples=300)
def test_cubic_is_positive_before_its_first_root(a: float, b: float, c: float, d: float) -> None:
    root = smallest_positive_root_cubic(a, b, c, d)
    assert root > 0

    def value(t: float) -> float:
        return ((a * t + b) * t + c) * t + d

    for part in (0.1, 0.5, 0.9, 0.999):
        t = part * min(root, 1e3)
        assert value(t) > -1e-9 * (abs(a) * t**3 + abs(b) * t * t + abs(c) * t + d)
    if root < 1e80:
        scale = abs(a) * root**3 + abs(b) * root * root + abs(c) * root + d
        assert abs(value(root)) <= 1e-9 * scale


@pytest.mark.parametrize("mesh", [grid(4), tetrahedral_grid(2)], ids=["triangles", "tets"])
@pytest.mark.parametrize("seed", range(5))
def test_no_simplex_inverts_before_the_largest_step_and_one_does_after(mesh, seed: int) -> None:
    rng = np.random.default_rng(seed)
    elements = build_elements(mesh)
    x, d = mesh.vertices.copy(), rng.normal(size=mesh.vertices.shape)
    bound, simplex = largest_step(x, d, mesh.simplices)
    assert (determinants(elements, x + 0.999999 * bound * d) > 0).all()
    assert determinants(elements, x + 1.000001 * bound * d)[simplex] < 0
    assert largest_step(x, np.ones_like(x), mesh.simplices) == (math.inf, -1)


def test_a_group_turns_along_its_screw_and_single_anchors_go_straight() -> None:
    rng = np.random.default_rng(0)
    for d in (2, 3):
        body = rng.normal(size=(7, d))
        vector = np.array([0.0, 0.0, 3.0]) if d == 2 else np.array([1.0, 2.0, -1.5])
        turn = Rotation.from_rotvec(vector)
        targets = turn.apply(np.pad(body, ((0, 0), (0, 3 - d))))[:, :d] + np.arange(1, d + 1)
        group = [np.arange(7)]
        x = body.copy()
        count = 0
        while np.abs(x - targets).max() >= 1e-9 and count < 60:
            count += 1
            x = x + next_displacement(x, targets, group)
            distances = np.linalg.norm(x[:, None] - x[None], axis=2)
            # a rigid motion stays rigid all along: nothing shrinks on the way
            assert np.allclose(distances, np.linalg.norm(body[:, None] - body[None], axis=2), atol=1e-9)
        assert count == math.ceil(np.linalg.norm(turn.as_rotvec()) / LARGEST_TURN - 1e-9)
        single = next_displacement(body[:1], targets[:1], [np.array([0])])
        assert np.array_equal(single, targets[:1] - body[:1])


def test_anchors_joined_by_edges_are_one_group() -> None:
    mesh = grid(4)
    groups = anchor_groups(mesh.simplices, np.array([0, 1, 2, 24, 12]))
    assert sorted(sorted(g.tolist()) for g in groups) == [[0, 1, 2], [3], [4]]
    groups = anchor_groups(mesh.simplices, np.array([0, 1, 2, 24, 12]), np.array([-1, 7, 4, -1, 7]))
    assert sorted(sorted(g.tolist()) for g in groups) == [[0], [1, 4], [2], [3]], "what is said counts for more than edges"


@pytest.mark.parametrize("name", sorted(available_back_ends()))
@pytest.mark.parametrize("mesh", [grid(5), tetrahedral_grid(2)], ids=["triangles", "tets"])
def test_back_ends_solve_and_tell_of_singular_matrices(name: str, mesh) -> None:
    kind = "plane" if mesh.dimension == 2 else "volume"
    problem = Problem.create(mesh, kind, registry().distortions["symmetric-dirichlet"])
    x = mesh.vertices + 0.01 * np.random.default_rng(0).normal(size=mesh.vertices.shape)
    pattern = problem.density.pattern
    values = problem.evaluate(x, 2).hessian_values.copy()
    values[pattern.diagonal] += 1.0
    solver = BACK_ENDS[name](pattern)
    rhs = np.random.default_rng(1).normal(size=(pattern.size, 2))
    for scale in (1.0, 3.0):  # twice: the symbolic analysis is kept
        solver.factorise(scale * values)
        for b in (rhs, rhs[:, 0]):
            solution = solver.solve(b)
            product = np.column_stack([pattern.multiply(scale * values, c) for c in solution.reshape(len(b), -1).T])
            assert np.allclose(product.reshape(b.shape), b, atol=1e-9)
    with pytest.raises(SingularMatrixError):
        solver.factorise(np.zeros_like(values))


def test_elimination_and_constraints_solve_the_kkt_system() -> None:
    """(65) against the dense system."""
    mesh = grid(3)
    problem = Problem.create(mesh, "plane", registry().distortions["symmetric-dirichlet"])
    rng = np.random.default_rng(0)
    x = mesh.vertices + 0.02 * rng.normal(size=mesh.vertices.shape)
    evaluation = problem.evaluate(x, 2)
    fixed = np.array([0, 7, 3])
    displacement = 0.1 * rng.normal(size=(3, 2))
    rows = LinearConstraints(rng.normal(size=(2, x.size)), np.array([0.3, -0.2]))
    residual = rows.residual(x)
    system = NewtonSystem(problem.density.pattern)
    system.factorise(evaluation.hessian_values, fixed)
    for constraints in (None, rows):
        ours = system.solve(evaluation.gradient, displacement, constraints, residual)
        dof = (fixed[:, None] * 2 + np.arange(2)).ravel()
        select = np.zeros((len(dof), x.size))
        select[np.arange(len(dof)), dof] = 1.0
        a = select if constraints is None else np.vstack([select, constraints.matrix.toarray()])
        r = displacement.ravel() if constraints is None else np.concatenate([displacement.ravel(), residual])
        hessian = problem.density.pattern.matrix(evaluation.hessian_values).toarray()
        kkt = np.block([[hessian, a.T], [a, np.zeros((len(a), len(a)))]])
        dense = np.linalg.solve(kkt, np.concatenate([-evaluation.gradient.ravel(), r]))[: x.size]
        assert np.allclose(ours.ravel(), dense, atol=1e-6 * np.abs(dense).max())


def test_changing_anchors_keeps_the_symbolic_analysis() -> None:
    mesh = grid(3)
    problem = Problem.create(mesh, "plane", registry().distortions["symmetric-dirichlet"])
    values = problem.evaluate(mesh.vertices, 2).hessian_values
    system = problem.system
    solver = system.solver
    for fixed in ([0], [0, 5], []):
        system.factorise(values, np.array(fixed, dtype=np.int64))
        assert system.solver is solver
    other = problem.with_anchors(Anchors([3], [[0.0, 0.0]])).with_distortion(registry().distortions["arap"])
    assert other.system.solver is solver
    assert other.density.pattern is problem.density.pattern


@pytest.mark.parametrize(
    "arguments",
    [([0, 0], [[0, 0], [1, 1]]), ([0], [[np.nan, 0]]), ([0, 1], [[0, 0]]), ([0], [[0, 0]], [-1.0])],
    ids=["twice", "nan", "count", "weight"],
)
def test_anchors_that_make_no_sense_are_refused(arguments) -> None:
    with pytest.raises(WorkbenchError):
        Anchors(*arguments)


@pytest.mark.parametrize("size", [1e-80, 1.0, 1e60])
def test_the_largest_step_does_not_depend_on_the_scale(size: float) -> None:
    triangle = size * np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    lowered = size * np.array([[0.0, 0.0], [0.0, 0.0], [0.0, -2.0]])
    assert largest_step_without_inversion(triangle, lowered, np.array([[0, 1, 2]])) == pytest.approx(0.5, rel=1e-12)
    inwards = size * np.array([[0.0, 0.0], [-1.0, 1.0], [0.0, -2.0]])
    assert largest_step_without_inversion(triangle, inwards, np.array([[0, 1, 2]])) == pytest.approx(0.5, rel=1e-12)
