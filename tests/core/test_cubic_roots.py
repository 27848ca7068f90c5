"""Where a tetrahedron loses its orientation: first roots of cubics, against exact arithmetic, in every ill-conditioned way."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from workbench.core.jacobians import build_elements, determinants
from workbench.core.line_search import largest_step, smallest_positive_root_cubic
from workbench.core.mesh import Mesh

ROUNDING = Fraction(8, 2**52)
root = st.one_of(st.floats(-4.0, 4.0), st.floats(1e-12, 1e-6), st.floats(1e3, 1e9), st.sampled_from([1.0, 1.0 + 1e-15, 0.5]))
lead = st.sampled_from([0.0, 1e-300, -1e-300, 1e-30, -1e-18, 1e-9, -1.0, 1.0, 1e9])


def exact(coefficients: tuple[float, ...], t: float) -> tuple[Fraction, Fraction]:
    """Value of the cubic at t, and the sum of the sizes of its terms, without rounding."""
    time, value, size = Fraction(t), Fraction(0), Fraction(0)
    for c in coefficients:
        value, size = value * time + Fraction(c), size * time + abs(Fraction(c))
    return value, size


def check_first_root(a: float, b: float, c: float, d: float) -> float:
    """Positive up to the root, within rounding of the terms, and zero at it."""
    found = smallest_positive_root_cubic(a, b, c, d)
    assert found > 0.0
    turns = np.roots([3 * a, 2 * b, c]) if a or b else np.empty(0)
    farthest = found if found < math.inf else 1e12
    places = [float(t.real) for t in turns if 0 < t.real < farthest] + [farthest * p for p in (1e-6, 0.1, 0.5, 0.9, 1 - 1e-9)]
    for t in places:
        value, size = exact((a, b, c, d), t)
        assert value > -ROUNDING * size
    if found < math.inf:
        # looked for up to somewhere alone, it is the same root, or none
        assert smallest_positive_root_cubic(a, b, c, d, 1.5 * found) == pytest.approx(found, rel=1e-4)
        assert smallest_positive_root_cubic(a, b, c, d, 0.5 * found) == math.inf
        value, size = exact((a, b, c, d), found)
        assert abs(value) <= ROUNDING * size
    return found


@given(root, root, root)
@example(1.0, 1.0, 1.0)
@example(1.0, 1.0, -2.0)
@example(1e-12, 1e-12, 3.0)
@settings(max_examples=120)
def test_double_and_triple_roots(r: float, s: float, t: float) -> None:
    coefficients = np.poly([r, s, t])
    if coefficients[3] == 0.0:
        return
    found = check_first_root(*(coefficients * np.sign(coefficients[3])))
    crossings = [x for x in (r, s, t) if x > 0]
    if len(crossings) % 2:  # an odd number of sign changes: one of them is met
        assert found <= max(crossings) * (1 + 1e-4)


@given(lead, st.floats(-10, 10), st.floats(-10, 10), st.floats(1e-12, 10))
@example(-1e-300, 0.0, 0.0, 1.0)
@example(0.0, 0.0, 0.0, 1.0)
@example(1e9, -1e-9, 0.0, 1e-12)
@settings(max_examples=120)
def test_vanishing_leading_coefficients(a: float, b: float, c: float, d: float) -> None:
    if check_first_root(a, b, c, d) == math.inf:
        assert a >= 0.0 or abs(a) < 1e-17  # a cubic that falls in the end has a root, though it may lie beyond all steps


@pytest.mark.parametrize("place", range(4))
@pytest.mark.parametrize("bad", [math.nan, math.inf, -math.inf])
def test_no_step_where_a_coefficient_is_no_number(place: int, bad: float) -> None:
    coefficients = [0.3, -0.2, 0.1, 1.0]
    coefficients[place] = bad
    assert smallest_positive_root_cubic(*coefficients) == 0.0


@pytest.mark.parametrize("start", [0.0, -1.0, -1e-300])
def test_no_step_from_a_collapsed_tetrahedron(start: float) -> None:
    assert smallest_positive_root_cubic(1.0, 1.0, 1.0, start) == 0.0


@given(st.integers(0, 2**32 - 1), st.sampled_from([1e-9, 1e-4, 1.0]), st.sampled_from([1e-60, 1e-6, 1.0, 1e40]))
@settings(max_examples=120)
def test_a_tetrahedron_turns_over_at_its_bound_and_not_before(seed: int, thickness: float, size: float) -> None:
    rng = np.random.default_rng(seed)
    corners = size * rng.normal(size=(4, 3)) * [1.0, 1.0, thickness]
    tets = np.array([[0, 1, 2, 3]])
    if np.linalg.det(corners[1:] - corners[:1]) < 0:
        tets = tets[:, [0, 2, 1, 3]]
    direction = rng.normal(size=(4, 3)) * 10.0 ** rng.integers(-3, 4)
    elements = build_elements(Mesh(corners, tets))
    bound, simplex = largest_step(corners, direction, tets)
    assert bound > 0.0
    if bound == math.inf:
        assert simplex == -1
        return
    for part in np.linspace(0.0, 1.0 - 1e-6, 40):
        assert determinants(elements, corners + part * bound * direction)[0] > 0
    beyond = determinants(elements, corners + (1.0 + 1e-6) * bound * direction)[0]
    assert beyond < 1e-9  # over, or touching a double root


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_a_direction_that_is_no_number_allows_no_step(bad: float) -> None:
    corners = np.vstack([np.zeros(3), np.eye(3)])
    direction = np.zeros((4, 3))
    direction[2, 1] = bad
    assert largest_step(corners, direction, np.array([[0, 1, 2, 3]])) == (0.0, 0)
