"""What ends a run: no single small step far from the minimum; a scale of gradients that is the same on every mesh."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest

from tests.solvers.test_convergence import case, optimum, problem_of
from workbench.core.constraints import Anchors
from workbench.core.mesh import Mesh
from workbench.core.method import parameter
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import run
from workbench.core.solver import CONFIRMATIONS, Interrupt, characteristic_gradient, never
from workbench.core.state import State
from workbench.core.status import Status

Newton = registry().solvers["projected-newton"]
Sobolev = registry().solvers["sobolev-gradient-descent"]


@dataclass(frozen=True)
class Limping(Sobolev):  # type: ignore[misc, valid-type]
    """Steps of a linear rate, some of them, so many in a row, of next to no length."""

    id = "limping"
    label = "Limping descent"
    short_steps: int = parameter(1, "short steps in a row", minimum=1, maximum=100)

    def step(self, problem: Problem, state: State, interrupt: Interrupt = never) -> State:
        following = super().step(problem, state, interrupt)
        if state.iteration % 10 < 10 - self.short_steps:
            return following
        x = state.positions + 1e-9 * (following.positions - state.positions)
        return replace(
            self.rebase(problem, replace(following, positions=x)),
            previous_energy=state.energy,
            small_decreases=state.small_decreases,
            step_size=1e-9,
        )


@pytest.mark.parametrize("short_steps", [1, CONFIRMATIONS - 1])
def test_steps_that_happen_to_be_short_do_not_end_a_run(short_steps: int) -> None:
    problem, start = problem_of("bumpy-disc")
    state = run(Limping(short_steps=short_steps), problem, start).state
    assert state.status is Status.CONVERGED
    assert state.energy <= optimum("bumpy-disc") * (1 + 1e-4)


def test_as_many_short_steps_as_it_takes_do() -> None:
    problem, start = problem_of("bumpy-disc")
    state = run(Limping(short_steps=CONFIRMATIONS), problem, start).state
    assert (state.status, state.iteration) == (Status.CONVERGED, 10)


def test_newton_steps_count_at_once_unless_the_step_bound_shortened_them() -> None:
    problem, start = problem_of("bumpy-disc")
    state = replace(Newton().init(problem, start), iteration=3, step_size=1.0, small_decreases=1)
    small = replace(state, previous_energy=state.energy * (1 + 1e-9))
    large = replace(state, previous_energy=state.energy * (1 + 1e-3))
    held = replace(small, step_size=0.1, limiting_simplex=7)
    ends = {
        "small": Newton().terminate(problem, small),
        "large": Newton().terminate(problem, large),
        "held": Newton().terminate(problem, held),
        "held often": Newton().terminate(problem, replace(held, small_decreases=CONFIRMATIONS)),
        "first order": Sobolev().terminate(problem, small),
        "still": Sobolev().terminate(problem, replace(small, step_size=0.0, previous_energy=small.energy)),
    }
    assert {name for name, status in ends.items() if status is Status.CONVERGED} == {"small", "held often", "still"}


@cache
def pulled(part: float) -> tuple[Problem, np.ndarray, float]:
    """Four vertices of the rim held, one of them aside by this part of the diameter; a start; the least energy."""
    mesh, _, start = case("fingers")
    held = np.unique([start[:, 0].argmin(), start[:, 0].argmax(), start[:, 1].argmin(), start[:, 1].argmax()])
    targets = start[held]
    targets[0] += part * mesh.diameter
    problem, start = problem_of("fingers", Anchors(held, targets))
    return problem, start, run(Newton(), problem, start, tolerance=1e-12).state.energy


@pytest.mark.parametrize("part", [0.2, 0.5])
@pytest.mark.parametrize("id", ["aqp", "bcqn", "sobolev-gradient-descent", "slim", "akvf", "l-bfgs"])
def test_methods_of_a_linear_rate_come_near_the_minimum(id: str, part: float) -> None:
    """Each of them takes some short step long before, in one of the two cases at least."""
    problem, start, least = pulled(part)
    state = run(registry().solvers[id](), problem, start, iterations=2000).state
    assert state.status is Status.CONVERGED
    assert state.energy <= least * (1 + 1e-4)


def perimeters(mesh: Mesh) -> np.ndarray:
    """(n,) length, or area, of what bounds the star of each vertex, by the corners' own edges and faces."""
    found = np.zeros(mesh.vertex_count)
    for simplex in mesh.simplices:
        for vertex in simplex:
            others = mesh.vertices[[v for v in simplex if v != vertex]]
            edges = others[1:] - others[0]
            found[vertex] += np.sqrt(np.linalg.det(edges @ edges.T)) / len(edges)
    return found


@pytest.mark.parametrize(("name", "second"), [("square", 8.0), ("bumpy-disc", 8.0), ("bar-3d", 8.0)])
def test_the_characteristic_gradient_is_that_of_the_stars(name: str, second: float) -> None:
    """sigma^2 + 1/sigma^2 has the second derivative 8 at 1."""
    mesh, kind, _ = case(name)
    problem = Problem.create(mesh, kind, registry().distortions["symmetric-dirichlet"])  # type: ignore[arg-type]
    assert characteristic_gradient(problem) == pytest.approx(second * np.linalg.norm(perimeters(mesh)), rel=1e-12)


@pytest.mark.parametrize("distortion", sorted(registry().distortions))
def test_every_distortion_has_a_characteristic_gradient_of_ordinary_size(distortion: str) -> None:
    mesh, kind, _ = case("square")
    plain = Problem.create(mesh, kind, registry().distortions["symmetric-dirichlet"])  # type: ignore[arg-type]
    problem = Problem.create(mesh, kind, registry().distortions[distortion])  # type: ignore[arg-type]
    assert 1e-2 < characteristic_gradient(problem) / characteristic_gradient(plain) < 1e3


@pytest.mark.parametrize("id", ["bcqn", "projected-newton"])
def test_a_gradient_tolerance_stops_alike_at_every_scale(id: str) -> None:
    counts = []
    for scale in (1e-3, 1.0, 1e3):
        mesh, kind, start = case("bumpy-disc")
        scaled = Mesh(scale * mesh.vertices, mesh.simplices)
        problem = Problem.create(scaled, kind, registry().distortions["symmetric-dirichlet"])  # type: ignore[arg-type]
        result = run(registry().solvers[id](), problem, scale * start, tolerance=0.0, gradient_tolerance=1e-3)
        assert result.state.status is Status.CONVERGED
        counts.append(result.state.iteration)
    assert max(counts) - min(counts) <= 1
    assert 0 < min(counts) < 100
