"""Lassos, mirrors, falloff and typed numbers: geometry alone, as laws."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.path import Path
from scipy.spatial.transform import Rotation

from workbench.app.document.anchor_set import AnchorSet
from workbench.app.handling.lasso import box_outline, in_outline
from workbench.app.handling.motion import Motion
from workbench.app.handling.reflection import Reflection, Twins, fitted_reflection, found_plane, planes_of_box
from workbench.app.handling.rigid_motion import RigidMotion
from workbench.app.handling.stretch import Stretch
from workbench.app.handling.train import Train, falloff
from workbench.app.handling.typed_numbers import TypedNumbers
from workbench.app.handling.visible_points import visible_points

seeds = st.integers(0, 2**32 - 1)
outlines = st.lists(st.tuples(st.integers(0, 12), st.integers(0, 12)), min_size=3, max_size=14)


def lattice() -> np.ndarray:
    """Points off every line through two lattice points of small numbers, but for luck that the offset rules out."""
    x, y = np.meshgrid(np.arange(-1, 13) + 0.41421356, np.arange(-1, 13) + 0.14159265)
    return np.c_[x.ravel(), y.ravel()]


@given(outlines)
def test_inside_a_lasso_is_what_a_ray_leaves_an_odd_number_of_times(corners: list[tuple[int, int]]) -> None:
    points, outline = lattice(), np.array(corners, dtype=float)
    inside = in_outline(points, outline)
    np.testing.assert_array_equal(inside, in_outline(points[:, ::-1], outline[:, ::-1]), "whichever way the ray goes")
    np.testing.assert_array_equal(inside, in_outline(points, np.roll(outline[::-1], 3, axis=0)), "wherever it began")
    np.testing.assert_array_equal(inside, Path(np.vstack([outline, outline[:1]])).contains_points(points))


def test_a_loop_in_a_lasso_is_a_hole_and_a_box_is_a_lasso() -> None:
    twice = np.array([[0, 0], [9, 0], [9, 9], [0, 9], [0, 0], [3, 3], [6, 3], [6, 6], [3, 6], [3, 3]], dtype=float)
    assert in_outline(np.array([[1.0, 1.0], [4.0, 4.0], [7.0, 7.0], [10.0, 1.0]]), twice).tolist() == [True, False, True, False]
    box = box_outline(np.array([9.0, 2.0]), np.array([1.0, 5.0]))
    points = lattice()
    np.testing.assert_array_equal(in_outline(points, box), ((points > [1, 2]) & (points < [9, 5])).all(axis=1))
    assert not in_outline(points, box[:2]).any()


@given(seeds, st.integers(3, 40))
def test_a_point_is_seen_unless_some_triangle_lies_before_it(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    pixels, heights = rng.uniform(0, 100, (count, 2)), rng.normal(size=count)
    triangles = np.array([rng.choice(count, 3, replace=False) for _ in range(count)])
    candidates = np.flatnonzero(rng.random(count) < 0.7)
    expected = []
    for point in candidates.tolist():
        corners = np.concatenate([pixels[triangles], np.ones((count, 3, 1))], axis=2)
        weights = np.linalg.solve(np.swapaxes(corners, 1, 2), np.append(pixels[point], 1.0)[None, :, None])[:, :, 0]
        covers = (weights > -1e-9).all(axis=1)
        depth = (weights * heights[triangles]).sum(axis=1)
        if not (covers & (depth > heights[point] + 1e-5)).any():
            expected.append(point)
    assert visible_points(candidates, pixels, heights, triangles).tolist() == expected


@given(seeds, st.sampled_from([2, 3]))
def test_a_mirror_undoes_itself_and_keeps_distances(seed: int, d: int) -> None:
    rng = np.random.default_rng(seed)
    mirror = Reflection.across(rng.normal(size=d), rng.normal(size=d))
    points = rng.normal(size=(9, d))
    image = mirror.of(points)
    np.testing.assert_allclose(mirror.of(image), points, atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(image - image[0], axis=1), np.linalg.norm(points - points[0], axis=1), atol=1e-12)
    assert np.linalg.det(mirror.of(np.eye(d)) - mirror.of(np.zeros((1, d)))) == pytest.approx(-1.0)
    found = fitted_reflection(points, image)
    np.testing.assert_allclose(found.of(points), image, atol=1e-9)


def some_motion(rng: np.random.Generator, d: int) -> Motion:
    centre = np.zeros(3)
    centre[:d] = rng.normal(size=d)
    if rng.random() < 0.3:
        return Stretch(rng.uniform(-1, 2, 3), centre)
    shift, turn = np.zeros(3), np.zeros(3)
    shift[:d] = rng.normal(size=d)
    turn[slice(None) if d == 3 else slice(2, 3)] = rng.normal(size=3 if d == 3 else 1)
    return RigidMotion(shift, turn * (rng.random() < 0.7), centre)


@given(seeds, st.sampled_from([2, 3]))
def test_what_was_symmetric_stays_so_whatever_is_held_and_however_it_moves(seed: int, d: int) -> None:
    rng = np.random.default_rng(seed)
    mirror = Reflection.across(rng.normal(size=d), rng.normal(size=d))
    half = rng.normal(size=(6, d))
    on_it = 0.5 * (half[:2] + mirror.of(half[:2]))
    places = np.concatenate([half, mirror.of(half), on_it])
    twin = np.r_[np.arange(6, 12), np.arange(6), 12, 13]
    shares = rng.random(14) * (rng.random(14) < 0.7)
    train = Train(np.arange(14), places, shares, shares[twin], mirror)
    after = train.after(some_motion(rng, d))
    np.testing.assert_allclose(after[twin], mirror.of(after), atol=1e-9)


@given(seeds)
def test_without_company_anchors_make_the_whole_motion_and_others_their_share(seed: int) -> None:
    rng = np.random.default_rng(seed)
    motion, points = some_motion(rng, 3), rng.normal(size=(5, 3))
    anchors = AnchorSet.to(np.arange(5), points)
    np.testing.assert_array_equal(Train.of(anchors, np.arange(5)).after(motion), motion.of(points))
    parts = rng.random(5)
    each = np.concatenate([motion.part(float(part)).of(point[None]) for part, point in zip(parts, points, strict=True)])
    np.testing.assert_allclose(motion.of(points, parts), each, atol=1e-12)


@given(st.floats(1e-6, 1e6), seeds)
def test_a_falloff_goes_smoothly_from_all_to_nothing(radius: float, seed: int) -> None:
    away = np.sort(np.random.default_rng(seed).uniform(0, 2 * radius, 200))
    shares = falloff(np.concatenate([[0.0], away, [radius, np.inf]]), radius)
    assert shares[0] == 1.0 and (shares[-2:] == 0.0).all()
    assert (np.diff(shares[:-2]) <= 0.0).all() and (shares[1:-2][away >= radius] == 0.0).all()
    assert falloff(np.array([0.0, 1.0]), 0.0).tolist() == [1.0, 0.0]


@pytest.mark.parametrize("d", [2, 3])
def test_the_plane_of_a_symmetric_mesh_is_found_wherever_it_lies(d: int) -> None:
    rng = np.random.default_rng(3)
    half = rng.normal(size=(300, d)) * [3.0, 2.0, 1.0][:d] + 0.4
    half[:, 0] = np.abs(half[:, 0])
    points = np.concatenate([half, half * ([-1.0] + [1.0] * (d - 1))])
    turn = Rotation.random(rng=rng).as_matrix() if d == 3 else Rotation.from_rotvec([0, 0, 0.7]).as_matrix()[:2, :2]
    moved = points @ turn.T + rng.normal(size=d)
    plane = found_plane(moved)
    np.testing.assert_allclose(abs(plane.normal @ turn[:, 0]), 1.0, atol=1e-9)
    everyone = np.arange(600)
    assert Twins(moved, plane).of(everyone).tolist() == np.roll(everyone, 300).tolist()
    assert list(planes_of_box(moved)) == list("xyz"[:d])


def test_a_vertex_far_from_any_mirror_image_has_no_twin() -> None:
    x, y = np.meshgrid(np.arange(-5.0, 6.0), np.arange(4.0))
    points = np.c_[x.ravel(), y.ravel()]
    points = points[~((points[:, 0] < -2) & (points[:, 1] > 1))]
    twins = Twins(points, Reflection.across(np.array([1.0, 0.0]), np.zeros(2))).of(np.arange(len(points)))
    lonely = (points[:, 0] > 2) & (points[:, 1] > 1)
    np.testing.assert_array_equal(twins < 0, lonely)
    np.testing.assert_allclose(points[twins[~lonely]], points[~lonely] * [-1.0, 1.0])


@given(st.floats(-1e4, 1e4, allow_nan=False).map(lambda value: f"{value:.3f}"), st.sampled_from(".,"))
def test_a_typed_number_is_what_it_says(text: str, point: str) -> None:
    typed = TypedNumbers(1)
    for character in text.replace(".", point):
        assert typed.type(character)
    assert typed.values == [float(text)]
    typed.type("-")
    assert typed.values == [-float(text)]
    for _ in range(len(text) + 2):
        typed.delete()
    assert typed.is_empty and typed.values == [None]


def test_numbers_of_three_axes_are_typed_one_after_another() -> None:
    typed = TypedNumbers(3)
    for character in "1.5":
        typed.type(character)
    typed.next()
    typed.next()
    typed.type("-")
    assert typed.values == [1.5, None, None], "a sign alone is no number"
    typed.type("2")
    assert typed.values == [1.5, None, -2.0]
    assert typed.words(["x", "y", "z"]) == "x 1.5, y 0, z -2|"
    assert not typed.type("e") and not typed.type("") and not typed.type("٣")
    for character in itertools.repeat("9", 40):
        typed.type(character)
    assert len(typed.words(["x", "y", "z"])) < 40
