"""SLIM step by step beside libigl's."""

from __future__ import annotations

import pytest

from tests.libigl_reference import slim_solver
from tests.solvers.test_against_libigl import mesh_of
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import run
from workbench.engine.starts import make_start


@pytest.mark.parametrize("name", ["bumpy-disc", "gingerbread", "BFF/hemisphere.obj"])
def test_ten_steps_are_those_of_libigl(name: str, request: pytest.FixtureRequest) -> None:
    """From starts that are not almost collapsed; there rounding decides which way libigl goes."""
    mesh = mesh_of(name, request)
    start = make_start(mesh, "parameterize", "tutte")
    problem = Problem.create(mesh, "parameterize", registry().distortions["symmetric-dirichlet"])
    ours = run(registry().solver("slim")(), problem, start, iterations=10, tolerance=0.0)
    slim = slim_solver(mesh, start)
    assert len(ours.rows) == 11
    for row in ours.rows[1:]:
        assert row.energy == pytest.approx(problem.energy(slim(1)), rel=1e-6), row.iteration
