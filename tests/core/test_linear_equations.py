"""Linear equations as text: reading what was written gives the same rows; whatever is no equation is refused."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from workbench.core.constraints import Anchors, LinearConstraints
from workbench.core.errors import WorkbenchError
from workbench.core.linear_equations import linear_constraints, read_equation, read_equations, with_equations
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import run
from workbench.core.samples import make_sample

NUMBERS = st.floats(-1e60, 1e60).filter(lambda x: x == 0 or abs(x) > 1e-60)
TERMS = st.lists(st.tuples(NUMBERS.filter(bool), st.integers(0, 19), st.integers(0, 2)), min_size=1, max_size=6)


@given(TERMS, NUMBERS, st.randoms(use_true_random=False))
def test_a_line_means_the_sum_that_it_says(terms, value, random):
    """However it is spaced and wherever its terms stand, left minus right is the same affine function."""
    sides: list[list[str]] = [[], []]
    points = np.random.default_rng(random.randrange(2**32)).standard_normal((20, 3))
    expected = 0.0
    size = abs(value) + 1e-300
    for factor, vertex, axis in [*terms, (-value, -1, -1)]:
        side = random.randrange(2)
        said = factor if side == 0 else -factor
        place = "" if vertex < 0 else random.choice([" * ", "*", " ", ""]) + f"{'xyz'[axis]}[{vertex}]"
        sides[side].append(f" {'-' if said < 0 else '+'}{random.choice(['', ' '])}{abs(said)!r}{place}")
        at = 1.0 if vertex < 0 else points[vertex, axis]
        expected += factor * at
        size += abs(factor * at)
    line = "=".join("".join(side) or "0" for side in sides)
    try:
        equation = read_equation(line)
    except WorkbenchError as error:
        assert "no coordinate is left" in error.sentence  # terms of one coordinate may cancel
        return
    assert read_equation(equation.text) == equation
    row = linear_constraints([equation.text], 20, 3)
    assert row is not None
    assert -row.residual(points)[0] == pytest.approx(expected, rel=1e-12, abs=1e-12 * size)


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("x[1]", "one '='"),
        ("x[1] = 2 = 3", "one '='"),
        ("x[1] - x[1] = 0", "no coordinate"),
        ("1 = 2", "no coordinate"),
        ("x[1] x[2] = 0", "+ or -"),
        ("x[1] * x[2] = 0", "no term"),
        ("2 * = x[1]", "coordinate is missing"),
        ("x[-1] = 0", "no term"),
        ("x[1.5] = 0", "no term"),
        ("w[1] = 0", "no term"),
        ("__import__('os') = x[0]", "no term"),
        ("x[1] = 1e999", "too large"),
        ("x[1] = 1e75", "larger than"),
        ("x[1] = nan", "no term"),
        ("= x[1]", "empty"),
        ("x[99999999999999999999] = 0", "no term"),
        ("+".join(["x[1]"] * 9999) + " = 0", "characters"),
    ],
)
def test_what_is_no_linear_equation_is_refused_with_its_reason(line: str, reason: str) -> None:
    with pytest.raises(WorkbenchError, match="line 2") as caught:
        read_equations(f"x[0] = y[0]  # fine\n{line}")
    assert reason in caught.value.sentence


def test_a_vertex_or_axis_that_the_map_does_not_have_is_refused() -> None:
    for line, reason in (("x[20] = 0", "vertices 0 to 19"), ("z[3] = 0", "axis z")):
        with pytest.raises(WorkbenchError, match=reason):
            linear_constraints([line], 20, 2)


@given(st.integers(0, 2**32 - 1), st.integers(1, 8), st.integers(0, 3))
def test_independent_rows_span_all_rows_once_the_held_vertices_are_left_out(seed: int, count: int, repeated: int) -> None:
    random = np.random.default_rng(seed)
    matrix = random.integers(-2, 3, (count, 12)).astype(float)
    matrix = np.vstack([matrix, random.integers(-2, 3, (repeated, count)) @ matrix])
    held = np.unique(random.integers(0, 6, random.integers(0, 5)))
    free = matrix.copy()
    free[:, (held[:, None] * 2 + [0, 1]).reshape(-1)] = 0.0
    found = LinearConstraints(matrix, np.zeros(len(matrix))).independent(held, 2).matrix.toarray()
    found[:, (held[:, None] * 2 + [0, 1]).reshape(-1)] = 0.0
    rank = np.linalg.matrix_rank(free) if free.any() else 0
    assert len(found) == rank == (np.linalg.matrix_rank(found) if len(found) else 0)


@given(st.integers(0, 2**32 - 1), st.integers(1, 8), st.integers(1, 4), st.integers(-3, 3))
def test_only_what_contradicts_the_rows_before_it_is_told(seed: int, count: int, repeated: int, power: int) -> None:
    random = np.random.default_rng(seed)
    matrix = random.integers(-2, 3, (count, 12)).astype(float)
    matrix = np.vstack([matrix, random.integers(-2, 3, (repeated, count)) @ matrix])
    matrix = matrix[np.abs(matrix).max(axis=1) > 0] * 10.0**power
    values = matrix @ random.normal(size=12)
    assert LinearConstraints(matrix, values).first_contradiction() is None
    for row in range(len(matrix)):
        wrong = values.copy()
        wrong[row] += 1.0 + np.abs(values).max()
        answers = [np.linalg.lstsq(matrix[:end], wrong[:end], rcond=None)[0] for end in range(len(matrix) + 1)]
        misses = [np.abs(matrix[:end] @ x - wrong[:end]).max(initial=0.0) for end, x in enumerate(answers)]
        bad = [end - 1 for end, miss in enumerate(misses) if miss > 1e-6 * np.abs(wrong).max()]
        found = LinearConstraints(matrix, wrong).first_contradiction()
        assert (found is None) == (not bad)
        if found is not None:
            assert found[0] == bad[0]
            np.testing.assert_allclose(found[1], matrix[bad[0]] @ answers[bad[0]], atol=1e-8 * np.abs(wrong).max())


def test_equations_that_contradict_each_other_are_refused_by_number_and_value() -> None:
    with pytest.raises(WorkbenchError, match="equation 3 contradicts those before it, by which its left side is 0, not 1"):
        linear_constraints(["x[3] - x[4] = 0", "x[4] = x[5]", "x[3] - x[5] = 1"], 20, 2)


@pytest.mark.parametrize("solver", ["projected-newton", "aqp", "slim", "l-bfgs"])
def test_equations_that_repeat_each_other_hold_as_well(solver: str) -> None:
    """Also where one of them binds anchors only, and so says nothing new."""
    mesh = make_sample("gingerbread")
    anchors = Anchors(np.array([5, 9]), mesh.vertices[[5, 9]])
    lines = ["x[0] - x[30] = 0.1", "2 x[0] = 2 x[30] + 0.2", f"x[5] = {float(mesh.vertices[5, 0])!r}", "y[2] + x[5] = 0.3"]
    distortion = registry().distortions["symmetric-dirichlet"]
    problem = with_equations(Problem.create(mesh, "plane", distortion, anchors), lines)
    result = run(registry().solver(solver)(), problem, mesh.vertices)
    assert problem.constraints is not None
    assert np.abs(problem.constraints.residual(result.state.positions)).max() <= problem.anchor_tolerance
    assert result.state.inverted == 0
    assert not result.state.status.is_failure
