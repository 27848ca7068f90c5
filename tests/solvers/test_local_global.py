"""The local/global alternation and its acceleration: libigl's maps, fewer steps, and as-rigid-as-possible maps alone."""

from __future__ import annotations

import numpy as np
import pytest

from tests.libigl_reference import arap_map
from tests.solvers.test_laws import SOURCES, anchors_of, start_of
from workbench.core.anderson_mixing import anderson_step
from workbench.core.errors import WorkbenchError
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import RunResult, run

kinds = pytest.mark.parametrize("kind", sorted(SOURCES))


def arap(kind: str, distortion: str = "arap") -> tuple[Problem, np.ndarray]:
    """A small problem with two anchors in place, and a start without inversions."""
    mesh = SOURCES[kind]
    x = start_of(mesh)
    return Problem.create(mesh, kind, registry().distortions[distortion], anchors_of(mesh, x, 0.0)), x  # type: ignore[arg-type]


def solved(id: str, problem: Problem, x: np.ndarray, iterations: int, tolerance: float = 0.0, **parameters: int) -> RunResult:
    return run(registry().solvers[id](**parameters), problem, x, iterations=iterations, tolerance=tolerance)  # type: ignore[call-arg]


@kinds
@pytest.mark.parametrize("iterations", [1, 10])
def test_maps_are_those_of_libigl(kind: str, iterations: int) -> None:
    problem, x = arap(kind)
    ours = solved("local-global", problem, x, iterations).state
    theirs = arap_map(problem.mesh, x, problem.anchors, iterations)
    assert ours.iteration == iterations
    assert ours.energy == pytest.approx(problem.energy(theirs), rel=1e-6)
    # libigl finds rotations in space in single precision.
    assert abs(ours.positions - theirs).max() <= (1e-5 if kind == "volume" else 1e-8)


@kinds
def test_acceleration_takes_fewer_steps_to_the_same_map(kind: str) -> None:
    problem, x = arap(kind)
    plain = solved("local-global", problem, x, 400, 1e-10)
    accelerated = solved("anderson", problem, x, 400, 1e-10)
    assert accelerated.state.energy == pytest.approx(plain.state.energy, rel=1e-6)
    assert accelerated.state.iteration < 0.6 * plain.state.iteration


@kinds
def test_without_a_window_it_is_the_plain_alternation(kind: str) -> None:
    problem, x = arap(kind)
    plain, windowless = solved("local-global", problem, x, 8), solved("anderson", problem, x, 8, window=0)
    assert np.array_equal(plain.state.positions, windowless.state.positions)


@pytest.mark.parametrize("id", ["local-global", "anderson"])
def test_another_distortion_is_refused_with_what_to_do(id: str) -> None:
    problem, x = arap("plane", "symmetric-dirichlet")
    with pytest.raises(WorkbenchError, match=r"minimises arap and arap-barrier alone; choose"):
        solved(id, problem, x, 1)


def test_a_linear_iteration_is_solved_at_once() -> None:
    """In d dimensions d + 1 iterates of x -> A x + b give the fixed point exactly, as GMRES does."""
    rng = np.random.default_rng(5)
    matrix, offset = 0.4 * rng.normal(size=(4, 4)), rng.normal(size=4)
    x = np.zeros(4)
    iterates = []
    for _ in range(5):
        step = matrix @ x + offset - x
        iterates.append((x.reshape(2, 2), step.reshape(2, 2)))
        x = x + step
    last, _ = iterates[-1]
    fixed = np.linalg.solve(np.eye(4) - matrix, offset)
    assert np.allclose((last + anderson_step(tuple(iterates))).reshape(-1), fixed, rtol=1e-9)
