"""The same optimum as libigl's SLIM run long enough."""

from __future__ import annotations

import numpy as np
import pytest

from tests.benchmarks.tetrahedra import bar, problem_of, turned_evenly
from tests.libigl_reference import slim_solver
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import run
from workbench.core.samples import make_sample
from workbench.engine.starts import make_start

MESHES = ("bumpy-disc", "fingers", "BFF/hemisphere.obj", "OptCuts/bunny_decim_noInputUV.obj", "OptCuts/hencky_f20000.obj")


def mesh_of(name: str, request: pytest.FixtureRequest) -> Mesh:
    if "/" not in name:
        return make_sample(name, triangles=2000)
    from workbench.io.read import read_mesh

    return read_mesh(str(request.getfixturevalue("data_folder") / name)).mesh


@pytest.mark.parametrize("name", MESHES[:4])
def test_the_optimum_is_that_of_slim(name: str, request: pytest.FixtureRequest) -> None:
    mesh = mesh_of(name, request)
    start = make_start(mesh, "parameterize", "tutte")
    problem = Problem.create(mesh, "parameterize", registry().distortions["symmetric-dirichlet"])
    ours = run(registry().solver("projected-newton")(), problem, start, tolerance=1e-10).state
    slim = slim_solver(mesh, start)
    energy, before = np.inf, np.inf
    for _ in range(40):
        before, energy = energy, problem.energy(slim(25))
        if before - energy <= 1e-8 * energy:
            break
    assert ours.inverted == 0
    # SLIM comes from above: ours is never worse, and the two agree once SLIM has come to rest.
    assert ours.energy <= energy * (1 + 1e-9)
    assert ours.energy == pytest.approx(energy, rel=1e-4)


@pytest.mark.parametrize(("degrees", "stretch"), [(90.0, 1.2), (180.0, 1.3)])
def test_a_turned_solid_is_no_higher_than_slim_takes_it(degrees: float, stretch: float) -> None:
    """SLIM starts with the bar turned evenly, ours at rest with the anchors to be dragged."""
    mesh = bar(2)
    target = turned_evenly(mesh, degrees, stretch)
    problem = problem_of(mesh, target)
    ours = run(registry().solver("projected-newton")(), problem, mesh.vertices, tolerance=1e-10).state
    slim = slim_solver(mesh, target, problem.anchors)
    positions = slim(60)
    assert problem.anchor_error(positions) < 1e-5  # soft, but stiff
    assert ours.inverted == 0 and not problem.anchors_lag(ours.positions)
    assert ours.energy <= problem.energy(positions) * (1 + 1e-6)
    assert ours.energy == pytest.approx(problem.energy(positions), rel=1e-4)
