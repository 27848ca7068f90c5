"""A map in the unit square is the same map in another place and size."""

from __future__ import annotations

import numpy as np
import pytest

from workbench.core.unit_square import into_unit_square


@pytest.mark.parametrize(("place", "size"), [(0.0, 1.0), (-1e6, 3.0), (5.0, 1e-7), (0.0, 1e9)])
def test_a_map_fills_its_longer_side_and_keeps_its_shape(place: float, size: float) -> None:
    positions = place + size * np.random.default_rng(3).normal(size=(40, 2)) * [1.0, 2.5]
    inside = into_unit_square(positions)
    assert inside.min() == 0.0 and inside.max() == 1.0 and (inside.min(axis=0) == 0.0).all()
    steps, before = np.diff(inside, axis=0), np.diff(positions, axis=0)
    np.testing.assert_allclose(steps, steps[0, 0] / before[0, 0] * before, rtol=1e-6)


def test_a_map_without_size_stays_finite() -> None:
    assert not into_unit_square(np.full((3, 2), 7.0)).any()
