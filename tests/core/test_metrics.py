"""The metrics of first-order methods, each by a law that the mathematics gives."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import optimize

from tests.conftest import grid, tetrahedral_grid
from tests.solvers.test_laws import start_of
from workbench.core.blocked_steps import unblocked_direction
from workbench.core.constraints import Anchors
from workbench.core.jacobians import determinants
from workbench.core.limited_memory import inner, make_pair, quasi_newton_direction
from workbench.core.line_search import largest_step
from workbench.core.metrics import OWN_MEAN, killing_energy, nearest_minimiser, reweighted_laplacian
from workbench.core.problem import Problem
from workbench.core.registry import registry

SOURCES = {"plane": grid(4), "volume": tetrahedral_grid(2)}
kinds = pytest.mark.parametrize("kind", sorted(SOURCES))


def problem_of(
    kind: str, distortion: str = "symmetric-dirichlet", anchors: Anchors | None = None
) -> tuple[Problem, np.ndarray]:
    mesh = SOURCES[kind]
    return Problem.create(mesh, kind, registry().distortions[distortion], anchors), start_of(mesh)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("distortion", "size"),
    [("symmetric-dirichlet", 1.0), ("arap", 1.0), ("dirichlet", 0.0), ("mips", OWN_MEAN), ("condition-number", OWN_MEAN)],
)
@pytest.mark.parametrize("n", [2, 3])
def test_the_nearest_minimiser_is_known(distortion: str, size: float, n: int) -> None:
    assert nearest_minimiser(registry().distortions[distortion], n) == size


@kinds
def test_the_reweighted_laplacian_of_dirichlet_energy_is_its_hessian(kind: str) -> None:
    anchors = Anchors([2, 5], np.zeros((2, SOURCES[kind].dimension)), [np.inf, 3.0])
    problem, x = problem_of(kind, "dirichlet", anchors)
    exact = problem.evaluate(x, 2).hessian_values
    assert reweighted_laplacian(problem, x) == pytest.approx(exact, abs=1e-12)


@kinds
def test_one_slim_step_of_arap_is_one_global_step(kind: str) -> None:
    """For (33) all weights are 2: the proxy sum w |J - R|^2 has its minimum where local-global goes."""
    problem, x = problem_of(kind, "arap")
    laplacian = problem.workspace.laplacian
    laplacian.serve(problem.anchors)
    dense = problem.density.pattern.matrix(reweighted_laplacian(problem, x))
    v = np.random.default_rng(0).normal(size=x.shape)
    assert dense @ v.reshape(-1) == pytest.approx(laplacian.multiply(v).reshape(-1), rel=1e-9, abs=1e-9)


@kinds
@pytest.mark.parametrize("distortion", sorted(registry().distortions))
def test_the_reweighted_laplacian_is_definite_up_to_translations(kind: str, distortion: str) -> None:
    problem, x = problem_of(kind, distortion)
    matrix = problem.density.pattern.matrix(reweighted_laplacian(problem, x)).toarray()
    eigenvalues = np.linalg.eigvalsh(matrix)
    d = problem.dimension
    assert np.isfinite(matrix).all()
    assert eigenvalues[0] > -1e-12 * eigenvalues[-1]
    assert eigenvalues[d] > 1e-9 * eigenvalues[-1]  # translations alone cost nothing


@kinds
def test_rigid_motions_cost_no_killing_energy(kind: str) -> None:
    problem, x = problem_of(kind)
    matrix = problem.density.pattern.matrix(killing_energy(problem, x))
    d = problem.dimension
    turn = np.random.default_rng(0).normal(size=(d, d))
    motion = x @ (turn - turn.T) + np.arange(1.0, d + 1.0)
    scale = abs(matrix).max() * abs(motion).max()
    assert abs(matrix @ motion.reshape(-1)).max() < 1e-12 * scale
    stretch = x @ (turn + turn.T)
    assert stretch.reshape(-1) @ (matrix @ stretch.reshape(-1)) > 0.1 * problem.total_measure


@kinds
def test_at_an_isometry_the_killing_energy_is_the_hessian_of_symmetric_dirichlet(kind: str) -> None:
    problem, _ = problem_of(kind)
    rest = problem.mesh.vertices[:, : problem.dimension]
    exact = problem.evaluate(rest, 2, project=False).hessian_values
    assert killing_energy(problem, rest) == pytest.approx(exact, abs=1e-9)


@kinds
def test_the_filter_finds_the_nearest_unblocked_direction(kind: str) -> None:
    """Against a general solver of the same problem: least |p - d| with a + C p >= 0."""
    mesh = grid(2) if kind == "plane" else tetrahedral_grid(1)
    problem = Problem.create(mesh, kind, registry().distortions["symmetric-dirichlet"], Anchors([0], mesh.vertices[:1]))  # type: ignore[arg-type]
    x = mesh.vertices
    wish = 0.9 * np.random.default_rng(3).normal(size=x.shape)
    wish[0] = 0.0
    found = unblocked_direction(problem, x, wish, 20_000)
    step = 1e-6
    content = determinants(problem.elements, x)
    rows = np.empty((len(content), x.size))
    for i in range(x.size):
        unit = np.zeros(x.size)
        unit[i] = step
        moved = determinants(problem.elements, x + unit.reshape(x.shape))
        back = determinants(problem.elements, x - unit.reshape(x.shape))
        rows[:, i] = (moved - back) / (2 * step)
    rows[:, : x.shape[1]] = 0.0
    assert (content + rows @ wish.reshape(-1) < 0).any()
    reference = optimize.minimize(
        lambda p: 0.5 * ((p - wish.reshape(-1)) ** 2).sum(),
        np.zeros(x.size),
        jac=lambda p: p - wish.reshape(-1),
        constraints={"type": "ineq", "fun": lambda p: content + rows @ p, "jac": lambda p: rows},
        method="SLSQP",
        options={"maxiter": 500, "ftol": 1e-14},
    )
    assert reference.success
    assert found.reshape(-1) == pytest.approx(reference.x, abs=2e-4)
    assert (found[0] == 0).all()
    gentle = 1e-3 * wish
    assert unblocked_direction(problem, x, gentle, 20) is gentle


def test_a_quasi_newton_direction_fits_the_newest_step() -> None:
    """The secant equation: the learnt inverse takes y to s."""
    rng = np.random.default_rng(0)
    pairs = []
    while len(pairs) < 4:
        step = rng.normal(size=(6, 2))
        pair = make_pair(step, step + 0.5 * rng.normal(size=(6, 2)))
        if pair is not None:
            pairs.append(pair)
    newest = pairs[-1]
    direction = quasi_newton_direction(newest.difference, tuple(pairs), lambda g: 0.3 * g)
    assert direction == pytest.approx(-newest.step, abs=1e-12)
    other = rng.normal(size=(6, 2))
    assert inner(other, quasi_newton_direction(other, tuple(pairs), lambda g: 0.3 * g)) < 0.0


def test_a_step_against_its_curvature_is_not_remembered() -> None:
    step = np.ones((3, 2))
    assert make_pair(step, -step) is None
    assert make_pair(step, np.zeros((3, 2))) is None


@kinds
def test_blocks_hold_every_vertex_once_and_share_no_simplex(kind: str) -> None:
    problem, x = problem_of(kind)
    blocks = problem.workspace.vertex_blocks
    assert sorted(np.concatenate([b.vertices for b in blocks])) == list(range(problem.mesh.vertex_count))
    for block in blocks:
        assert len(np.unique(block.simplices)) == len(block.simplices)
        whole = problem.density.gradient(x).gradient[block.vertices]
        assert block.gradients(problem.density, x) == pytest.approx(whole, rel=1e-12, abs=1e-12)
    every = sum(float(b.energies(problem.density, x, strict=True).sum()) for b in blocks)
    assert every == pytest.approx((problem.dimension + 1) * problem.energy(x), rel=1e-12)


@kinds
def test_a_vertex_alone_goes_as_far_as_the_step_bound_says(kind: str) -> None:
    problem, x = problem_of(kind)
    block = problem.workspace.vertex_blocks[0]
    direction = np.random.default_rng(1).normal(size=(len(block.vertices), problem.dimension))
    steps = block.largest_steps(x, direction)
    for place, vertex in enumerate(block.vertices):
        alone = np.zeros_like(x)
        alone[vertex] = direction[place]
        assert steps[place] == pytest.approx(largest_step(x, alone, problem.elements.simplices)[0], rel=1e-9)
