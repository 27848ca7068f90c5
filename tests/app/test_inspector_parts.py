"""Parts of the inspector that need no window: level lines, outlines, samples of the plane, the newest piece of work."""

from __future__ import annotations

import threading

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pytestqt.qtbot import QtBot

from workbench.app.inspector.badges import written
from workbench.app.inspector.gestures import inside
from workbench.app.inspector.latest import Latest
from workbench.app.inspector.level_lines import level_lines
from workbench.app.inspector.plane_field import (
    PlaneStyle,
    Region,
    colour_ends,
    round_levels,
    sample_plane,
    scale_shares,
)
from workbench.core.distortion import Distortion


def grid(size: int) -> tuple[np.ndarray, np.ndarray]:
    return np.meshgrid(np.arange(size, dtype=float), np.arange(size, dtype=float), indexing="ij")


@given(a=st.floats(-2, 2), b=st.floats(-2, 2), share=st.floats(0.05, 0.95))
def test_level_lines_of_a_linear_function_lie_on_its_level(a: float, b: float, share: float) -> None:
    x, y = grid(9)
    values = a * x + b * y
    level = values.min() + share * np.ptp(values)
    pieces = level_lines(values, level)
    if np.ptp(values) > 1e-3:
        assert len(pieces)
        np.testing.assert_allclose(pieces @ np.array([a, b]), level, atol=1e-9)


def test_level_lines_of_a_cone_are_closed_and_as_long_as_the_circle() -> None:
    x, y = grid(60)
    pieces = level_lines(np.hypot(x - 29.3, y - 30.1), 20.4)
    assert np.linalg.norm(pieces[:, 0] - pieces[:, 1], axis=1).sum() == pytest.approx(2 * np.pi * 20.4, rel=2e-3)
    _, counts = np.unique(pieces.reshape(-1, 2).round(9), axis=0, return_counts=True)
    assert (counts == 2).all()


def test_saddles_are_passed_twice_and_holes_left_out() -> None:
    assert len(level_lines(np.array([[1.0, 0.0], [0.0, 1.0]]), 0.4)) == 2
    x, y = grid(12)
    values = x + y
    values[5, 5] = np.nan
    pieces = level_lines(values, 10.5)
    assert len(pieces)
    assert not (np.abs(pieces.mean(axis=1) - 5) < 1).all(axis=1).any()


@settings(max_examples=50)
@given(st.integers(0, 2**32 - 1), st.integers(3, 9))
def test_inside_agrees_with_the_winding_of_a_convex_outline(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    angles = np.sort(rng.uniform(0, 2 * np.pi, count))
    outline = np.c_[np.cos(angles), np.sin(angles)]
    points = rng.uniform(-1.2, 1.2, (200, 2))
    edges = np.roll(outline, -1, axis=0) - outline
    sides = np.array([edges[:, 0] * (p[1] - outline[:, 1]) - edges[:, 1] * (p[0] - outline[:, 0]) for p in points])
    clear = np.abs(sides).min(axis=1) > 1e-9
    np.testing.assert_array_equal(inside(points, outline)[clear], (sides > 0).all(axis=1)[clear])


def test_a_lasso_round_a_bay_leaves_the_bay_out() -> None:
    outline = np.array([(0, 0), (4, 0), (4, 3), (2, 1), (0, 3)], dtype=float)
    points = np.array([(2, 0.5), (2, 2), (0.5, 2), (3.5, 2), (5, 1), (-1, 1)])
    assert inside(points, outline).tolist() == [True, False, True, True, False, False]


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("is_logarithmic", [True, False])
def test_the_plane_holds_d_where_the_values_are_in_order(dimension: int, is_logarithmic: bool) -> None:
    item = Distortion.resolve("symmetric-dirichlet")
    region = Region(-1.0, 1.0, -1.0, 1.0) if is_logarithmic else Region(0.0, 3.0, 0.0, 3.0, is_logarithmic=False)
    half = sample_plane(item, dimension, region, PlaneStyle(), 40, 40)
    whole = sample_plane(item, dimension, region, PlaneStyle(is_mirrored=True), 40, 40)
    np.testing.assert_array_equal(np.isnan(half.values), np.triu(np.ones((40, 40), bool), 1))
    np.testing.assert_array_equal(whole.values, whole.values.T)
    kept = ~np.isnan(half.values)
    np.testing.assert_array_equal(half.values[kept], whole.values[kept])
    middle = region.left + (np.array([30, 12]) + 0.5) * (region.right - region.left) / 40
    first, last = 10.0**middle if is_logarithmic else middle
    sigma = [first, last] if dimension == 2 else [first, np.sqrt(first * last), last]
    assert half.values[30, 12] == pytest.approx(sum(s**2 + s**-2 for s in sigma))


def test_level_lines_of_the_plane_lie_on_their_levels() -> None:
    item = Distortion.resolve("dirichlet")
    field = sample_plane(item, 2, Region(0.0, 4.0, 0.0, 4.0, is_logarithmic=False), PlaneStyle(False, True), 200, 200)
    values = (field.lines**2).sum(axis=2)
    assert len(field.levels) >= 4
    nearest = np.abs(values[..., None] - field.levels).min(axis=2)
    assert nearest.max() < 0.02


@pytest.mark.parametrize("id", ["amips", "arap", "volume", "condition-number", "spectral"])
@pytest.mark.parametrize("is_logarithmic", [True, False])
def test_the_scale_of_colours_is_ordered_and_shows_the_isometry(id: str, is_logarithmic: bool) -> None:
    item = Distortion.resolve(id)
    style = PlaneStyle(is_logarithmic, is_mirrored=True)
    field = sample_plane(item, 2, Region(-0.8, 0.8, -0.8, 0.8), style, 80, 80)
    assert field.low < field.high < np.inf
    shares = field.shares(np.array([field.low, field.high, np.inf, np.nan]))
    np.testing.assert_array_equal(shares, [0.0, 1.0, 1.0, np.nan])
    seen = field.shares(field.values)
    assert ((seen > 0.02) & (seen < 0.98)).mean() > 0.2, "more than one colour is to be seen"


def test_scales_without_values_are_scales() -> None:
    for is_logarithmic in (True, False):
        low, high = colour_ends(np.array([np.nan, np.inf]), is_logarithmic)
        assert low < high
        assert len(round_levels(low, high, is_logarithmic)) > 0
        assert scale_shares(np.array([low]), low, high, is_logarithmic)[0] == 0.0


def test_only_the_newest_piece_of_work_follows_the_one_under_way(qtbot: QtBot) -> None:
    latest, gate, results = Latest(), threading.Event(), []
    latest.done.connect(results.append)
    latest.ask(lambda: gate.wait(10) and 0)
    for number in range(1, 6):
        latest.ask(lambda n=number: n)
    gate.set()
    qtbot.waitUntil(lambda: len(results) == 2)
    qtbot.wait(50)
    assert results == [0, 5]
    assert not latest.is_busy


def test_a_piece_that_fails_lets_the_next_one_run(qtbot: QtBot) -> None:
    latest, results, errors = Latest(), [], []
    latest.done.connect(results.append)
    latest.failed.connect(errors.append)
    latest.ask(lambda: 1 / 0)
    latest.ask(lambda: "after")
    qtbot.waitUntil(lambda: results == ["after"])
    assert isinstance(errors[0], ZeroDivisionError)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (1.23456, "1.235"),
        ([1, 2.5], "(1, 2.5)"),
        ({"sigma": (2.0, 0.5)}, "sigma (2, 0.5)"),
        (list(range(20)), "(0, 1, 2, …, 19)"),
        (None, "None"),
        ("inf", "inf"),
    ],
)
def test_witnesses_are_written_short(value: object, text: str) -> None:
    assert written(value) == text
