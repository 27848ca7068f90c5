"""Signed singular values of 3x3 matrices: U diag(s) V^T is the matrix, U and V turn, whatever the matrix is."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from workbench.core.jacobians import build_elements, determinants, signed_singular_values
from workbench.core.mesh import Mesh
from workbench.core.singular_values import signed_svd_3x3

entry = st.one_of(st.just(0.0), st.sampled_from([1.0, -1.0, 1e-8, 1e-16]), st.floats(-2.0, 2.0))
exponents = st.sampled_from([-150, -80, 0, 0, 0, 60, 150])
values = st.lists(st.sampled_from([0.0, 1e-140, 1e-17, 1e-9, 0.5, 1.0, 1.0 + 1e-15, 1e9]), min_size=3, max_size=3)


def decomposed(J: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    U, s, V = np.empty((3, 3)), np.empty(3), np.empty((3, 3))
    signed_svd_3x3(np.ascontiguousarray(J, dtype=np.float64), U, s, V)
    return U, s, V


def check(J: np.ndarray) -> np.ndarray:
    """The laws of a signed decomposition; returns the values."""
    U, s, V = decomposed(J)
    size = np.abs(J).max()
    unit = size if size > 0 else 1.0
    for turn in (U, V):
        assert np.abs(turn.T @ turn - np.eye(3)).max() <= 1e-14
        assert np.linalg.det(turn) > 0.9
    assert s[0] >= s[1] >= abs(s[2])
    assert np.abs((U * (s / unit)) @ V.T - J / unit).max() <= 1e-13
    return s


@given(st.lists(entry, min_size=9, max_size=9), exponents)
@example([1.0] * 9, 0)
@example([0.0] * 9, 0)
@example([0.0] * 8 + [5e-324], 0)
@example([1.0, 0, 0, 0, 1.0, 0, 0, 0, 1.0], 150)
@example([-1.0, 0, 0, 0, -1.0, 0, 0, 0, -1.0], -150)
@settings(max_examples=400)
def test_any_matrix_is_decomposed(entries: list[float], exponent: int) -> None:
    J = 10.0**exponent * np.array(entries).reshape(3, 3)
    s = check(J)
    reference = np.linalg.svd(J, compute_uv=False)
    assert np.abs(np.abs(s) - reference).max() <= 1e-13 * reference[0]


@given(values, st.integers(0, 2**32 - 1), st.booleans(), exponents)
@settings(max_examples=400)
def test_repeated_vanishing_and_negative_values_are_found(given_values, seed: int, mirrored: bool, exponent: int) -> None:
    sizes = np.sort(given_values)[::-1]
    left, right = Rotation.random(2, random_state=seed).as_matrix()
    sign = -1.0 if mirrored else 1.0
    scale = 10.0**exponent
    s = check(scale * (left * (sizes * [1.0, 1.0, sign])) @ right.T)
    assert np.abs(np.abs(s) / scale - sizes).max() <= 4e-15 * sizes[0]
    if sizes[2] > 1e-12 * sizes[0]:
        assert np.sign(s[2]) == sign


@given(st.integers(0, 2**32 - 1), st.integers(-60, 0), st.integers(-60, 0))
@settings(max_examples=100)
def test_columns_of_very_different_length_keep_their_digits(seed: int, second: int, third: int) -> None:
    """Needles: the values of an orthogonal matrix with scaled columns are the scales, each to its own last digits."""
    scales = np.array([1.0, 10.0**second, 10.0**third])
    s = check(Rotation.random(random_state=seed).as_matrix() * scales)
    assert np.allclose(s, np.sort(scales)[::-1], rtol=1e-13, atol=0.0)


def test_what_is_not_finite_ends() -> None:
    for bad in (np.nan, np.inf, -np.inf):
        J = np.eye(3)
        J[1, 2] = bad
        assert not np.isfinite(decomposed(J)[1]).all()


@pytest.mark.parametrize("size", [1e-90, 1.0, 1e90])
def test_one_sign_everywhere_the_one_that_the_drawing_has(size: float) -> None:
    """Tetrahedra on the brink of collapse: the sign is that of the determinant of the drawn edges, not of rounding."""
    rng = np.random.default_rng(0)
    tets = np.array([[0, 1, 2, 3]])
    elements = build_elements(Mesh(np.vstack([np.zeros(3), np.eye(3)]), tets))
    for _ in range(200):
        corners = rng.normal(size=(4, 3))
        flat = corners[0] + rng.normal(size=2) @ (corners[1:3] - corners[0])
        x = size * np.vstack([corners[:3], flat + rng.choice([-1e-15, 1e-15, 1e-9]) * corners[3]])
        det = determinants(elements, x)[0]
        value = signed_singular_values(elements, x)[0, 2]
        assert (value > 0) == (det > 0) or value == 0.0
