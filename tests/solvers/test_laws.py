"""What every registered solver does beside the laws of `workbench.core.solver_laws`: every distortion, constraints, limits."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from tests.conftest import grid, tetrahedral_grid
from workbench.core.constraints import Anchors, LinearConstraints
from workbench.core.jacobians import determinants
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import run
from workbench.core.status import Status

SOLVERS = sorted(registry().solvers)


def curved() -> Mesh:
    flat = grid(6)
    x, y = flat.vertices.T
    return Mesh(np.column_stack([x, y, 0.5 * np.sin(2 * x + 1) * np.cos(3 * y)]), flat.simplices)


SOURCES = {"plane": grid(6), "parameterize": curved(), "volume": tetrahedral_grid(2)}


def start_of(mesh: Mesh, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    n = mesh.dimension
    cells = round(mesh.vertex_count ** (1 / n)) - 1
    x = mesh.vertices[:, :n] + 0.15 / cells * rng.uniform(-1, 1, size=(mesh.vertex_count, n))
    return x @ np.array([[1.4, 0.3, 0.0], [-0.2, 0.8, 0.1], [0.0, 0.2, 1.1]])[:n, :n]


def anchors_of(mesh: Mesh, x: np.ndarray, reach: float) -> Anchors:
    held = np.array([0, mesh.vertex_count - 1])
    offset = reach * np.array([[-0.4, 0.2, 0.1], [0.3, 0.5, -0.2]])[:, : mesh.dimension]
    return Anchors(held, x[held] + offset)


def problem_of(kind: str, anchors: str, distortion: str = "symmetric-dirichlet") -> tuple[Problem, np.ndarray]:
    mesh = SOURCES[kind]
    x = start_of(mesh)
    chosen = {"none": None, "held": anchors_of(mesh, x, 0.0), "moved": anchors_of(mesh, x, 1.0)}[anchors]
    if anchors == "soft":
        raise AssertionError
    return Problem.create(mesh, kind, registry().distortions[distortion], chosen), x  # type: ignore[arg-type]


cases = pytest.mark.parametrize("anchors", ["none", "held", "moved"])
kinds = pytest.mark.parametrize("kind", sorted(SOURCES))
solvers = pytest.mark.parametrize("id", SOLVERS)


def distortion_of(id: str) -> str:
    """The distortion that the laws of a solver are tested with."""
    return ("symmetric-dirichlet", *registry().solvers[id].distortions)[-1]


def skip_unless_minimised(id: str, distortion: str) -> None:
    if distortion not in (registry().solvers[id].distortions or registry().distortions):
        pytest.skip(f"{id} does not minimise {distortion}")


def skip_unless_taken(id: str, kind: str) -> None:
    if kind not in registry().solvers[id].kinds:
        pytest.skip(f"{id} does not take {kind}")


@solvers
@kinds
@cases
def test_energy_never_rises_and_nothing_inverts(id: str, kind: str, anchors: str) -> None:
    skip_unless_taken(id, kind)
    problem, x = problem_of(kind, anchors, distortion_of(id))
    states = []
    result = run(registry().solvers[id](), problem, x, iterations=40, on_state=states.append)
    assert result.state.status in (Status.CONVERGED, Status.MAX_ITERATIONS), result.state.status
    for before, after in pairwise(states):
        assert (determinants(problem.elements, after.positions) > 0).all()
        if before.anchor_error <= problem.anchor_tolerance and registry().solvers[id].monotone:
            assert after.energy <= before.energy * (1 + 1e-14)
    assert result.state.anchor_error <= problem.anchor_tolerance
    assert result.state.energy == pytest.approx(problem.energy(result.state.positions), rel=1e-12)
    assert result.state.inverted == 0


@solvers
@kinds
def test_a_minimum_is_recognised_at_once(id: str, kind: str) -> None:
    skip_unless_taken(id, kind)
    mesh = SOURCES["plane" if kind == "parameterize" else kind]
    distortion = registry().distortions[distortion_of(id)]
    problem = Problem.create(mesh, "plane" if kind == "parameterize" else kind, distortion)  # type: ignore[arg-type]
    result = run(registry().solvers[id](), problem, mesh.vertices)
    assert result.state.status is Status.CONVERGED
    assert result.state.iteration <= 2
    least = distortion.value(np.ones((1, mesh.dimension)))[0]
    assert result.state.energy == pytest.approx(least, rel=1e-12, abs=1e-12)


@solvers
@kinds
@pytest.mark.parametrize("distortion", sorted(registry().distortions))
def test_every_distortion_goes_down_without_inversions(id: str, kind: str, distortion: str) -> None:
    skip_unless_taken(id, kind)
    skip_unless_minimised(id, distortion)
    problem, x = problem_of(kind, "held", distortion)
    result = run(registry().solvers[id](), problem, x, iterations=25)
    assert result.state.status in (Status.CONVERGED, Status.MAX_ITERATIONS), result.state.status
    assert result.state.energy < result.initial.energy
    assert (determinants(problem.elements, result.state.positions) > 0).all()


@solvers
@kinds
def test_soft_anchors_and_linear_constraints(id: str, kind: str) -> None:
    skip_unless_taken(id, kind)
    mesh = SOURCES[kind]
    x = start_of(mesh)
    d = mesh.dimension
    far = mesh.vertex_count - 1
    soft = Anchors([0, far], np.vstack([x[0], x[far] + 0.3]), [np.inf, 50.0])
    row = np.zeros((1, x.size))
    row[0, far * d] = 1.0
    row[0, (far - 1) * d] = -1.0
    constraints = LinearConstraints(row, np.array([0.1]))
    problem = Problem.create(mesh, kind, registry().distortions[distortion_of(id)], soft, constraints=constraints)  # type: ignore[arg-type]
    free = run(registry().solvers[id](), problem.with_anchors(Anchors([0], x[:1])), x, iterations=60).state
    pulled = run(registry().solvers[id](), problem, x, iterations=60).state
    for state in (free, pulled):
        assert abs(constraints.residual(state.positions)).max() < 1e-9
        assert (determinants(problem.elements, state.positions) > 0).all()
    target = soft.targets[1]
    assert np.linalg.norm(pulled.positions[far] - target) < np.linalg.norm(free.positions[far] - target)


@solvers
def test_limits_are_statuses(id: str) -> None:
    problem, x = problem_of("plane", "none", distortion_of(id))
    solver = registry().solvers[id]()
    assert run(solver, problem, x, iterations=0).state.status is Status.MAX_ITERATIONS
    assert run(solver, problem, x, time_limit=0.0).state.status is Status.TIME_LIMIT
    assert run(solver, problem, x, interrupt=lambda: True).state.status is Status.INTERRUPTED


def test_anchors_that_cannot_be_reached_stall_without_an_inversion() -> None:
    """Both ends of a grid dragged through each other: no map without inversions exists."""
    mesh = grid(4)
    left = np.flatnonzero(mesh.vertices[:, 0] == 0.0)
    right = np.flatnonzero(mesh.vertices[:, 0] == 1.0)
    boundary = np.concatenate([left, right])
    targets = mesh.vertices[boundary].copy()
    targets[len(left) :, 0] = -1.0
    problem = Problem.create(mesh, "plane", registry().distortions["symmetric-dirichlet"], Anchors(boundary, targets))
    result = run(registry().solver("projected-newton")(), problem, mesh.vertices, iterations=400)
    assert result.state.status in (Status.STALLED, Status.CONVERGED)
    assert (determinants(problem.elements, result.state.positions) > 0).all()


def test_a_bar_follows_its_end_round_a_half_turn() -> None:
    """Straight paths of the end's vertices would collapse it; along the screw it turns."""
    flat = grid(6)
    mesh = Mesh(flat.vertices * np.array([4.0, 1.0]), flat.simplices)
    left = np.flatnonzero(mesh.vertices[:, 0] == 0.0)
    right = np.flatnonzero(mesh.vertices[:, 0] == 4.0)
    held = np.concatenate([left, right])
    turned = np.array([3.0, 2.5]) - (mesh.vertices[right] - mesh.vertices[right].mean(axis=0))
    targets = np.vstack([mesh.vertices[left], turned])
    problem = Problem.create(mesh, "plane", registry().distortions["symmetric-dirichlet"], Anchors(held, targets))
    result = run(registry().solver("projected-newton")(), problem, mesh.vertices, iterations=400)
    assert result.state.status is Status.CONVERGED
    assert result.state.anchor_error <= problem.anchor_tolerance
    assert (determinants(problem.elements, result.state.positions) > 0).all()


@solvers
def test_a_map_that_must_collapse_comes_close_and_never_inverts(id: str) -> None:
    skip_unless_minimised(id, "average-singular-value")
    mesh = grid(6)
    held = np.flatnonzero((mesh.vertices[:, 0] == 0.0) | (mesh.vertices[:, 0] == 1.0))
    turned = np.where(mesh.vertices[held, :1] == 1.0, [2.0, 1.0] - mesh.vertices[held], mesh.vertices[held])
    distortion = registry().distortions["average-singular-value"]
    problem = Problem.create(mesh, "plane", distortion, Anchors(held, turned))
    result = run(registry().solver(id)(), problem, mesh.vertices, iterations=150)
    assert result.state.inverted == problem.inverted(result.state.positions) == 0
