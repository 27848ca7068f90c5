"""The map's answer to anchors that move together: few shapes, whatever the number of anchors."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.conftest import grid, tetrahedral_grid
from workbench.core.anchor_response import MOST, SINGLE, AnchorResponse, displacement_shapes
from workbench.core.newton_system import NewtonSystem
from workbench.core.problem import Problem
from workbench.core.registry import registry


def turned(places: np.ndarray, rng: np.random.Generator) -> np.ndarray:
    """(k, d) after a rigid motion of any size."""
    d = places.shape[1]
    turn = Rotation.random(rng=rng) if d == 3 else Rotation.from_rotvec([0.0, 0.0, rng.uniform(-3.0, 3.0)])
    return turn.apply(np.pad(places, ((0, 0), (0, 3 - d))))[:, :d] + rng.normal(size=d)


def response(shapes: np.ndarray) -> AnchorResponse:
    return AnchorResponse(shapes, np.zeros((0, 0)))


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("is_plane", [False, True])
def test_the_shapes_of_one_rigid_motion_hold_every_other_one(d: int, is_plane: bool) -> None:
    rng = np.random.default_rng(d)
    places = rng.normal(size=(50, d))
    if is_plane:
        places[:20, 0] = 4.0  # a face of a solid, an edge of a figure
    group, still = np.arange(20), np.arange(20, 50)
    displacement = np.zeros_like(places)
    displacement[group] = turned(places[group], rng) - places[group]
    shapes = displacement_shapes(displacement, places, group, [group, still])
    assert shapes.shape == (50, d if is_plane else d + 1)
    np.testing.assert_allclose(shapes.T @ shapes, np.eye(shapes.shape[1]), atol=1e-12)
    now = places + displacement
    for _ in range(5):
        another = np.zeros_like(places)
        another[group] = turned(now[group], rng) - now[group]
        assert response(shapes).parts(another) is not None
        another[30] = 1.0
        assert response(shapes).parts(another) is None, "an anchor that stood still moves now"


def test_any_displacement_is_held_by_its_own_shapes_and_there_are_few_of_them() -> None:
    rng = np.random.default_rng(0)
    places = rng.normal(size=(60, 3))
    everywhere = rng.normal(size=(60, 3))
    for groups in ([np.arange(60)], np.split(np.arange(60), 12)):
        shapes = displacement_shapes(everywhere, places, np.arange(60), groups)
        assert shapes.shape[1] <= MOST
        assert response(shapes).parts(everywhere) is not None
    alone = np.zeros((60, 3))
    alone[7] = [0.1, 0.0, -1.0]
    shapes = displacement_shapes(alone, places, np.array([7]), [np.arange(60)])
    np.testing.assert_array_equal(shapes, np.eye(60)[:, [7]])


@pytest.mark.parametrize("mesh", [grid(5), tetrahedral_grid(3)], ids=["triangles", "tets"])
def test_the_kept_answer_is_that_of_a_solve(mesh) -> None:
    problem = Problem.create(mesh, "plane" if mesh.dimension == 2 else "volume", registry().distortions["symmetric-dirichlet"])
    rng = np.random.default_rng(0)
    x = mesh.vertices + 0.02 * rng.normal(size=mesh.vertices.shape)
    left, right = np.flatnonzero(x[:, 0] < 0.05), np.flatnonzero(x[:, 0] > 0.95)
    fixed = np.concatenate([left, right])
    group = np.arange(len(left), len(fixed))
    assert len(group) > SINGLE
    system = NewtonSystem(problem.density.pattern)
    system.factorise(problem.evaluate(x, 2).hessian_values, fixed)
    displacement = np.zeros((len(fixed), mesh.dimension))
    displacement[group] = turned(x[right], rng) - x[right]
    shapes = displacement_shapes(displacement, x[fixed], group, [group])
    kept = AnchorResponse(shapes, system.response(shapes))
    expected = system.solve(np.zeros_like(x), displacement)
    np.testing.assert_allclose(kept.to(displacement), expected, atol=1e-9 * np.abs(expected).max())
    assert kept.to(np.roll(displacement, 3, axis=0)) is None
