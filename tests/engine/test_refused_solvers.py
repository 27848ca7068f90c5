"""A solver that does not take the mesh or the distortion is refused in a sentence, and what was there before goes on."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.conftest import grid, tetrahedral_grid
from workbench.core.mesh import Mesh
from workbench.engine.loop import EngineLoop
from workbench.engine.messages import Load, Refused, Report, Run, SetProblem, SetSolver


def case(folder: Path, mesh: Mesh) -> str:
    path = folder / f"{mesh.name}.npz"
    np.savez(path, V=mesh.vertices, S=mesh.simplices, X0=mesh.vertices * np.linspace(1.5, 1.0, mesh.dimension))
    return str(path)


class Desk:
    """A loop in this process, and the sentences of its refusals."""

    def __init__(self) -> None:
        self.reports: list[Report] = []
        self.loop = EngineLoop(self.reports.append)

    def refusals(self) -> list[str]:
        return [report.sentence for report in self.reports if isinstance(report, Refused)]

    def energy_falls(self) -> bool:
        self.loop.handle(Run(1000, 0.0))
        before = self.loop._state.energy
        self.loop.advance()
        return self.loop._state.energy < before


@pytest.fixture
def desk(tmp_path: Path) -> Desk:
    desk = Desk()
    desk.loop.handle(Load(case(tmp_path, grid(4)), generation=1))
    return desk


def test_a_solver_for_another_distortion(desk: Desk) -> None:
    desk.loop.handle(SetSolver("local-global"))
    assert desk.refusals() == [
        "Local/global minimises arap and arap-barrier alone; choose such a distortion, or another solver."
    ]
    assert desk.loop._solver.id == "projected-newton"
    assert desk.energy_falls()


def test_a_distortion_for_another_solver(desk: Desk) -> None:
    desk.loop.handle(SetProblem("arap"))
    desk.loop.handle(SetSolver("anderson"))
    desk.loop.handle(SetProblem("symmetric-dirichlet"))
    assert len(desk.refusals()) == 1
    assert desk.loop._problem.distortion.id == "arap"
    assert desk.energy_falls()


def test_a_mesh_for_another_solver(desk: Desk, tmp_path: Path) -> None:
    desk.loop.handle(SetSolver("newton-complex"))
    desk.loop.handle(Load(case(tmp_path, tetrahedral_grid(2)), generation=2))
    assert desk.refusals() == ["Newton in the complex view does not solve volume maps; choose another solver."]
    assert desk.loop._problem.dimension == 2
    assert desk.energy_falls()
