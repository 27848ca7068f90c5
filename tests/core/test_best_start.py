"""Which start is taken, and at which scale."""

from __future__ import annotations

import numpy as np
import pytest

from tests.conftest import grid
from workbench.core.best_start import best_scale, best_start
from workbench.core.constraints import Anchors
from workbench.core.errors import WorkbenchError
from workbench.core.jacobians import signed_singular_values
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.samples import make_sample
from workbench.engine.starts import make_start


def problem_of(distortion: str) -> Problem:
    return Problem.create(grid(5), "plane", registry().distortions[distortion])


def bent(problem: Problem) -> np.ndarray:
    x, y = problem.mesh.vertices.T
    return np.column_stack([(1 + x) * np.cos(1.5 * y), (1 + x) * np.sin(1.5 * y)])


@pytest.mark.parametrize("factor", [1e-4, 0.3, 1.0, 50.0])
def test_the_scale_is_the_best_one_wherever_it_begins(factor: float) -> None:
    """For (32) the energy of s x is a s^2 + b / s^2, least at (b / a)^(1/4)."""
    problem = problem_of("symmetric-dirichlet")
    x = factor * bent(problem)
    squares = problem.elements.rest_measures[:, None] * signed_singular_values(problem.elements, x) ** np.array([[[2]], [[-2]]])
    a, b = squares.sum(axis=(1, 2))
    assert best_scale(problem, x) == pytest.approx((b / a) ** 0.25, rel=2e-3)


@pytest.mark.parametrize("distortion", ["dirichlet", "mips", "average-singular-value"])
def test_without_a_best_scale_a_start_stays_as_it_is(distortion: str) -> None:
    problem = problem_of(distortion)
    assert best_scale(problem, bent(problem)) == 1.0


def test_the_least_energy_wins_and_inverted_starts_come_last() -> None:
    problem = problem_of("symmetric-dirichlet")
    rest, far = problem.mesh.vertices, bent(problem)
    folded = rest.copy()
    folded[14] += 0.5
    assert problem.inverted(folded)
    ranked = best_start(problem, {"folded": folded, "far": far, "small": 0.01 * rest})
    assert [c.id for c in ranked] == ["small", "far", "folded"]
    assert ranked[0].energy == pytest.approx(4.0, rel=1e-5)
    assert ranked[0].scale == pytest.approx(100.0, rel=1e-3)
    assert np.array_equal(ranked[0].positions, 0.01 * rest * ranked[0].scale)
    assert not np.isfinite(ranked[2].energy)


def test_anchors_keep_a_start_where_it_is() -> None:
    problem = problem_of("symmetric-dirichlet")
    held = problem.with_anchors(Anchors([0], [[0.0, 0.0]]))
    assert best_start(held, {"far": bent(problem)})[0].scale == 1.0


def test_no_start_at_all_is_said() -> None:
    with pytest.raises(WorkbenchError, match="None of the initializers"):
        best_start(problem_of("symmetric-dirichlet"), {})


@pytest.mark.parametrize("id", ["symmetric-dirichlet", "mips"])
def test_the_automatic_start_is_the_best_of_the_quick_ones(id: str) -> None:
    mesh = make_sample("fingers", triangles=1500)
    problem = Problem.create(mesh, "parameterize", registry().distortions[id])
    chosen = make_start(mesh, "parameterize", "auto", problem=problem)
    assert problem.inverted(chosen) == 0
    for other in ("tutte", "harmonic", "lscm"):
        start = make_start(mesh, "parameterize", other)
        assert problem.energy(chosen) <= problem.energy(start) or problem.inverted(start)
