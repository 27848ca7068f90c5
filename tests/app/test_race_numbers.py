"""What the race computes from rows and maps: errors, verdicts, differences."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from workbench.app.race.difference import aligned, displacements
from workbench.app.race.draft import Draft
from workbench.app.race.race_record import RaceRecord, relative_errors, verdict
from workbench.core.mesh import Mesh
from workbench.engine.messages import SetAnchors, SetProblem
from workbench.engine.race_messages import Entrant, RaceFrame
from workbench.engine.racer import Marker, RaceRow

NO_ANCHORS = SetAnchors(np.empty(0, np.int64), np.empty((0, 2)), np.empty(0))


def row(iteration: int, energy: float, anchor_error: float = 0.0) -> RaceRow:
    return RaceRow(iteration, 0.1 * iteration, energy, energy, 1.0, 1.0, 0, anchor_error, 0, 0, 0, 0, 0)


def record_of(rows: list[RaceRow], terms: list[int]) -> RaceRecord:
    made = RaceRecord(Entrant("a", "aqp"), SetProblem(), NO_ANCHORS)
    markers: tuple[Marker, ...] = ()
    made.take(RaceFrame(1, 0, 1, 0, 0.0, tuple(rows), tuple(terms), markers, "running", "RUNNING", "", 0))
    return made


def test_errors_are_relative_to_the_best_of_the_same_energy(square: Mesh) -> None:
    first = record_of([row(0, 1.0, anchor_error=0.5), row(1, 8.0), row(2, 4.0), row(3, 100.0)], [0, 0, 0, 1])
    second = record_of([row(0, 5.0), row(1, np.inf)], [0, 0])
    errors = relative_errors([first, second], square, 1.0)
    np.testing.assert_allclose(errors[0], [np.nan, 1.0, 0.0, 0.0])  # an anchor that lags is no map to be best
    np.testing.assert_allclose(errors[1], [0.25, np.inf])


def test_the_verdict_is_on_maps_that_hold_their_anchors_and_one_energy(square: Mesh) -> None:
    low, high = record_of([row(0, 9.0), row(1, 4.0)], [0, 0]), record_of([row(0, 9.0), row(1, 5.0)], [0, 0])
    low.label, high.label = "low", "high"
    lags, other = record_of([row(0, 1.0, anchor_error=0.5)], [0]), record_of([row(0, 0.1)], [1])
    assert verdict([high, low, lags], square).startswith("Over. low came lowest: mean distortion 4, after 1 iteration ")
    assert "nobody is first" in verdict([low, other], square)
    assert "Nobody" in verdict([lags, lags], square)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_motion_is_no_difference(dimension: int) -> None:
    random = np.random.default_rng(3)
    points = random.normal(size=(40, dimension))
    turn, _ = np.linalg.qr(random.normal(size=(dimension, dimension)))
    turn[:, 0] *= np.sign(np.linalg.det(turn))
    moved = points @ turn.T + np.arange(1.0, dimension + 1.0)
    np.testing.assert_allclose(aligned(moved, points), points, atol=1e-12)
    mirrored = points * np.array([-1.0, *[1.0] * (dimension - 1)])
    assert np.abs(aligned(mirrored, points) - points).max() > 0.1
    corners = np.arange(dimension + 1)[None]
    away = np.zeros(dimension)
    away[-1] = 2.0
    assert displacements(points + away, points, corners) == pytest.approx([2.0])


def test_a_draft_knows_what_it_becomes() -> None:
    entrant: Callable[[], Entrant] = Draft("a", "aqp", {"eta": 50.0}).entrant
    assert (entrant().label, entrant().solver, entrant().parameters) == ("a", "aqp", {"eta": 50.0})
