"""Convex matrices in the place of the Hessian: the order between them, and where two of them are the same."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from tests.solvers.test_laws import SOURCES, start_of
from workbench.core.complex_hessian import complex_hessian
from workbench.core.constraints import Anchors
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.solver import never

DISTORTIONS = sorted(registry().distortions)


def problem_and_map(kind: str, distortion: str) -> tuple[Problem, np.ndarray]:
    """A small problem with a soft anchor, and a map of it without inversions."""
    mesh = SOURCES[kind]
    soft = Anchors([3], np.full((1, mesh.dimension), 0.3), [2.0])
    return Problem.create(mesh, kind, registry().distortions[distortion], soft), start_of(mesh)  # type: ignore[arg-type]


def dense(problem: Problem, values: np.ndarray) -> np.ndarray:
    return problem.density.pattern.matrix(values).toarray()


def convex_hessian(id: str, problem: Problem, x: np.ndarray, **parameters: str) -> np.ndarray:
    """The matrix that a registered Newton solver factorises at the map x."""
    solver = registry().solvers[id](**parameters)  # type: ignore[call-arg]
    state = solver.init(problem, x)
    evaluation = problem.evaluate(x, solver.derivative_order)
    return dense(problem, solver.convex_hessian(problem, state, evaluation))


@pytest.mark.parametrize("distortion", DISTORTIONS)
@pytest.mark.parametrize("mirrored", [False, True])
def test_the_complex_view_projects_as_jacobians_do(distortion: str, mirrored: bool) -> None:
    problem, x = problem_and_map("parameterize", distortion)
    if mirrored:
        if problem.density.has_barrier:
            pytest.skip("infinite on inverted triangles")
        x = x * [1.0, -1.0]
    expected = problem.evaluate(x, 2).hessian_values
    assert expected is not None
    assert abs(complex_hessian(problem, x) - expected).max() <= 1e-12 * abs(expected).max()


@pytest.mark.parametrize("kind", sorted(SOURCES))
def test_absolute_eigenvalues_are_those_of_every_simplex(kind: str) -> None:
    """One simplex at a time: |H| from the eigenvalues of the Hessian on Jacobians, a numerical one."""
    problem, x = problem_and_map(kind, "symmetric-dirichlet")
    problem = problem.with_anchors(Anchors.none(problem.dimension))
    x = x * np.array([3.0, 0.4, 1.5])[: problem.dimension]  # far enough for negative eigenvalues
    elements, d = problem.elements, problem.dimension
    step = 1e-5
    expected = np.zeros((x.size, x.size))
    negative = 0
    for simplex, hats, weight in zip(elements.simplices, elements.hat_gradients, elements.rest_measures, strict=True):
        jacobian = x[simplex].T @ hats
        units = np.eye(d * d).reshape(-1, d, d)
        columns = [
            _density_gradient(problem, jacobian + step * u) - _density_gradient(problem, jacobian - step * u) for u in units
        ]
        block = np.array(columns) / (2 * step)
        eigenvalues, vectors = np.linalg.eigh(0.5 * (block + block.T))
        negative += int((eigenvalues < -1e-3).sum())
        absolute = vectors @ np.diag(abs(eigenvalues)) @ vectors.T
        # J_ab = sum_v x_va h_vb
        by_vertex = np.einsum("ac,vb->abvc", np.eye(d), hats).reshape(d * d, -1)
        rows = (simplex[:, None] * d + np.arange(d)).reshape(-1)
        expected[np.ix_(rows, rows)] += weight * by_vertex.T @ absolute @ by_vertex
    assert negative
    found = convex_hessian("newton-absolute", problem, x)
    assert abs(found - expected).max() <= 1e-6 * abs(expected).max()


def _density_gradient(problem: Problem, jacobian: np.ndarray) -> np.ndarray:
    """dD/dJ (96), flat."""
    u, sigma, vt = np.linalg.svd(jacobian)
    return ((u * problem.distortion.gradient(sigma[None])[0]) @ vt).reshape(-1)


@pytest.mark.parametrize("distortion", DISTORTIONS)
@pytest.mark.parametrize("kind", ["parameterize", "volume"])
def test_each_filter_lies_above_the_exact_hessian(distortion: str, kind: str) -> None:
    problem, x = problem_and_map(kind, distortion)
    evaluation = problem.evaluate(x, 2, project=False)
    assert evaluation.hessian_values is not None
    exact = dense(problem, evaluation.hessian_values)
    clamped = convex_hessian("projected-newton", problem, x)
    absolute = convex_hessian("newton-absolute", problem, x)
    ordered = [exact, clamped, absolute]
    if kind == "parameterize":
        separate = convex_hessian("composite-majorization", problem, x, factors="separate")
        assert _least_eigenvalue(separate - clamped) >= -1e-9
    for below, above in pairwise(ordered):
        assert _least_eigenvalue(above - below) >= -1e-9
    assert _least_eigenvalue(clamped) >= -1e-9


def _least_eigenvalue(matrix: np.ndarray) -> float:
    """In parts of the largest one in size; 0 for a matrix that vanishes."""
    eigenvalues = np.linalg.eigvalsh(matrix)
    return float(eigenvalues[0] / max(abs(eigenvalues).max(), 1e-300)) if abs(eigenvalues).max() > 1e-9 else 0.0


@pytest.mark.parametrize("id", ["newton-complex", "composite-majorization"])
def test_they_step_as_projected_newton_does(id: str) -> None:
    problem, x = problem_and_map("parameterize", "symmetric-dirichlet")
    ours, reference = (registry().solvers[name]() for name in (id, "projected-newton"))
    first, second = ours.init(problem, x), reference.init(problem, x)
    for _ in range(4):
        first, second = ours.step(problem, first, never), reference.step(problem, second, never)
    assert first.energy == pytest.approx(second.energy, rel=1e-12)
    assert first.step_size == second.step_size
