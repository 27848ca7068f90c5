"""Every solver gets to the same minimum; with hard and soft anchors, on meshes of every kind, from one energy to another."""

from __future__ import annotations

from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from tests.conftest import grid, tetrahedral_grid
from tests.solvers.test_laws import SOLVERS, curved, skip_unless_taken, start_of
from workbench.core.constraints import Anchors
from workbench.core.jacobians import determinants
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import run
from workbench.core.samples import make_sample
from workbench.core.solver import Solver
from workbench.core.state import State
from workbench.core.status import Status
from workbench.engine.starts import make_start

MESHES = ("square", "curved", "cube", "bumpy-disc", "fingers", "bar-3d")
solvers = pytest.mark.parametrize("id", SOLVERS)


@cache
def case(name: str) -> tuple[Mesh, str, np.ndarray]:
    """Mesh, kind and a start without inversions."""
    if name in ("bumpy-disc", "fingers", "gingerbread"):
        mesh = make_sample(name, triangles=1200 if name == "fingers" else 300)
        return mesh, "parameterize", make_start(mesh, "parameterize", "tutte")
    if name == "bar-3d":
        mesh = make_sample(name, triangles=300)
        return mesh, "volume", mesh.vertices @ np.array([[1.2, 0.3, 0.0], [0.0, 0.8, 0.1], [0.2, 0.0, 1.1]])
    mesh, kind = {"square": (grid(5), "plane"), "curved": (curved(), "parameterize"), "cube": (tetrahedral_grid(2), "volume")}[
        name
    ]
    return mesh, kind, start_of(mesh)


def problem_of(
    name: str, anchors: Anchors | None = None, distortion: str = "symmetric-dirichlet"
) -> tuple[Problem, np.ndarray]:
    mesh, kind, start = case(name)
    return Problem.create(mesh, kind, registry().distortions[distortion], anchors), start  # type: ignore[arg-type]


def hard_and_soft(name: str) -> Anchors:
    """One vertex held where it is, two drawn aside."""
    mesh, _, start = case(name)
    vertices = np.array([0, mesh.vertex_count // 2, mesh.vertex_count - 1])
    targets = start[vertices] + 0.1 * mesh.diameter * np.array([[0.0], [1.0], [-0.5]])
    return Anchors(vertices, targets, [np.inf, 0.3, 3.0])


def walk(solver: Solver, problem: Problem, state: State, steps: int) -> State:
    """Some steps, each checked: energy does not rise, nothing inverts, the held vertex stays."""
    states = [state]
    for _ in range(steps):
        state = solver.step(problem, state)
        assert state.status is Status.RUNNING
        states.append(state)
        if solver.terminate(problem, state) is not Status.RUNNING:
            break
    for before, after in pairwise(states):
        assert after.energy <= before.energy * (1 + 1e-14)
        assert after.energy == pytest.approx(problem.energy(after.positions), rel=1e-12)
        assert (determinants(problem.elements, after.positions) > 0).all()
        assert after.anchor_error <= problem.anchor_tolerance
    return state


@solvers
@pytest.mark.parametrize("name", MESHES)
def test_soft_anchors_and_another_distortion_in_mid_run(id: str, name: str) -> None:
    skip_unless_taken(id, case(name)[1])
    solver = registry().solver(id)()
    if solver.distortions:
        pytest.skip(f"{id} minimises {solver.distortions} alone")
    problem, start = problem_of(name, hard_and_soft(name))
    begun = solver.init(problem, start)
    state = walk(solver, problem, begun, 8)
    assert state.energy < begun.energy
    other = problem.with_distortion(registry().distortions["mips"])
    rebased = solver.rebase(other, state)
    assert rebased.energy == pytest.approx(other.energy(state.positions), rel=1e-14)
    following = walk(solver, other, rebased, 8)
    assert following.energy < rebased.energy
    # where one started does not matter to what is found next: a fresh run from there goes the same way
    fresh_problem, _ = problem_of(name, hard_and_soft(name), "mips")
    fresh = walk(solver, fresh_problem, solver.init(fresh_problem, state.positions), 8)
    assert fresh.energy == pytest.approx(following.energy, rel=1e-9)


@cache
def optimum(name: str) -> float:
    problem, start = problem_of(name)
    return run(registry().solver("projected-newton")(), problem, start, tolerance=1e-12).state.energy


@solvers
def test_the_minimum_is_that_of_projected_newton(id: str) -> None:
    solver = registry().solver(id)()
    if solver.distortions:
        pytest.skip(f"{id} minimises {solver.distortions} alone")
    problem, start = problem_of("bumpy-disc")
    result = run(solver, problem, start, tolerance=1e-12, iterations=3000)
    assert result.state.energy <= optimum("bumpy-disc") * (1 + 1e-3)
    assert result.state.energy >= optimum("bumpy-disc") * (1 - 1e-6)


@pytest.mark.parametrize("name", ["bumpy-disc", "gingerbread"])
@pytest.mark.parametrize("id", ["aqp", "jacobi"])
def test_acceleration_takes_fewer_iterations(id: str, name: str) -> None:
    counts = []
    for accelerate in (True, False):
        problem, start = problem_of(name)
        goal = optimum(name) * (1 + 1e-6)
        rows = run(registry().solver(id)(accelerate=accelerate), problem, start, tolerance=1e-12, iterations=3000).rows
        counts.append(next((row.iteration for row in rows if row.energy <= goal), 3001))
    assert counts[0] < 0.8 * counts[1]


@pytest.mark.parametrize(
    ("id", "factorisations"), [("sobolev-gradient-descent", 1), ("aqp", 1), ("bcqn", 1), ("jacobi", 0), ("l-bfgs", 0)]
)
def test_what_is_factored_once_is_factored_once(id: str, factorisations: int) -> None:
    problem, start = problem_of("bumpy-disc", hard_and_soft("bumpy-disc"))
    result = run(registry().solver(id)(), problem, start, iterations=12, tolerance=0.0)
    other = problem.with_distortion(registry().distortions["mips"])
    run(registry().solver(id)(), other, result.state.positions, iterations=5, tolerance=0.0)
    counts = problem.workspace.all_counts()
    assert counts["factorise"] == factorisations
    assert counts["trials"] >= 12
    assert counts["gradient"] >= 12


def test_sweeps_over_single_vertices_are_charged_what_they_look_at() -> None:
    """Each of the three corners of a triangle asks for its gradient, and for its energy before and after."""
    problem, start = problem_of("bumpy-disc")
    result = run(registry().solver("block-gradient-descent")(), problem, start, iterations=6, tolerance=0.0)
    assert result.state.iteration == 6
    counts = problem.workspace.all_counts()
    assert counts["gradient"] >= 6 * 3
    assert counts["energy"] >= 6 * 2 * 3
    assert counts["energy"] <= 3 * counts["trials"] + 6 * 3 + 1


@pytest.mark.parametrize("id", ["bcqn"])
def test_the_characteristic_gradient_stops_where_asked(id: str) -> None:
    problem, start = problem_of("bumpy-disc")
    early = run(registry().solver(id)(characteristic_stop=1e-2), problem, start, tolerance=0.0, iterations=400)
    late = run(registry().solver(id)(characteristic_stop=1e-5), problem, start, tolerance=0.0, iterations=400)
    assert early.state.status is late.state.status is Status.CONVERGED
    assert 0 < early.state.iteration < late.state.iteration
    assert late.state.gradient_norm < 1e-2 * early.state.gradient_norm


@solvers
def test_an_interrupt_at_any_moment_returns_the_old_map(id: str) -> None:
    """Whichever time a step asks for, from a start and from a map that it has memory of."""
    solver = registry().solver(id)()
    if solver.distortions:
        pytest.skip(f"{id} minimises {solver.distortions} alone")
    problem, start = problem_of("bumpy-disc", hard_and_soft("bumpy-disc"))
    state = solver.init(problem, start)
    for _ in range(6):
        following = state
        for moment in range(1, 400):
            asked = [0]

            def interrupt(moment: int = moment, asked: list[int] = asked) -> bool:
                asked[0] += 1
                return asked[0] == moment

            following = solver.step(problem, state, interrupt)
            if asked[0] < moment:
                break
            assert following.status is Status.INTERRUPTED
            assert following.positions is state.positions
            assert following.iteration == state.iteration
        assert moment > 1
        assert following.status is Status.RUNNING
        state = following
