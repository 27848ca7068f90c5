"""The kept Laplacian: the Hessian of Dirichlet energy, with anchors, soft and hard, and linear constraints."""

from __future__ import annotations

import numpy as np
import pytest

from tests.conftest import grid, tetrahedral_grid
from workbench.core.constraints import Anchors, LinearConstraints
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.registry import registry

SOURCES = {"plane": grid(5), "volume": tetrahedral_grid(2)}


def dirichlet_problem(kind: str) -> Problem:
    mesh: Mesh = SOURCES[kind]
    d, far = mesh.dimension, mesh.vertex_count - 1
    rng = np.random.default_rng(1)
    anchors = Anchors([0, 3, far], rng.normal(size=(3, d)), [np.inf, 2.0, np.inf])
    rows = np.zeros((2, mesh.vertex_count * d))
    rows[0, [5 * d, 6 * d]] = 1.0, -1.0
    rows[1, 7 * d + 1] = 1.0
    constraints = LinearConstraints(rows, np.zeros(2))
    return Problem.create(mesh, kind, registry().distortions["dirichlet"], anchors, constraints=constraints)  # type: ignore[arg-type]


@pytest.mark.parametrize("kind", sorted(SOURCES))
def test_one_step_from_anywhere_is_the_constrained_minimum(kind: str) -> None:
    """Dirichlet energy is quadratic: after one step the gradient is a combination of the rows of A and the anchored rows."""
    problem = dirichlet_problem(kind)
    assert problem.constraints is not None
    laplacian = problem.workspace.laplacian
    laplacian.serve(problem.anchors)
    x = np.random.default_rng(2).normal(size=(problem.mesh.vertex_count, problem.dimension))
    step = laplacian.direction(problem.gradient(x), problem.constraints)
    hard = problem.anchors.hard_vertices
    assert np.array_equal(step[hard], np.zeros_like(step[hard]))
    assert np.abs(problem.constraints.matrix @ step.reshape(-1)).max() < 1e-12
    left = problem.gradient(x + step)
    assert np.abs(problem.constraints.tangential(left, hard)[np.setdiff1d(np.arange(len(x)), hard)]).max() < 1e-8


@pytest.mark.parametrize("kind", sorted(SOURCES))
def test_the_matrix_is_the_hessian_of_the_energy(kind: str) -> None:
    problem = dirichlet_problem(kind)
    laplacian = problem.workspace.laplacian
    laplacian.serve(problem.anchors)
    x, y = np.random.default_rng(3).normal(size=(2, problem.mesh.vertex_count, problem.dimension))
    assert laplacian.multiply(x - y) == pytest.approx(problem.gradient(x) - problem.gradient(y), abs=1e-12)


def test_the_factor_outlives_targets_and_distortions_and_not_anchored_vertices() -> None:
    problem = dirichlet_problem("plane")
    laplacian, anchors = problem.workspace.laplacian, problem.anchors
    moved = Anchors(anchors.vertices, anchors.targets + 1.0, anchors.weights)
    other = problem.with_distortion(registry().distortions["mips"])
    for served in (anchors, moved, other.anchors):
        other.workspace.laplacian.serve(served)
    assert laplacian.counts["factorise"] == 1
    laplacian.serve(Anchors(anchors.vertices, anchors.targets))
    assert laplacian.counts["factorise"] == 2


def test_minimise_keeps_the_anchors_and_finds_the_map_it_is_asked_for() -> None:
    problem = dirichlet_problem("plane")
    laplacian = problem.workspace.laplacian
    laplacian.serve(problem.anchors)
    wanted = np.random.default_rng(4).normal(size=(problem.mesh.vertex_count, 2))
    near = wanted.copy()
    near[1] += 1.0
    found = laplacian.minimise(laplacian.multiply(wanted), near)
    assert found == pytest.approx(wanted, abs=1e-8)


def test_a_map_without_anchors_floats_and_moves_without_drifting() -> None:
    mesh = SOURCES["plane"]
    problem = Problem.create(mesh, "plane", registry().distortions["symmetric-dirichlet"])
    laplacian = problem.workspace.laplacian
    laplacian.serve(problem.anchors)
    step = laplacian.direction(problem.gradient(mesh.vertices * [1.2, 0.9]))
    assert np.isfinite(step).all()
    assert np.abs(step).max() < 1.0
