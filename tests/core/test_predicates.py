"""Signs and meetings against fractions."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from workbench.core.predicates import orientation, orientation_3d, rays_coincide, segments_meet
from workbench.core.segment_pairs import box_pairs

# small integers make coincidences, tiny steps make doubtful signs, wide ranges make underflow
COORDINATE = st.one_of(
    st.integers(-3, 3).map(float),
    st.integers(-4, 4).map(lambda k: 0.5 + k * 2.0**-53),
    st.floats(-1e100, 1e100, allow_nan=False),
    st.floats(-1e-150, 1e-150, allow_nan=False),
)
POINT = st.tuples(COORDINATE, COORDINATE)
POINT_3D = st.tuples(COORDINATE, COORDINATE, COORDINATE)


def cross(a: tuple, b: tuple, c: tuple) -> Fraction:
    (ax, ay), (bx, by), (cx, cy) = (tuple(map(Fraction, p)) for p in (a, b, c))
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)


def rows(*points: tuple) -> list[np.ndarray]:
    return [np.array([p]) for p in points]


@given(POINT, POINT, POINT)
@settings(max_examples=400)
def test_orientation_is_the_sign_of_the_exact_area(a: tuple, b: tuple, c: tuple) -> None:
    exact = cross(a, b, c)
    assert orientation(*rows(a, b, c))[0] == (exact > 0) - (exact < 0)


@given(POINT_3D, POINT_3D, POINT_3D, POINT_3D)
@settings(max_examples=200)
def test_orientation_in_space_is_the_sign_of_the_exact_determinant(a: tuple, b: tuple, c: tuple, d: tuple) -> None:
    u, v, w = ([Fraction(x) - Fraction(y) for x, y in zip(p, a, strict=True)] for p in (b, c, d))
    n = [v[i - 2] * w[i - 1] - v[i - 1] * w[i - 2] for i in range(3)]
    exact = sum(x * y for x, y in zip(u, n, strict=True))
    assert orientation_3d(*rows(a, b, c, d))[0] == (exact > 0) - (exact < 0)


def meet_by_fractions(a: tuple, b: tuple, c: tuple, d: tuple) -> bool:
    """Whether a point of one segment lies on the other: ends on segments, or a proper crossing."""

    def on(p: tuple, q: tuple, r: tuple) -> bool:
        between = all(min(q[i], r[i]) <= p[i] <= max(q[i], r[i]) for i in (0, 1))
        return between and cross(q, r, p) == 0

    if on(a, c, d) or on(b, c, d) or on(c, a, b) or on(d, a, b):
        return True
    return cross(a, b, c) * cross(a, b, d) < 0 and cross(c, d, a) * cross(c, d, b) < 0


@given(POINT, POINT, POINT, POINT)
@settings(max_examples=400)
def test_segments_meet_as_in_fractions(a: tuple, b: tuple, c: tuple, d: tuple) -> None:
    expected = meet_by_fractions(a, b, c, d)
    assert segments_meet(*rows(a, b, c, d))[0] == expected
    assert segments_meet(*rows(d, c, a, b))[0] == expected


@given(st.lists(st.tuples(POINT, POINT), min_size=2, max_size=12))
@settings(max_examples=100)
def test_the_sweep_misses_no_pair_that_meets(segments: list) -> None:
    starts, ends = (np.array([s[i] for s in segments]) for i in (0, 1))
    found = {tuple(pair) for pair in box_pairs(starts, ends).tolist()}
    for i in range(len(segments)):
        for j in range(i + 1, len(segments)):
            if meet_by_fractions(*segments[i], *segments[j]):
                assert (i, j) in found


def test_rays_coincide_only_in_the_same_direction() -> None:
    origin = np.zeros((4, 2))
    first = np.array([(1.0, 2.0)] * 4)
    second = np.array([(2.0, 4.0), (-1.0, -2.0), (2.0, np.nextafter(4.0, 5.0)), (0.5, 1.0)])
    assert rays_coincide(origin, first, second).tolist() == [True, False, False, True]
