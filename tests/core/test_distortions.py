"""Laws over every registered distortion, and derivatives of the energy by finite differences."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import special_ortho_group

from tests.conftest import grid, tetrahedral_grid
from workbench.core.distortion import Distortion
from workbench.core.jacobians import determinants, jacobians, signed_singular_values
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.registry import registry

IDS = sorted(registry().distortions)
EXTREMES = {
    "blend", "condition-number", "exp-blend", "qc-dilatation", "qc-inner", "qc-outer", "quasi-isometric", "spectral",
    "symmetric-arap",
}  # fmt: skip
KINKED_AT_TIES = {2: EXTREMES, 3: EXTREMES | {"ky-fan"}}
"""Of n: where sigma_i = sigma_j those are not smooth in the map."""


def surface() -> Mesh:
    flat = grid(3)
    x, y = flat.vertices.T
    return Mesh(np.column_stack([x, y, 0.4 * np.sin(3 * x) * np.cos(2 * y)]), flat.simplices)


SOURCES = {"plane": grid(3), "parameterize": surface(), "volume": tetrahedral_grid(1)}


def generic_map(mesh: Mesh, seed: int = 0, amount: float = 0.03) -> np.ndarray:
    """An inversion-free map with no equal singular values."""
    rng = np.random.default_rng(seed)
    n = mesh.dimension
    linear = np.diag([1.7, 0.8, 1.2][:n]) + 0.1 * rng.normal(size=(n, n))
    return mesh.vertices[:, :n] @ linear.T + amount * rng.normal(size=(mesh.vertex_count, n))


def directional(function, x: np.ndarray, d: np.ndarray, h: float):
    """Fourth-order central difference of `function` along d."""
    return (8 * (function(x + h * d) - function(x - h * d)) - (function(x + 2 * h * d) - function(x - 2 * h * d))) / (12 * h)


@pytest.mark.parametrize("kind", SOURCES)
@pytest.mark.parametrize("id", IDS)
def test_gradient_and_hessian_by_directional_differences(id: str, kind: str) -> None:
    mesh = SOURCES[kind]
    problem = Problem.create(mesh, kind, registry().distortions[id])  # type: ignore[arg-type]
    x = generic_map(mesh)
    direction = np.random.default_rng(1).normal(size=x.shape)
    gradient = problem.gradient(x)
    hessian = problem.hessian(x, project=False)
    best = [
        abs(directional(problem.energy, x, direction, h) / np.sum(gradient * direction) - 1)
        for h in (2e-3, 1e-3, 4e-4, 2e-4, 1e-4)
    ]
    assert min(best) < 1e-8
    exact = (hessian @ direction.ravel()).reshape(x.shape)
    best = [
        np.linalg.norm(directional(problem.gradient, x, direction, h) - exact) / np.linalg.norm(exact)
        for h in (2e-3, 1e-3, 4e-4, 2e-4, 1e-4)
    ]
    assert min(best) < 1e-8


@pytest.mark.parametrize("kind", SOURCES)
@pytest.mark.parametrize("id", IDS)
def test_the_projected_hessian_is_positive_semi_definite(id: str, kind: str) -> None:
    mesh = SOURCES[kind]
    problem = Problem.create(mesh, kind, registry().distortions[id])  # type: ignore[arg-type]
    for x in (generic_map(mesh), generic_map(mesh, 3) * 0.3, 4.0 * generic_map(mesh, 4)):
        matrix = problem.hessian(x).toarray()
        assert np.array_equal(matrix, matrix.T)
        values = np.linalg.eigvalsh(matrix)
        assert values[0] >= -1e-12 * max(values[-1], 1.0)


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("id", IDS)
def test_rotations_on_either_side_change_nothing(id: str, n: int) -> None:
    mesh = SOURCES["plane" if n == 2 else "volume"]
    kind = "plane" if n == 2 else "volume"
    x = generic_map(mesh)
    energy = Problem.create(mesh, kind, registry().distortions[id]).energy(x)
    left, right = special_ortho_group.rvs(n, size=2, random_state=5)
    turned = Mesh(mesh.vertices @ right.T, mesh.simplices)
    other = Problem.create(turned, kind, registry().distortions[id]).energy(x @ left.T + 3.0)
    assert other == pytest.approx(energy, rel=1e-11)


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("id", IDS)
def test_derivatives_by_sigma_at_extreme_values(id: str, n: int) -> None:
    distortion = registry().distortions[id]
    distortion = distortion.tempered(n) or distortion  # exponentials overflow there
    direction = np.array([0.3, -0.8, 0.45][:n])
    for scale in (1e-3, 1.0, 1e3):
        for shape in ([1.9, 1.1, 0.6], [1e3, 1.1, 2e-3]):  # det = 1 would be a switch of max
            sigma = scale * np.array([shape[: n - 1] + shape[-1:]])
            along = sigma[0] * direction
            size = abs(float(distortion.value(sigma)[0]))
            slope = float(distortion.gradient(sigma)[0] @ along)
            steps = (3e-3, 1e-3, 3e-4)
            rates = [directional(lambda s: float(distortion.value(s)[0]), sigma, along, h) for h in steps]
            assert min(abs(rate - slope) for rate in rates) <= 1e-8 * max(abs(slope), 1e-3 * size)
            change = distortion.hessian(sigma)[0] @ along
            rows = [directional(lambda s: distortion.gradient(s)[0], sigma, along, h) for h in steps]
            # each row in units of its own singular value, or a needle would hide what is wrong across it
            error = min(np.abs((row - change) * sigma[0]).max() for row in rows)
            assert error <= 1e-8 * max(np.abs(change * sigma[0]).max(), 1e-3 * size)


@pytest.mark.parametrize("n", [2, 3])
@pytest.mark.parametrize("id", IDS)
def test_kinks_at_ties_are_known_and_met_by_the_mean_of_both_sides(id: str, n: int) -> None:
    distortion = registry().distortions[id]
    assert distortion.compiled(n).is_kinked_at_ties == (id in KINKED_AT_TIES[n])
    kind = "plane" if n == 2 else "volume"
    mesh = SOURCES[kind]
    problem = Problem.create(mesh, kind, distortion)  # type: ignore[arg-type]
    x = 1.3 * mesh.vertices  # all singular values equal: what is left of D_i is their mean, so the gradient has no shear
    first = float(distortion.gradient(np.full((1, n), 1.3)).mean())
    dilation = Problem.create(mesh, kind, Distortion.from_formula("sum(sigma)")).gradient(mesh.vertices)  # type: ignore[arg-type]
    assert np.allclose(problem.gradient(x), first * dilation, rtol=1e-9, atol=1e-9 * (abs(first) + 1.0))


@pytest.mark.parametrize("kind", ["plane", "volume"])
@pytest.mark.parametrize("id", IDS)
def test_hessian_where_all_singular_values_are_equal(id: str, kind: str) -> None:
    mesh = SOURCES[kind]
    n = mesh.dimension
    if id in KINKED_AT_TIES[n]:
        pytest.skip("not smooth there, see the law of kinks")
    problem = Problem.create(mesh, kind, registry().distortions[id])  # type: ignore[arg-type]
    x = 1.3 * mesh.vertices
    direction = np.random.default_rng(2).normal(size=x.shape)
    exact = (problem.hessian(x, project=False) @ direction.ravel()).reshape(x.shape)
    best = [
        np.linalg.norm(directional(problem.gradient, x, direction, h) - exact) / np.linalg.norm(exact)
        for h in (3e-3, 1e-3, 3e-4, 1e-4)
    ]
    assert min(best) < 1e-7


@pytest.mark.parametrize("kind", ["plane", "volume"])
@pytest.mark.parametrize("id", sorted(KINKED_AT_TIES[2]))
def test_across_a_kink_the_projected_hessian_bounds_the_energy_from_above(id: str, kind: str) -> None:
    """A parabola with the projected Hessian lies above the energy along a way that crosses a tie."""
    mesh = SOURCES[kind]
    n = mesh.dimension
    problem = Problem.create(mesh, kind, registry().distortions[id])  # type: ignore[arg-type]
    stretched = np.diag([1.32, 1.3, 1.28][:n])
    x, beyond = mesh.vertices @ stretched, mesh.vertices @ stretched[::-1, ::-1]
    across = beyond - x
    slope = float(np.sum(problem.gradient(x) * across))
    curvature = float(across.ravel() @ (problem.hessian(x) @ across.ravel()))
    for t in (0.25, 0.5, 0.75, 1.0):
        bound = problem.energy(x) + t * slope + 0.5 * t * t * curvature
        assert problem.energy(x + t * across) <= bound + 1e-3 * abs(t * slope)


@pytest.mark.parametrize("kind", ["plane", "volume"])
def test_switches_of_max_are_met_by_the_mean_of_both_sides(kind: str) -> None:
    mesh = SOURCES[kind]
    volume = Problem.create(mesh, kind, registry().distortions["volume"])  # type: ignore[arg-type]
    assert np.abs(volume.gradient(mesh.vertices)).max() < 1e-9  # det = 1/det = 1 at the identity
    for scale, sign in ((1.01, 1.0), (0.99, -1.0)):
        gradient = volume.gradient(scale * mesh.vertices)
        assert np.sign(np.sum(gradient * mesh.vertices)) == sign


@pytest.mark.parametrize("id", IDS)
@pytest.mark.parametrize("kind", ["plane", "volume"])
def test_a_barrier_is_infinite_on_inversions_and_nothing_else_is(id: str, kind: str) -> None:
    mesh = SOURCES[kind]
    distortion = registry().distortions[id]
    problem = Problem.create(mesh, kind, distortion, allow_inversions=True)  # type: ignore[arg-type]
    mirrored = mesh.vertices * np.array([-1.0, 1.0, 1.0][: mesh.dimension])
    energy, inverted = problem.energy_and_inverted(mirrored)
    assert inverted >= 1
    assert np.isinf(energy) == distortion.has_barrier(mesh.dimension)


@pytest.mark.parametrize("kind", ["plane", "volume"])
@pytest.mark.parametrize("id", ["dirichlet", "arap"])
def test_derivatives_on_inverted_simplices_of_an_unsigned_distortion(id: str, kind: str) -> None:
    mesh = SOURCES[kind]
    problem = Problem.create(mesh, kind, registry().distortions[id], allow_inversions=True)  # type: ignore[arg-type]
    x = generic_map(mesh) * np.array([-1.0, 1.0, 1.0][: mesh.dimension])
    direction = np.random.default_rng(1).normal(size=x.shape)
    slope = float(np.sum(problem.gradient(x) * direction))
    assert min(abs(directional(problem.energy, x, direction, h) / slope - 1) for h in (1e-3, 3e-4, 1e-4)) < 1e-8
    exact = (problem.hessian(x, project=False) @ direction.ravel()).reshape(x.shape)
    best = [
        np.linalg.norm(directional(problem.gradient, x, direction, h) - exact) / np.linalg.norm(exact) for h in (1e-3, 3e-4)
    ]
    assert min(best) < 1e-8


def test_singular_values_agree_with_lapack_and_carry_the_sign() -> None:
    rng = np.random.default_rng(0)
    for kind in ("plane", "volume"):
        mesh = SOURCES[kind]
        problem = Problem.create(mesh, kind, registry().distortions["dirichlet"])  # type: ignore[arg-type]
        x = rng.normal(size=mesh.vertices.shape)
        sigma = signed_singular_values(problem.elements, x)
        dense = jacobians(problem.elements, x)
        assert np.allclose(np.abs(sigma), np.linalg.svd(dense, compute_uv=False), rtol=1e-10, atol=1e-12)
        assert np.allclose(np.prod(sigma, axis=1), np.linalg.det(dense), rtol=1e-9, atol=1e-12)
        assert np.array_equal(sigma[:, -1] > 0, determinants(problem.elements, x) > 0)


def test_determinant_of_an_affine_map_is_exact_and_weights_sum_to_the_measure() -> None:
    for kind in ("plane", "volume"):
        mesh = SOURCES[kind]
        problem = Problem.create(mesh, kind, registry().distortions["dirichlet"])  # type: ignore[arg-type]
        linear = np.array([[2.0, 0.5, 0.0], [0.0, 4.0, 0.25], [0.0, 0.0, 0.5]])[: mesh.dimension, : mesh.dimension]
        assert np.allclose(determinants(problem.elements, mesh.vertices @ linear.T), np.linalg.det(linear), rtol=1e-12)
        assert problem.total_measure == pytest.approx(1.0, rel=1e-14)
        identity = Problem.create(mesh, kind, registry().distortions["symmetric-dirichlet"])  # type: ignore[arg-type]
        assert identity.energy(mesh.vertices) == pytest.approx(2.0 * mesh.dimension, rel=1e-13)


def test_thread_counts_change_nothing_but_rounding() -> None:
    from workbench.core.threads import set_thread_count, thread_count

    mesh = grid(80)
    problem = Problem.create(mesh, "plane", registry().distortions["symmetric-dirichlet"])
    x = generic_map(mesh, amount=0.001)
    before = thread_count()
    try:
        set_thread_count(1)
        one, again = problem.evaluate(x, 2), problem.evaluate(x, 2)
        set_thread_count(2)
        two = problem.evaluate(x, 2)
    finally:
        set_thread_count(before)
    assert one.energy == again.energy
    assert np.array_equal(one.hessian_values, again.hessian_values)
    assert two.energy == pytest.approx(one.energy, rel=1e-13)
    assert np.allclose(two.hessian_values, one.hessian_values, rtol=1e-12, atol=1e-12)


def test_parameters_are_checked() -> None:
    from workbench.core.errors import WorkbenchError

    with pytest.raises(WorkbenchError, match="no parameter"):
        Distortion.resolve("symmetric-dirichlet", {"alpha": 1.0})
    with pytest.raises(WorkbenchError):
        Distortion.resolve("lam*sum(sigma)", {"lam": "much"})
