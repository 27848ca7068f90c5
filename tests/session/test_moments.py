"""The record of maps: what stays, what goes, and that it stays within its memory."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from workbench.session import moments
from workbench.session.moments import EXACT, LONGEST_GAP, MomentRecord

COUNT = 200
NONE = np.zeros(4 * COUNT, dtype=bool)


def filled(limit: int, count: int, step: float = 0.02, noted: tuple[int, ...] = ()) -> MomentRecord:
    record = MomentRecord(limit)
    for number in range(count):
        record.add(np.full((COUNT, 2), number + 0.1), NONE, number * step, iteration=number)
        if number in noted:
            record.note(f"note {number}")
    return record


def iterations(record: MomentRecord) -> list[int]:
    return [moment.iteration for moment in record]


def test_everything_is_kept_while_there_is_room() -> None:
    record = filled(10**9, 100)
    assert iterations(record) == list(range(100))
    assert all(np.allclose(moment.positions, moment.iteration + 0.1, rtol=1e-6) for moment in record)


def test_the_newest_and_those_with_notes_are_exact() -> None:
    record = filled(10**9, 100, noted=(7, 30))
    exact = {moment.iteration for moment in record if moment.is_exact}
    assert exact == {7, 30} | set(range(100 - EXACT, 100))
    assert record[7].positions[0, 0] == 7.1
    assert record[8].positions[0, 0] == np.float32(8.1)


@given(st.lists(st.tuples(st.floats(1e-4, 3.0), st.booleans()), min_size=1, max_size=300), st.integers(8, 60))
@settings(max_examples=40)
def test_memory_is_never_exceeded_and_the_order_is_that_of_time(steps: list[tuple[float, bool]], room: int) -> None:
    limit = room * COUNT * 16
    record, now = MomentRecord(limit), 0.0
    for number, (step, is_noted) in enumerate(steps):
        now += step
        record.add(np.full((COUNT, 2), float(number)), NONE, now, iteration=number)
        if is_noted:
            record.note("something")
        assert record.byte_count <= limit
    assert record.byte_count == sum(moment.byte_count for moment in record)
    times = list(record.times)
    assert times == sorted(set(times))
    assert times == [moment.time for moment in record]
    assert iterations(record)[0] == 0
    assert iterations(record)[-1] == len(steps) - 1
    assert record[-1].positions[0, 0] == len(steps) - 1


def test_thinning_forgets_no_stretch_of_time_and_keeps_the_newest_dense() -> None:
    """Of an hour at 25 maps a second in a hundredth of its memory: gaps grow with the age, and only with it."""
    step, count = 0.04, 20_000
    record = filled(200 * COUNT * 8, count, step)
    times = np.array(record.times)
    gaps, ages = np.diff(times), times[-1] - times[:-1]
    assert len(record) > 100
    assert times[0] == 0.0
    assert gaps.max() < 0.12 * times[-1]
    assert np.all(gaps <= np.maximum(0.25 * (ages + moments.FRESH), 2.1 * step))
    newest = gaps[ages < 1.0]
    assert len(newest) and newest.max() < 1.0


def test_notes_outlive_their_neighbours() -> None:
    noted = (100, 500, 900)
    record = filled(60 * COUNT * 8, 3000, noted=noted)
    assert set(noted) <= set(iterations(record))
    for moment in record:
        if moment.iteration in noted:
            assert moment.notes == [f"note {moment.iteration}"]
            assert moment.positions[0, 0] == moment.iteration + 0.1


def test_notes_alone_do_not_break_the_limit() -> None:
    record = filled(30 * COUNT * 16, 500, noted=tuple(range(500)))
    assert record.byte_count <= record.limit
    assert len(record) > 20


def test_small_maps_are_counted_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(moments, "MOST", 50)
    assert len(filled(10**9, 400)) <= 50


def test_rest_takes_no_room() -> None:
    record = MomentRecord()
    for now in (0.0, 0.1, 100.0, 100.1, 5000.0):
        record.add(np.zeros((COUNT, 2)), NONE, now)
    assert record.end == pytest.approx(0.2 + 2 * LONGEST_GAP)


def test_inversions_are_those_of_the_exact_map() -> None:
    record = MomentRecord()
    random = np.random.default_rng(3)
    masks = [random.random(4 * COUNT) < share for share in (0.0, 0.01, 0.5, 1.0)] * 20
    for number, mask in enumerate(masks):
        record.add(random.random((COUNT, 2)), mask, 0.1 * number)
    for moment, mask in zip(record, masks, strict=True):
        assert np.array_equal(moment.inverted, mask)
        assert moment.inverted_count == mask.sum()


@given(st.floats(-1.0, 30.0))
@settings(max_examples=50)
def test_the_nearest_moment_is_found(time: float) -> None:
    record = filled(10**9, 40, step=0.3)
    assert abs(record[record.at(time)].time - time) == pytest.approx(min(abs(t - time) for t in record.times), abs=1e-12)


def test_a_smaller_limit_thins_at_once() -> None:
    record = filled(10**9, 300)
    record.set_limit(40 * COUNT * 8)
    assert record.byte_count <= record.limit
    assert iterations(record)[0] == 0
    assert iterations(record)[-1] == 299
