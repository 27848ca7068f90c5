"""Anchors that go far away, or set out from rest: they arrive, whatever the distortion and the distance."""

from __future__ import annotations

import numpy as np
import pytest

from tests.conftest import grid, tetrahedral_grid
from workbench.core.carried_step import carried_step
from workbench.core.constraints import Anchors
from workbench.core.distortion import Distortion
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import run
from workbench.core.state import State
from workbench.core.status import Status

DISTORTION = Distortion.resolve("symmetric-dirichlet")


@pytest.mark.parametrize("diameters", [1e2, 1e4, 1e6])
@pytest.mark.parametrize("solid", [False, True], ids=["plane", "volume"])
def test_a_single_anchor_takes_the_map_along_however_far_it_goes(solid: bool, diameters: float) -> None:
    mesh = tetrahedral_grid(2) if solid else grid(4)
    target = mesh.vertices[:1] + diameters * mesh.diameter
    problem = Problem.create(mesh, "volume" if solid else "plane", DISTORTION, Anchors(np.array([0]), target))
    result = run(registry().solver("projected-newton")(), problem, mesh.vertices, iterations=20)
    assert result.state.status is Status.CONVERGED and result.state.anchor_error == 0.0
    isometry = 2.0 * mesh.dimension * problem.total_measure
    assert result.state.energy == pytest.approx(isometry, rel=1e-9)


def test_what_no_anchor_pulls_at_is_not_carried_along() -> None:
    one = grid(2)
    both = Mesh(
        np.concatenate([one.vertices, one.vertices + 3.0]), np.concatenate([one.simplices, one.simplices + one.vertex_count])
    )
    anchors = Anchors(np.array([0]), both.vertices[:1] + 1e3)
    problem = Problem.create(both, "plane", DISTORTION, anchors)
    state = carried_step(problem, registry().solver("projected-newton")().init(problem, both.vertices))
    assert state is not None and state.anchor_error == 0.0
    moved = state.positions - both.vertices
    assert np.allclose(moved[: one.vertex_count], 1e3) and not moved[one.vertex_count :].any()


def test_anchors_that_part_or_are_soft_are_left_to_the_linear_system() -> None:
    mesh = grid(2)
    apart = Anchors(np.array([0, 8]), mesh.vertices[[0, 8]] + [[-1e3, 0.0], [1e3, 0.0]])
    tied = Anchors(np.array([0, 8]), mesh.vertices[[0, 8]] + 1e3, np.array([np.inf, 1.0]))
    for anchors in (apart, tied):
        problem = Problem.create(mesh, "plane", DISTORTION, anchors)
        assert carried_step(problem, State(mesh.vertices, energy=problem.energy(mesh.vertices))) is None


@pytest.mark.parametrize("id", sorted(registry().distortions))
def test_the_ends_of_a_bar_at_rest_are_bent_whatever_is_minimised(id: str) -> None:
    """At rest some energies are 0 and have a kink besides: what a step may cost must not be measured by them alone."""
    bar = Mesh(grid(4).vertices * [4.0, 1.0], grid(4).simplices)
    x = bar.vertices[:, 0]
    left, right = np.flatnonzero(x == 0.0), np.flatnonzero(x == 4.0)
    turned = (bar.vertices[right] - [2.0, 0.5]) @ [[0.0, 1.0], [-1.0, 0.0]] + [2.0, 0.5]
    anchors = Anchors(np.append(left, right), np.vstack([bar.vertices[left], turned]))
    problem = Problem.create(bar, "plane", registry().distortions[id], anchors)
    result = run(registry().solver("projected-newton")(), problem, bar.vertices, iterations=60)
    assert result.state.anchor_error <= problem.anchor_tolerance and result.state.inverted == 0
