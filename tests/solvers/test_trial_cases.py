"""Meshes of others: anchors are reached from the rest position without an inversion, what starts inverted is said so."""

from __future__ import annotations

import numpy as np
import pytest

from workbench.cli import main
from workbench.core.constraints import Anchors
from workbench.core.distortion import Distortion
from workbench.core.jacobians import determinants
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import RunResult, run
from workbench.core.status import Status
from workbench.io.opening import OpenedSource, open_source


def followed(opened: OpenedSource, anchors: Anchors) -> RunResult:
    """A run from the rest position in which every single map is looked at."""
    mesh = opened.mesh
    problem = Problem.create(mesh, opened.kind, Distortion.resolve("symmetric-dirichlet"), anchors)
    smallest = []

    def look(state) -> None:
        smallest.append(determinants(problem.elements, state.positions).min())

    rest = mesh.vertices[:, : mesh.dimension]
    result = run(registry().solver("projected-newton")(), problem, rest, on_state=look)
    assert min(smallest) > 0.0
    assert result.state.status is Status.CONVERGED
    assert result.state.anchor_error <= problem.anchor_tolerance
    return result


def case(data_folder, name: str) -> str:
    path = data_folder / name
    if not path.is_file():
        pytest.skip(f"{name} is not here")
    return str(path)


def test_handles_of_the_gecko_are_dragged_from_rest(data_folder) -> None:
    """The file's own start has inverted triangles; from rest its sixty handles are reached all the same."""
    opened = open_source(case(data_folder, "cases/aqp_gecko.npz"))
    anchors = Anchors(opened.anchor_vertices, opened.anchor_targets)
    result = followed(opened, anchors)
    assert result.initial.anchor_error > 1e-3 * opened.mesh.diameter
    assert np.abs(result.state.positions[anchors.vertices] - anchors.targets).max() <= 1e-8 * opened.mesh.diameter


def test_rest_wins_over_the_start_in_the_file(data_folder, tmp_path) -> None:
    gecko = case(data_folder, "cases/aqp_gecko.npz")
    options = ["solve", gecko, "--out", str(tmp_path / "out.npz"), "--quiet"]
    assert main(options) == 1  # inverted at the start
    assert main([*options, "--init", "rest"]) == 0


@pytest.mark.parametrize(
    ("name", "part"),
    [*((name, part) for name in ("bar-2523", "rod", "torus", "sphere1K") for part in (0.1, 0.3)), ("octocat", 0.1)],
)
def test_solids_follow_three_anchors(data_folder, name: str, part: float) -> None:
    """The two ends of the longest side and an extreme vertex of another one, two of them pulled away."""
    opened = open_source(case(data_folder, f"polyfem-data/3D/{name}.msh"), tets=True)
    v = opened.mesh.vertices
    along = int(np.ptp(v, axis=0).argmax())
    by_side = np.argsort(v[:, (along + 1) % 3])
    first, last = v[:, along].argmin(), v[:, along].argmax()
    held = np.array([first, last, next(k for k in by_side[::-1] if k not in (first, last))])
    pull = np.array([[0.0, 0.0, 0.0], [0.3, 0.8, 0.5], [-0.5, 0.3, 0.6]])
    followed(opened, Anchors(held, v[held] + part * opened.mesh.diameter * pull))


def test_an_inverted_start_is_named(data_folder, tmp_path, capsys) -> None:
    bar = case(data_folder, "cases/abcd_twisted_bar_30k.npz")
    assert main(["solve", bar, "--out", str(tmp_path / "out.npz")]) == 1
    said = capsys.readouterr()
    assert "104 inverted" in said.out
    assert "Inverted start" in said.err and "symmetric-dirichlet-filtered" in said.err
