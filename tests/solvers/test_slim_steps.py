"""SLIM step by step beside libigl's."""

from __future__ import annotations

import numpy as np
import pytest

from tests.conftest import tetrahedral_grid
from tests.libigl_reference import slim_solver
from tests.solvers.test_against_libigl import mesh_of
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import run
from workbench.engine.starts import make_start


@pytest.mark.parametrize("name", ["bumpy-disc", "gingerbread", "BFF/hemisphere.obj"])
def test_ten_steps_are_those_of_libigl(name: str, request: pytest.FixtureRequest) -> None:
    """From starts that are not almost collapsed; there rounding decides which way libigl goes."""
    mesh = mesh_of(name, request)
    compare(mesh, "parameterize", make_start(mesh, "parameterize", "tutte"), 1e-4)


def test_ten_steps_are_those_of_libigl_in_space() -> None:
    """There libigl's proximal term does not follow the mesh's scale: it is given in our measure."""
    mesh = tetrahedral_grid(3)
    start = mesh.vertices @ np.array([[1.4, 0.3, 0.0], [-0.2, 0.8, 0.1], [0.0, 0.2, 1.1]])
    start += 0.05 * np.sin(7.0 * start[:, [1, 2, 0]])
    edge = (1.0 / mesh.simplex_count) ** (1.0 / 3.0)
    compare(mesh, "volume", start, 1e-4 / edge)


def compare(mesh: Mesh, kind: str, start: np.ndarray, proximal: float) -> None:
    """Ten energies of both, to 1e-6."""
    problem = Problem.create(mesh, kind, registry().distortions["symmetric-dirichlet"])  # type: ignore[arg-type]
    ours = run(registry().solver("slim")(proximal=proximal), problem, start, iterations=10, tolerance=0.0)
    slim = slim_solver(mesh, start)
    assert len(ours.rows) == 11
    for row in ours.rows[1:]:
        assert row.energy == pytest.approx(problem.energy(slim(1)), rel=1e-6), row.iteration
