"""Energies of solids: turning costs nothing, and the projected Hessian of a tetrahedron is the nearest one by its Jacobian."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.conftest import tetrahedral_grid
from workbench.core.arrays import Floats
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import run
from workbench.core.samples import make_sample
from workbench.core.threads import set_thread_count, thread_count

CUBE = tetrahedral_grid(2)
CORNER = Mesh(np.vstack([np.zeros(3), np.eye(3)]), np.array([[0, 1, 2, 3]]))
"""The rest edges are the unit vectors: the last three vertices are the columns of the Jacobian."""
SMOOTH = sorted(
    id
    for id, distortion in registry().distortions.items()
    if not Problem.create(CORNER, "volume", distortion).density.has_kinks
)
"""A projected Hessian bounds kinks from above: that is another law."""
NORMALISED = ("symmetric-dirichlet", "arap", "amips-smooth", "mips")


def jacobian_hessian(problem: Problem, J: Floats, *, project: bool) -> Floats:
    """(9, 9) second derivatives by the Jacobian of the single tetrahedron, over its volume."""
    x = np.vstack([np.zeros(3), J.T])
    hessian: Floats = problem.hessian(x, project=project).toarray()[3:, 3:] * 6.0
    return hessian


def matrices() -> dict[str, Floats]:
    """Jacobians of every kind: ties in all places, thin, large and small, inverted."""
    left, right = Rotation.random(2, np.random.default_rng(4)).as_matrix()
    values = {
        "generic": [1.7, 1.1, 0.6],
        "stretched": [3.0, 2.0, 0.2],
        "shrunk": [0.3, 0.2, 0.1],
        "first two equal": [1.8, 1.8, 0.7],
        "last two equal": [1.8, 0.7, 0.7],
        "all equal": [1.4, 1.4, 1.4],
        "nearly equal": [1.4, 1.4 - 1e-9, 1.4 - 3e-9],
        "isometry": [1.0, 1.0, 1.0],
        "thin": [2.0, 1.0, 1e-3],
        "needle": [5.0, 0.1, 0.1],
        "inverted": [1.7, 1.1, -0.6],
    }
    return {name: (left * np.array(v)) @ right.T for name, v in values.items()}


@pytest.mark.parametrize("name", matrices())
@pytest.mark.parametrize("id", SMOOTH)
def test_projection_is_the_nearest_semi_definite_matrix(id: str, name: str) -> None:
    problem = Problem.create(CORNER, "volume", registry().distortions[id], allow_inversions=True)
    J = matrices()[name]
    if problem.density.meets_barrier(np.vstack([np.zeros(3), J.T])):
        return
    exact, projected = (jacobian_hessian(problem, J, project=project) for project in (False, True))
    values, vectors = np.linalg.eigh(exact)
    nearest = (vectors * np.maximum(values, 0.0)) @ vectors.T
    size = np.abs(values).max()
    assert np.abs(exact - exact.T).max() <= 1e-14 * size
    assert np.abs(projected - nearest).max() <= (1e-6 if name == "nearly equal" else 1e-11) * size


@pytest.mark.parametrize("degrees", [0.0, 30.0, 90.0, 180.0, 270.0, 360.0])
@pytest.mark.parametrize("id", NORMALISED)
def test_a_turned_solid_is_a_minimum(id: str, degrees: float) -> None:
    problem = Problem.create(CUBE, "volume", registry().distortions[id])
    turn = Rotation.from_rotvec(np.radians(degrees) * np.array([0.6, -0.64, 0.48]))
    x = CUBE.vertices @ turn.as_matrix().T + [3.0, -2.0, 1.0]
    assert np.abs(problem.gradient(x)).max() < 1e-12
    if id == "symmetric-dirichlet":
        assert problem.energy(x) == pytest.approx(6.0 * problem.total_measure, rel=1e-13)
    exact = problem.hessian(x, project=False).toarray()
    values = np.linalg.eigvalsh(exact)
    flat = 7 if id == "mips" else 6  # translations and rotations, for mips uniform scaling too
    assert np.abs(values[:flat]).max() < 1e-9 * values[-1]
    assert values[flat] > 1e-4 * values[-1]
    assert np.abs(problem.hessian(x).toarray() - exact).max() < 1e-9 * values[-1]  # nothing there to project


@pytest.mark.parametrize("degrees", [0.0, 180.0])
def test_a_dented_solid_springs_back_to_a_turned_one(degrees: float) -> None:
    """Without anchors, from a turned and dented cube: six a unit volume, every edge as long as at rest."""
    problem = Problem.create(CUBE, "volume", registry().distortions["symmetric-dirichlet"])
    dented = CUBE.vertices + 0.08 * np.random.default_rng(0).uniform(-1.0, 1.0, CUBE.vertices.shape)
    start = Rotation.from_rotvec([0.0, np.radians(degrees), 0.0]).apply(dented)
    state = run(registry().solver("projected-newton")(), problem, start, tolerance=1e-14).state
    assert state.energy == pytest.approx(6.0, rel=1e-10)
    for a, b in ((0, 1), (0, 26), (13, 5)):
        assert np.linalg.norm(state.positions[a] - state.positions[b]) == pytest.approx(
            np.linalg.norm(CUBE.vertices[a] - CUBE.vertices[b]), abs=1e-4
        )


def test_threads_share_a_solid_in_a_fixed_way() -> None:
    mesh = make_sample("bar-3d", triangles=9000)
    problem = Problem.create(mesh, "volume", registry().distortions["symmetric-dirichlet"])
    x = mesh.vertices @ np.array([[1.2, 0.3, 0.0], [0.0, 0.8, 0.1], [0.2, 0.0, 1.1]])
    x += 0.005 * np.random.default_rng(0).normal(size=x.shape)
    kept = thread_count()
    found = {}
    try:
        for count in (1, 2):
            set_thread_count(count)
            first, second = problem.evaluate(x, 2), problem.evaluate(x, 2)
            assert np.array_equal(first.gradient, second.gradient)
            assert np.array_equal(first.hessian_values, second.hessian_values)
            found[count] = first
    finally:
        set_thread_count(kept)
    assert found[1].energy == pytest.approx(found[2].energy, rel=1e-13)
    assert np.allclose(found[1].gradient, found[2].gradient, rtol=0.0, atol=1e-12 * np.abs(found[1].gradient).max())
    assert problem.energy(x) == pytest.approx(found[1].energy, rel=1e-13)  # the kernel of values alone says the same
