"""The multifrontal Cholesky factorisation against dense algebra, and its promises."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from workbench.core.cholesky import CholeskyFactor, NotPositiveDefiniteError, analyse_pattern
from workbench.core.linear_solver import available_back_ends, make_linear_solver
from workbench.core.pattern import build_pattern
from workbench.core.samples import make_sample
from workbench.core.threads import set_thread_count, thread_count


def definite_values(pattern, seed, zeros=0.0):
    """Random values on the pattern whose rows are dominated by the diagonal."""
    random = np.random.default_rng(seed)
    values = random.standard_normal(pattern.entry_count)
    values[random.random(pattern.entry_count) < zeros] = 0.0
    values[pattern.diagonal] = 0.0
    sums = pattern.multiply(np.abs(values), np.ones(pattern.size))
    values[pattern.diagonal] = sums + random.uniform(0.1, 1.0, pattern.size)
    return values


def dense(pattern, values):
    matrix = np.zeros((pattern.size, pattern.size))
    matrix[pattern.rows, pattern.columns] = values
    return matrix + np.tril(matrix, -1).T


@settings(max_examples=60)
@given(
    st.integers(1, 3),
    st.integers(1, 60),
    st.integers(0, 120),
    st.sampled_from([3, 4]),
    st.booleans(),
    st.floats(0.0, 1.0),
    st.integers(0, 2**32),
)
def test_any_pattern_in_any_order(dimension, vertices, count, width, ordered, zeros, seed):
    random = np.random.default_rng(seed)
    simplices = random.integers(0, vertices, (count, width))
    simplices = simplices[[len(set(simplex)) == width for simplex in simplices]].reshape(-1, width)
    order = None if ordered and len(simplices) else random.permutation(vertices)
    pattern = build_pattern(simplices, vertices, dimension, order)
    values = definite_values(pattern, seed, zeros)
    matrix, rhs = dense(pattern, values), random.standard_normal((pattern.size, 2))
    factor = CholeskyFactor(analyse_pattern(pattern))
    factor.factorise(values)
    np.testing.assert_allclose(factor.solve(rhs), np.linalg.solve(matrix, rhs), rtol=1e-9, atol=1e-10)
    np.testing.assert_array_equal(factor.solve(rhs[:, 0]), factor.solve(rhs)[:, 0])


@pytest.mark.parametrize(("sample", "size", "dimension"), [("bumpy-disc", 6000, 2), ("ball", 6000, 3)])
def test_bit_for_bit_the_same_whatever_the_threads(sample, size, dimension):
    mesh = make_sample(sample, triangles=size)
    pattern = build_pattern(mesh.simplices, mesh.vertex_count, dimension, mesh.elimination_order)
    values, rhs = definite_values(pattern, 0), np.random.default_rng(1).standard_normal(pattern.size)
    factor = CholeskyFactor(analyse_pattern(pattern))
    kept, solutions = thread_count(), []
    try:
        for count in (1, 2, 3, 1):
            set_thread_count(count)
            factor.factorise(values)
            solutions.append(factor.solve(rhs))
    finally:
        set_thread_count(kept)
    for solution in solutions[1:]:
        np.testing.assert_array_equal(solution, solutions[0])
    assert np.linalg.norm(pattern.multiply(values, solutions[0]) - rhs) < 1e-12 * np.linalg.norm(rhs) * pattern.size


@pytest.mark.parametrize("poison", [np.nan, np.inf, -1.0, 0.0])
def test_what_is_not_positive_definite_is_told_and_forgotten(poison):
    mesh = make_sample("bar-3d", triangles=1500)
    pattern = build_pattern(mesh.simplices, mesh.vertex_count, 3, mesh.elimination_order)
    values, rhs = definite_values(pattern, 0), np.ones(pattern.size)
    factor = CholeskyFactor(analyse_pattern(pattern))
    factor.factorise(values)
    before = factor.solve(rhs)
    for place in (0, pattern.size // 2, pattern.size - 1):
        bad = values.copy()
        bad[pattern.diagonal[place]] = poison
        with pytest.raises(NotPositiveDefiniteError):
            factor.factorise(bad)
    factor.factorise(values)
    np.testing.assert_array_equal(factor.solve(rhs), before)


def test_the_factor_is_hardly_larger_than_it_must_be():
    """Padding pays for wider panels, within bounds: at most 1.6 times the entries of the exact factor."""
    mesh = make_sample("bumpy-disc", triangles=20_000)
    pattern = build_pattern(mesh.simplices, mesh.vertex_count, 2, mesh.elimination_order)
    symbolic = analyse_pattern(pattern)
    heights, columns = np.diff(symbolic.layout.row_starts), np.diff(symbolic.layout.first)
    stored = (columns * heights - columns * (columns - 1) // 2).sum()
    exact = exact_factor_entries(pattern)
    assert exact <= stored < 1.6 * exact


def test_back_ends_agree():
    mesh = make_sample("ball", triangles=3000)
    pattern = build_pattern(mesh.simplices, mesh.vertex_count, 3, mesh.elimination_order)
    values, rhs = definite_values(pattern, 0), np.random.default_rng(0).standard_normal((pattern.size, 3))
    solutions = []
    for name in available_back_ends():
        solver = make_linear_solver(pattern, name)
        solver.factorise(values)
        solutions.append(solver.solve(rhs))
    assert len(solutions) > 1
    for solution in solutions[1:]:
        np.testing.assert_allclose(solution, solutions[0], rtol=1e-9, atol=1e-12)


def exact_factor_entries(pattern):
    """Entries of L without padding, by sets: column j's rows go to its parent, the first of them."""
    d = pattern.dimension
    n = pattern.size // d
    rows = [set() for _ in range(n)]
    for row, column in zip(pattern.rows // d, pattern.columns // d, strict=True):
        if row > column:
            rows[column].add(int(row))
    total = 0
    for column in range(n):
        below = rows[column]
        total += d * d * len(below) + d * (d + 1) // 2
        if below:
            parent = min(below)
            rows[parent] |= below - {parent}
        rows[column] = set()
    return total
