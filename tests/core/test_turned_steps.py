"""Groups that turn take the map along a screw: exactly so where theory says how, and never into an inversion."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from tests.conftest import grid
from workbench.core.anchor_motion import LARGEST_TURN, next_displacement, twist_between
from workbench.core.arrays import Floats
from workbench.core.constraints import Anchors
from workbench.core.distortion import Distortion
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.samples import make_sample
from workbench.core.state import State
from workbench.core.turned_steps import moved_by_twists, turned_step

BAR = make_sample("bar-3d", triangles=200)
STRIP = Mesh(grid(8).vertices * [4.0, 1.0], grid(8).simplices)


def skew(v: Floats) -> Floats:
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def test_twists_move_points_as_the_exponential_of_their_matrix_does() -> None:
    rng = np.random.default_rng(0)
    points = rng.normal(size=(60, 3))
    twists = rng.normal(size=(60, 6))
    twists[:, :3] *= 10.0 ** np.repeat([0.0, -2.0, -4.0, -8.0, -30.0, -300.0], 10)[:, None]
    twists[::7, :3] = 0.0
    moved = moved_by_twists(points, twists)
    for point, twist, found in zip(points, twists, moved, strict=True):
        generator = np.zeros((4, 4))
        generator[:3, :3], generator[:3, 3] = skew(twist[:3]), twist[3:]
        assert np.allclose(found, (expm(generator) @ [*point, 1.0])[:3], rtol=0.0, atol=1e-13)
    flat = moved_by_twists(points[:, :2], np.tile([0.0, 0.0, np.pi / 2, 0.0, 0.0, 0.0], (60, 1)))
    assert np.allclose(flat, np.column_stack([-points[:, 1], points[:, 0]]), atol=1e-14)


@pytest.mark.parametrize("d", [2, 3])
@pytest.mark.parametrize("angle", [0.0, 1e-7, 0.3, 2.0])
def test_the_twist_between_two_places_of_a_body_carries_it_there(d: int, angle: float) -> None:
    rng = np.random.default_rng(d)
    body = rng.normal(size=(7, d)) + 5.0
    axis = np.array([0.0, 0.0, 1.0]) if d == 2 else np.array([0.6, 0.0, 0.8])
    turned = Rotation.from_rotvec(angle * axis).apply(np.pad(body, ((0, 0), (0, 3 - d))))[:, :d] + np.arange(1.0, d + 1.0)
    twist = twist_between(body, turned)
    assert np.allclose(moved_by_twists(body, np.tile(twist, (7, 1))), turned, atol=1e-12)
    assert np.linalg.norm(twist[:3]) == pytest.approx(angle, abs=1e-9)
    single = twist_between(body[:1], turned[:1])
    assert not single[:3].any() and np.allclose(single[3 : 3 + d], turned[0] - body[0])


def step_of(mesh: Mesh, turn: Rotation, about: Floats, start: Floats | None = None, distortion: str = "symmetric-dirichlet"):
    """One step of a bar whose left end is held and whose right end shall go far round; and the problem."""
    d = mesh.dimension
    length = mesh.vertices[:, 0].max()
    left, right = np.flatnonzero(mesh.vertices[:, 0] <= 0.0), np.flatnonzero(mesh.vertices[:, 0] >= length)
    targets = (turn.apply(np.pad(mesh.vertices[right], ((0, 0), (0, 3 - d))) - about) + about)[:, :d]
    anchors = Anchors(np.concatenate([left, right]), np.concatenate([mesh.vertices[left], targets]))
    problem = Problem.create(mesh, "plane" if d == 2 else "volume", Distortion.resolve(distortion), anchors)
    x = mesh.vertices if start is None else start
    energy, inverted = problem.energy_and_inverted(np.ascontiguousarray(x))
    state = State(np.ascontiguousarray(x), energy=energy, inverted=inverted, anchor_error=problem.anchor_error(x))
    groups = [np.arange(len(left)), len(left) + np.arange(len(right))]
    displacement = next_displacement(x[anchors.vertices], anchors.targets, groups)
    return turned_step(problem, state, displacement, groups), problem, displacement


def test_a_bar_is_turned_evenly_along_its_length() -> None:
    """Harmonic functions between the ends are linear, and all screws share the axis of the bar."""
    about = np.array([0.0, 0.5, 0.5])
    state, problem, displacement = step_of(BAR, Rotation.from_rotvec([2.0, 0.0, 0.0]), about)
    share = LARGEST_TURN * BAR.vertices[:, :1] / 4.0
    expected = Rotation.from_rotvec(share * [[1.0, 0.0, 0.0]]).apply(BAR.vertices - about) + about
    assert np.allclose(state.positions, expected, atol=1e-9)
    hard = problem.anchors.hard_vertices
    assert np.array_equal(state.positions[hard], BAR.vertices[hard] + displacement)
    assert state.inverted == 0 and state.energy == pytest.approx(problem.energy(state.positions), rel=1e-12)
    assert state.anchor_error == problem.anchor_error(state.positions)


def test_a_strip_in_the_plane_is_bent_to_an_arc() -> None:
    """Its end turns about a point below: each vertex turns about it by its share of the angle."""
    about = np.array([2.0, -1.0, 0.0])
    state, _, _ = step_of(STRIP, Rotation.from_rotvec([0.0, 0.0, -0.5]), about)
    share = -LARGEST_TURN * STRIP.vertices[:, 0] / 4.0
    c, s = np.cos(share), np.sin(share)
    x, y = (STRIP.vertices - about[:2]).T
    expected = np.column_stack([c * x - s * y, s * x + c * y]) + about[:2]
    assert np.allclose(state.positions, expected, atol=1e-9)


def test_a_small_turn_a_dear_one_and_an_inverted_map_are_left_to_others() -> None:
    about = np.array([0.0, 0.5, 0.5])
    assert step_of(BAR, Rotation.from_rotvec([0.1, 0.0, 0.0]), about)[0] is None
    assert step_of(BAR, Rotation.from_rotvec([0.0, 0.0, 2.0]), about + [4.0, 0.0, 0.0])[0] is not None
    far = np.array([4.0, 0.5, 40.0])  # a turn about a far axis tears the bar
    assert step_of(BAR, Rotation.from_rotvec([2.0, 0.0, 0.0]), far)[0] is None
    dented = BAR.vertices.copy()
    dented[np.flatnonzero(np.abs(dented - [2.0, 0.5, 0.5]).max(axis=1) < 1e-9)] += [2.0, 0.0, 0.0]
    assert step_of(BAR, Rotation.from_rotvec([2.0, 0.0, 0.0]), about, start=dented, distortion="arap")[0] is None
