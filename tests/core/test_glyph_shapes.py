"""Shapes of glyphs, and the even choice of places for them."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree

from workbench.core.even_sample import even_sample
from workbench.core.glyph_shapes import ball, ellipses, ellipsoids, stretch_lines


@given(st.integers(1, 400), st.integers(1, 300), st.integers(2, 3), st.integers(0, 9))
@settings(max_examples=60)
def test_a_sample_is_of_the_points_and_no_larger_than_asked(size: int, count: int, columns: int, seed: int) -> None:
    points = np.random.default_rng(seed).normal(size=(size, columns))
    rows = even_sample(points, count)
    assert 1 <= len(rows) <= count
    assert (np.diff(rows) > 0).all() and rows[0] >= 0 and rows[-1] < size
    assert len(rows) == size or size > count


@pytest.mark.parametrize(("size", "count"), [(3000, 200), (50_000, 2000)])
def test_a_sample_is_even_where_points_crowd_in_a_corner(size: int, count: int) -> None:
    random = np.random.default_rng(5)
    crowded = np.vstack([random.uniform(size=(size // 2, 2)), 0.05 * random.uniform(size=(size // 2, 2))])
    rows = even_sample(crowded, count)
    assert len(rows) > 0.7 * count
    in_corner = (crowded[rows] < 0.05).all(axis=1).mean()
    assert in_corner < 0.02, "half of the points lie in a four hundredth of the square"
    gaps = cKDTree(crowded[rows]).query(crowded)[0]
    assert gaps.max() < 2.5 / np.sqrt(count), "no place is far from a chosen one"


def test_ends_of_lines_and_points_of_ellipses_are_where_the_axes_say() -> None:
    random = np.random.default_rng(1)
    centres, axes = random.normal(size=(5, 2)), random.normal(size=(5, 2, 2))
    ends = stretch_lines(centres, axes)
    np.testing.assert_allclose(ends.mean(axis=2), np.repeat(centres[:, None], 2, axis=1))
    np.testing.assert_allclose(ends[:, :, 1] - ends[:, :, 0], 2 * axes)
    matrices = axes.transpose(0, 2, 1)
    back = np.linalg.solve(matrices[:, None], (ellipses(centres, axes) - centres[:, None])[..., None])[..., 0]
    np.testing.assert_allclose(np.linalg.norm(back, axis=2), 1.0)


def test_an_ellipsoid_is_the_image_of_a_closed_ball_with_its_normals() -> None:
    directions, triangles = ball()
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1.0)
    edges, counts = np.unique(
        np.sort(np.vstack([triangles[:, [i, i - 2]] for i in range(3)]), axis=1), axis=0, return_counts=True
    )
    assert (counts == 2).all() and len(directions) - len(edges) + len(triangles) == 2
    turn = np.linalg.qr(np.random.default_rng(2).normal(size=(3, 3)))[0]
    axes = np.array([[2.0], [1.0], [0.25]]) * turn
    points, normals = ellipsoids(np.ones((1, 3)), axes[None])
    back = np.linalg.solve(axes.T, (points[0] - 1.0).T).T
    np.testing.assert_allclose(np.linalg.norm(back, axis=1), 1.0)
    expected = (points[0] - 1.0) @ np.linalg.inv(axes.T @ axes)  # the gradient of the quadratic form of the ellipsoid
    np.testing.assert_allclose(normals[0], expected / np.linalg.norm(expected, axis=1, keepdims=True), atol=1e-12)
    assert np.isfinite(ellipsoids(np.zeros((1, 3)), np.zeros((1, 3, 3)))[1]).all()
