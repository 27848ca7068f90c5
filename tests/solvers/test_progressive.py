"""References between the map and the source, and what they are good for."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from tests.solvers.test_laws import SOURCES, start_of
from workbench.core.jacobians import signed_singular_values
from workbench.core.method import Kind
from workbench.core.problem import Problem
from workbench.core.progressive_reference import largest_exponent, progressive_problem
from workbench.core.registry import registry
from workbench.core.run import run
from workbench.core.samples import make_sample
from workbench.engine.starts import make_start


def stretched() -> tuple[Problem, np.ndarray]:
    """A problem and a map of it that distorts every triangle much, without inversions."""
    mesh = SOURCES["parameterize"]
    x = start_of(mesh) * [6.0, 0.02]
    return Problem.create(mesh, "parameterize", registry().distortions["symmetric-dirichlet"]), x


@pytest.mark.parametrize("bound", [4.5, 30.0])
def test_from_the_reference_singular_values_are_powers_and_bounded(bound: float) -> None:
    problem, x = stretched()
    sigma = signed_singular_values(problem.elements, x)
    reference, t = progressive_problem(problem, x, bound, False)
    powers = signed_singular_values(reference.elements, x)
    assert 0.0 < t < 1.0
    assert np.allclose(powers, sigma**t, rtol=1e-10)
    assert problem.distortion.value(powers).max() == pytest.approx(bound, rel=1e-6)
    assert np.array_equal(reference.elements.rest_measures, problem.elements.rest_measures)


def test_a_reference_weighs_every_triangle_alike_where_asked() -> None:
    problem, x = stretched()
    measures = progressive_problem(problem, x, 30.0, True)[0].elements.rest_measures
    assert np.ptp(measures) == 0.0
    assert measures.sum() == pytest.approx(problem.total_measure)


def test_a_map_within_the_bound_has_the_source_for_reference() -> None:
    problem, x = stretched()
    bound = 1.01 * problem.distortion.value(signed_singular_values(problem.elements, x)).max()
    assert progressive_problem(problem, x, bound, True) == (problem, 1.0)


def test_exponents_of_extreme_maps_are_finite() -> None:
    assert 0.0 < largest_exponent(np.array([[1e150, 1e-150]]), 250.0) < 0.1
    assert largest_exponent(np.array([[1.0, 1.0]]), 4.1) == 1.0


@pytest.mark.parametrize(("id", "sample", "kind"), [("progressive", "hilbert", "plane"), ("fast", "fingers", "parameterize")])
def test_fewer_steps_than_projected_newton_where_the_start_is_far_away(id: str, sample: str, kind: Kind) -> None:
    mesh = make_sample(sample, triangles=3000)
    start = make_start(mesh, kind, "tutte")
    problem = Problem.create(mesh, kind, registry().distortions["symmetric-dirichlet"])
    newton, ours = (run(registry().solvers[each](), problem, start, tolerance=1e-8) for each in ("projected-newton", id))
    assert ours.state.energy == pytest.approx(newton.state.energy, rel=1e-3)
    assert ours.state.iteration < newton.state.iteration


def test_with_the_exact_hessian_the_last_steps_are_few() -> None:
    """From a decrease of 1e-6 down to rounding: with the projected one, every step gains a small factor."""
    mesh = make_sample("fingers", triangles=2000)
    start = make_start(mesh, "parameterize", "tutte")
    problem = Problem.create(mesh, "parameterize", registry().distortions["symmetric-dirichlet"])
    late = {}
    for id in ("projected-newton", "fast"):
        rows = run(registry().solvers[id](), problem, start, tolerance=1e-13).rows
        gained = [(before.energy - after.energy) / after.energy for before, after in pairwise(rows)]
        late[id] = sum(part < 1e-6 for part in gained)
    assert late["fast"] <= 0.25 * late["projected-newton"]
