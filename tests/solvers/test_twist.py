"""A solid bar whose end is turned: it follows along a screw, no tetrahedron inverts on the way, and it winds up."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from workbench.core.anchor_motion import next_displacement
from workbench.core.arrays import Floats
from workbench.core.constraints import Anchors
from workbench.core.distortion import Distortion
from workbench.core.jacobians import determinants
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import RunResult, run
from workbench.core.samples import make_sample
from workbench.core.status import Status

BAR = make_sample("bar-3d", triangles=200)
LENGTH = 4.0
AXIS = np.array([0.0, 0.5, 0.5])


def turned_end(mesh: Mesh, degrees: float, stretch: float) -> Anchors:
    """Both ends held, the right one turned about the bar's axis and pulled away."""
    x = mesh.vertices[:, 0]
    left, right = np.flatnonzero(x <= 0.0), np.flatnonzero(x >= LENGTH)
    turn = Rotation.from_rotvec([np.radians(degrees), 0.0, 0.0])
    targets = turn.apply(mesh.vertices[right] - AXIS) * [stretch, 1.0, 1.0] + AXIS
    return Anchors(np.concatenate([left, right]), np.concatenate([mesh.vertices[left], targets]))


def twisted(start: Floats, anchors: Anchors, solver: str = "projected-newton") -> RunResult:
    """A run in which every single map is looked at."""
    problem = Problem.create(BAR, "volume", Distortion.resolve("symmetric-dirichlet"), anchors)
    smallest = []

    def look(state) -> None:
        smallest.append(determinants(problem.elements, state.positions).min())

    result = run(registry().solver(solver)(), problem, start, on_state=look)
    assert len(smallest) > 3 and min(smallest) > 0.0
    assert result.state.status is Status.CONVERGED
    assert result.state.anchor_error <= problem.anchor_tolerance
    return result


@pytest.mark.parametrize(("degrees", "stretch"), [(90, 1.2), (-90, 1.2), (179, 1.3), (180, 1.3), (-180, 1.3), (180, 0.6)])
def test_nothing_inverts_on_the_way(degrees: float, stretch: float) -> None:
    twisted(BAR.vertices, turned_end(BAR, degrees, stretch))


@pytest.mark.parametrize("id", ["l-bfgs", "slim", "newton-absolute", "sobolev-gradient-descent"])
def test_other_solvers_follow_as_well_and_end_no_lower(id: str) -> None:
    anchors = turned_end(BAR, 90, 1.2)
    reference = twisted(BAR.vertices, anchors).state.energy
    assert twisted(BAR.vertices, anchors, id).state.energy >= reference * (1.0 - 1e-6)


def test_there_and_back_is_nowhere() -> None:
    """After a quarter turn and back the source itself is the minimum again."""
    there = twisted(BAR.vertices, turned_end(BAR, 90, 1.0))
    back = twisted(there.state.positions, turned_end(BAR, 0, 1.0))
    assert np.abs(back.state.positions - BAR.vertices).max() < 1e-3
    assert there.state.energy > back.state.energy * 1.01


def test_a_whole_turn_winds_the_bar_up() -> None:
    """Three thirds of a turn end with the anchors where they began, and the bar is twisted once round."""
    x, energies = BAR.vertices, []
    for degrees in (120, 240, 360):
        state = twisted(x, turned_end(BAR, degrees, 1.0)).state
        x, _ = state.positions, energies.append(state.energy)
    ends = turned_end(BAR, 0, 1.0).hard_vertices
    assert np.abs(x[ends] - BAR.vertices[ends]).max() < 1e-8
    assert energies[0] < energies[1] < energies[2]
    middle = np.flatnonzero(np.abs(BAR.vertices[:, 0] - LENGTH / 2) < 1e-9)
    rest, now = BAR.vertices[middle] - AXIS, x[middle] - AXIS
    assert (rest[:, 1:] * now[:, 1:]).sum() < -0.5 * (rest[:, 1:] ** 2).sum()  # about half a turn in the middle


@pytest.mark.parametrize("noise", [-1e-12, 0.0, 1e-12])
@pytest.mark.parametrize("axis", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0], [-0.6, 0.0, 0.8]])
def test_half_a_turn_goes_the_same_way_round_whatever_the_rounding(axis: list[float], noise: float) -> None:
    body = np.random.default_rng(0).normal(size=(8, 3))

    def first_step(angle: float) -> Floats:
        return next_displacement(body, Rotation.from_rotvec(angle * np.array(axis)).apply(body), [np.arange(8)])

    assert np.allclose(first_step(np.pi + noise), first_step(np.pi), atol=1e-9)
    assert np.allclose(first_step(-np.pi), first_step(np.pi), atol=1e-9)
    assert not np.allclose(first_step(-3.0), first_step(3.0), atol=1e-2)  # elsewhere the shorter way


def test_a_twist_is_the_same_bit_for_bit_and_can_be_interrupted() -> None:
    anchors = turned_end(BAR, 180, 1.3)
    first, second = (twisted(BAR.vertices, anchors) for _ in range(2))
    assert np.array_equal(first.state.positions, second.state.positions)
    problem = Problem.create(BAR, "volume", Distortion.resolve("symmetric-dirichlet"), anchors)
    solver = registry().solver("projected-newton")()
    state = solver.step(problem, solver.init(problem, BAR.vertices))
    stopped = solver.step(problem, state, lambda: True)
    assert stopped.status is Status.INTERRUPTED and stopped.positions is state.positions


def test_few_factorisations_bring_a_turned_end_home() -> None:
    """The ends go round without one; what remains is a few Newton steps."""
    problem = Problem.create(BAR, "volume", Distortion.resolve("symmetric-dirichlet"), turned_end(BAR, 180, 1.3))
    arrived = []
    run(
        registry().solver("projected-newton")(), problem, BAR.vertices, on_state=lambda s: arrived.append(s.anchor_error < 1e-9)
    )
    assert arrived.index(True) >= 10  # eleven way points, none farther than `LARGEST_TURN`
    assert problem.workspace.all_counts()["factorise"] <= 8  # one of them of the Laplacian
