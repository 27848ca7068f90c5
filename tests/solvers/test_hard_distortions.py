"""Minimising what is not smooth, overflows, collapses simplices or looks at the start."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import special_ortho_group

from tests.conftest import grid, tetrahedral_grid
from tests.solvers.test_laws import problem_of
from workbench.core.constraints import Anchors
from workbench.core.distortion import Distortion
from workbench.core.jacobians import determinants
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import RunResult, run
from workbench.core.samples import make_sample
from workbench.core.status import Status
from workbench.engine.starts import make_start
from workbench.io.opening import open_source


def newton(
    problem: Problem, start: np.ndarray, tolerance: float = 1e-6, iterations: int = 400
) -> tuple[RunResult, list[float]]:
    energies: list[float] = []
    solver = registry().solvers["projected-newton"]()
    result = run(solver, problem, start, tolerance=tolerance, on_state=lambda state: energies.append(state.energy))
    assert all(after <= before for before, after in pairwise(energies)), "the energy rose"
    return result, energies


@pytest.mark.parametrize("anchors", ["none", "held"])
@pytest.mark.parametrize("kind", ["plane", "parameterize", "volume"])
@pytest.mark.parametrize("id", sorted(registry().distortions))
def test_every_distortion_is_minimised(id: str, kind: str, anchors: str) -> None:
    problem, start = problem_of(kind, anchors, id)
    result, energies = newton(problem, start)
    assert result.state.status is Status.CONVERGED
    assert result.state.inverted == 0
    assert energies[-1] < energies[0]


@pytest.fixture(scope="module")
def bumpy() -> tuple[Mesh, np.ndarray]:
    mesh = make_sample("bumpy-disc", triangles=1500)
    return mesh, make_start(mesh, "parameterize", "tutte", {}, "", False)


@pytest.mark.parametrize(
    "formula",
    ["condition-number", "lam*symmetric_dirichlet + (1 - lam)*condition_number", "quasi-isometric", "symmetric-arap"],
)
def test_kinks_do_not_hold_newton_up(formula: str, bumpy: tuple[Mesh, np.ndarray]) -> None:
    """The minimum is below what the smooth relative of the distortion reaches, and nothing inverts on the way."""
    mesh, start = bumpy
    values = {"lam": 1e-3} if "lam" in formula else {}
    problem = Problem.create(mesh, "parameterize", Distortion.resolve(formula, values))
    result, _ = newton(problem, start)
    assert result.state.status is Status.CONVERGED
    assert result.state.inverted == 0
    is_conformal = "condition" in formula
    relative = registry().distortions["mips" if is_conformal else "symmetric-dirichlet"]
    smooth, _ = newton(Problem.create(mesh, "parameterize", relative), start)
    assert result.state.energy < problem.energy(smooth.state.positions)


@pytest.mark.parametrize(
    "formula",
    [
        "amips", "amips-smooth", "exp(symmetric_dirichlet)", "2*exp(3*mips)", "0.01*amips + 0.99*symmetric_dirichlet",
        "exp(mips) + exp(symmetric_dirichlet)", "exp(mips)^2*exp(arap)", "max(amips, 3)",
    ],
)  # fmt: skip
@pytest.mark.parametrize("kind", ["plane", "volume"])
def test_exponentials_that_overflow_reach_the_minimum_of_those_that_do_not(formula: str, kind: str) -> None:
    mesh = grid(6) if kind == "plane" else tetrahedral_grid(2)
    n = mesh.dimension
    held = np.array([0, mesh.vertex_count - 1])
    near = mesh.vertices @ np.diag([1.2, 0.9, 1.0][:n])
    problem = Problem.create(mesh, kind, Distortion.resolve(formula), Anchors(held, near[held]))  # type: ignore[arg-type]
    far = near.copy()
    inner = (mesh.vertices[:, 0] > 0.05) & (mesh.vertices[:, 0] < 0.95)
    far[inner, 0] = near[0, 0] + 1e-4 * mesh.vertices[inner, 0]  # a sheet of needles
    assert not np.isfinite(problem.energy(far))
    expected, _ = newton(problem, near, 1e-12)
    result, energies = newton(problem, far, 1e-12)
    assert result.state.status is Status.CONVERGED
    assert result.state.inverted == 0
    assert np.isinf(energies[0])
    assert result.state.energy == pytest.approx(expected.state.energy, rel=1e-7)


@pytest.mark.parametrize(
    "formula",
    ["sqrt(sum((sigma - 1/sigma)^2))", "sum((sigma - 1)^2)^0.5", "sum(abs(log(sigma)))", "max(abs(sigma - 1))"],
)
@pytest.mark.parametrize("kind", ["plane", "volume"])
def test_a_norm_that_vanishes_at_the_start_is_at_its_minimum_there(formula: str, kind: str) -> None:
    """Such a norm has no derivative at its minimum, and what rounding leaves of it must not look like a failure."""
    mesh = grid(6) if kind == "plane" else tetrahedral_grid(2)
    problem = Problem.create(mesh, kind, Distortion.resolve(formula))  # type: ignore[arg-type]
    turn = special_ortho_group.rvs(mesh.dimension, random_state=3)
    for start in (mesh.vertices, mesh.vertices + 0.1, mesh.vertices @ turn - 1.0):
        result, energies = newton(problem, start)
        assert result.state.status is Status.CONVERGED
        assert np.isfinite(result.state.gradient_norm)
        assert energies[-1] <= energies[0]


@pytest.mark.parametrize(
    ("id", "values"), [("dirichlet", {}), ("lp-gauge", {"p": 2.0}), ("lp-gauge", {"p": 3.0}), ("ky-fan", {"k": 2})]
)
def test_convex_energies_have_one_minimum_from_three_starts(id: str, values: dict[str, float]) -> None:
    """The problems of Fig. 18: a bar with its ends held."""
    mesh = make_sample("bar-3d", triangles=600)
    v = mesh.vertices
    along = (v[:, 0] - v[:, 0].min()) / np.ptp(v[:, 0])
    ends = np.flatnonzero((along < 1e-9) | (along > 1 - 1e-9))
    problem = Problem.create(mesh, "volume", Distortion.resolve(id, values), Anchors(ends, v[ends]))
    bent = v + np.outer(np.sin(np.pi * along), [0.0, 0.4, 0.0])
    angle = 2.0 * np.sin(np.pi * along)
    centre = v.mean(axis=0)
    cosine, sine = np.cos(angle)[:, None], np.sin(angle)[:, None]
    y, z = np.hsplit((v - centre)[:, 1:], 2)
    turned = np.hstack([v[:, :1], centre[1] + cosine * y - sine * z, centre[2] + sine * y + cosine * z])
    energies = [newton(problem, start, 1e-12)[0].state.energy for start in (v, bent, turned)]
    assert max(energies) - min(energies) <= 1e-8 * min(energies)


def test_without_a_barrier_the_step_bound_is_not_what_stops_newton(monkeypatch: pytest.MonkeyPatch) -> None:
    x, y = grid(16).vertices.T
    height = 2.0 * np.exp(-30.0 * ((x - 0.35) ** 2 + (y - 0.6) ** 2)) + 1.5 * np.exp(-40.0 * ((x - 0.75) ** 2 + (y - 0.3) ** 2))
    fingers = Mesh(np.column_stack([x, y, height]), grid(16).simplices)  # the start crowds their tips together
    start = make_start(fingers, "parameterize", "tutte", {}, "", False)
    problem = Problem.create(fingers, "parameterize", Distortion.resolve("max(abs(sigma - 1))"))
    result, _ = newton(problem, start)
    assert result.state.status is Status.CONVERGED
    assert result.state.inverted == 0
    monkeypatch.setattr(registry().solvers["projected-newton"], "takes_fences", False)
    assert newton(problem, start)[0].state.energy > 1.1 * result.state.energy  # stuck


@pytest.mark.parametrize("id", ["aqp", "slim", "sobolev-gradient-descent", "local-global", "anderson", "fast"])
def test_without_a_barrier_the_step_bound_does_not_stop_the_others_either(id: str) -> None:
    mesh = make_sample("fingers", triangles=1200)
    start = make_start(mesh, "parameterize", "tutte", {}, "", False)
    problem = Problem.create(mesh, "parameterize", registry().distortions["arap"])
    least = newton(problem, start)[0].state.energy
    state = run(registry().solvers[id](), problem, start).state
    assert state.status is Status.CONVERGED
    assert state.inverted == 0
    assert state.energy <= least * 1.05  # there are several minima; stuck maps are 50 % above the least


@pytest.mark.parametrize("id", ["arap", "arap-barrier"])
def test_arap_of_a_hand_comes_as_low_as_with_a_faint_barrier(id: str, data_folder: Path) -> None:
    opened = open_source(str(data_folder / "odedstein-meshes/hand/hand_lowres.obj"))
    start = make_start(opened.mesh, "parameterize", "tutte", {}, "", False)
    problem = Problem.create(opened.mesh, "parameterize", registry().distortions[id])
    result, _ = newton(problem, start)
    assert result.state.status is Status.CONVERGED
    assert result.state.inverted == 0
    guarded, _ = newton(Problem.create(opened.mesh, "parameterize", Distortion.resolve("arap + 1e-5/det")), start)
    assert result.state.energy < problem.energy(guarded.state.positions) * (1 + 1e-3)


@pytest.mark.parametrize("id", ["spectral", "ky-fan"])
@pytest.mark.parametrize("kind", ["plane", "volume"])
def test_norms_of_the_largest_values_shrink_a_free_map_to_nothing(id: str, kind: str) -> None:
    mesh = grid(6) if kind == "plane" else tetrahedral_grid(2)
    start = mesh.vertices + 0.2 * np.sin(4 * mesh.vertices) ** 2 @ np.diag([0.5, 1.0, 0.7][: mesh.dimension])
    result, _ = newton(Problem.create(mesh, kind, registry().distortions[id]), start)  # type: ignore[arg-type]
    assert result.state.status is Status.CONVERGED
    assert 0.0 <= result.state.energy < 1e-9
    assert result.state.inverted == 0


def test_a_filtered_barrier_lets_inverted_triangles_unfold_and_holds_the_others() -> None:
    mesh = grid(6)
    start = mesh.vertices.copy()
    folded = 24
    start[folded] += [0.3, 0.05]  # over its neighbours
    distortion = registry().distortions["symmetric-dirichlet-filtered"]
    boundary = mesh.topology.boundary_vertices
    problem = Problem.create(mesh, "plane", distortion, Anchors(boundary, mesh.vertices[boundary]))
    assert problem.inverted(start) > 0
    plain = Problem.create(mesh, "plane", registry().distortions["symmetric-dirichlet"], problem.anchors)
    assert newton(plain, start)[0].state.status is Status.INVERTED_START
    upright = problem.from_start(start).density.kept > 0.5
    worst: list[float] = []
    solver = registry().solvers["projected-newton"]()
    result = run(
        solver,
        problem,
        start,
        on_state=lambda state: worst.append(determinants(problem.elements, state.positions)[upright].min()),
    )
    assert min(worst) > 0
    assert result.state.status is Status.CONVERGED
    assert result.state.inverted == 0
    clean = newton(problem, mesh.vertices)[0]
    assert clean.state.energy == pytest.approx(4.0 * problem.total_measure, rel=1e-9)


def test_what_has_just_unfolded_does_not_hold_the_whole_map(data_folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case = open_source(str(data_folder / "cases/abcd_elephant_2k.npz"))  # 786 of 1796 triangles are inverted at its start
    mesh, start = case.mesh, case.start
    assert start is not None and case.anchor_vertices is not None and case.anchor_targets is not None
    anchors = Anchors(case.anchor_vertices, case.anchor_targets)
    problem = Problem.create(mesh, "plane", registry().distortions["symmetric-dirichlet-filtered"], anchors)
    upright = problem.from_start(start).density.kept > 0.5
    result, _ = newton(problem, start)
    assert result.state.status is Status.CONVERGED
    assert determinants(problem.elements, result.state.positions)[upright].min() > 0
    assert result.state.gradient_norm < 1.0
    assert result.state.inverted < 100
    monkeypatch.setattr(Problem, "held_simplices", lambda self, inverted: slice(None))
    stuck, _ = newton(problem, start)
    assert stuck.state.gradient_norm > 1e6
    assert stuck.state.energy > 100 * result.state.energy
