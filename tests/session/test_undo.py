"""Undoing everything and doing it again changes nothing, to the last bit."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from workbench.session.kept_map import KeptMap
from workbench.session.undo import UndoHistory

AMPLE = 10**9
POINTS = 7


class Figure:
    """A stand-in for the window: choices and a map, and what a user may do to them."""

    def __init__(self, limit: int = AMPLE) -> None:
        self.history: UndoHistory[tuple[int, ...]] = UndoHistory(limit)
        self.choices: tuple[int, ...] = ()
        self.positions = np.zeros((POINTS, 2))

    @property
    def now(self) -> tuple[tuple[int, ...], bytes]:
        return self.choices, self.positions.tobytes()

    def do(self, value: int) -> None:
        self.history.begin_step(f"Choose {value}", self.choices, self.positions)
        self.choices = (*self.choices, value)

    def solve(self, seed: int) -> None:
        """The map goes on by itself, without any step of the user's."""
        self.positions = np.random.default_rng(seed).normal(size=(POINTS, 2)) * 10.0 ** (seed % 7 - 3)

    def go_to(self, done: int) -> None:
        found = self.history.go_to(done, self.choices, self.positions)
        self.choices = found.choices
        self.positions = found.positions

    def go(self, by: int) -> None:
        done = self.history.done + by
        if 0 <= done <= len(self.history.names):
            self.go_to(done)


ACTIONS = st.one_of(
    st.tuples(st.just("do"), st.integers(0, 9)),
    st.tuples(st.just("solve"), st.integers(0, 99)),
    st.tuples(st.just("go"), st.integers(-3, 3)),
    st.tuples(st.just("pack"), st.just(0)),
)


@settings(max_examples=200)
@given(st.lists(ACTIONS, max_size=40))
def test_undo_all_and_redo_all_gives_the_same_to_the_last_bit(actions: list[tuple[str, int]]) -> None:
    figure = Figure()
    for name, value in actions:
        if name == "pack":
            figure.history.pack()
        else:
            getattr(figure, name)(value)
    figure.go_to(len(figure.history.names))
    after = figure.now
    seen = []
    while figure.history.undo_name:
        figure.go(-1)
        seen.append(figure.now)
    assert figure.now[0] == ()
    figure.history.pack()
    for known in reversed(seen):
        assert figure.now == known
        figure.go(1)
    assert figure.now == after
    assert not figure.history.redo_name


def test_a_new_step_forgets_those_that_were_undone() -> None:
    figure = Figure()
    for value in range(3):
        figure.do(value)
    figure.go(-2)
    figure.do(7)
    assert figure.history.names == ("Choose 0", "Choose 7") and not figure.history.redo_name
    figure.go(-1)
    assert figure.choices == (0,)


def test_a_map_that_went_on_is_undone_to_where_it_was_before_the_step() -> None:
    figure = Figure()
    figure.solve(1)
    before = figure.now
    figure.do(1)
    figure.solve(2)
    after = figure.now
    figure.go(-1)
    assert figure.now == before
    figure.solve(3)  # the solver goes on after an undo: redo still leads to what was there
    figure.go(1)
    assert figure.now == after


def test_a_step_that_came_to_nothing_is_forgotten() -> None:
    figure = Figure()
    figure.do(1)
    figure.do(2)
    figure.history.forget_last()
    assert figure.history.names == ("Choose 1",) and figure.history.done == 1


def test_memory_stays_within_its_limit_and_newest_steps_stay_exact() -> None:
    size = 16 * POINTS
    figure = Figure(limit=10 * size)
    for value in range(60):
        figure.do(value)
        figure.solve(value)
        figure.history.trim()
        assert figure.history.byte_count <= 10 * size
    assert 5 <= len(figure.history.names) < 60
    before = figure.now
    figure.go(-1)
    figure.go(1)
    assert figure.now == before
    while figure.history.undo_name:
        figure.go(-1)
    assert len(figure.choices) > 40, "the oldest steps are gone"


def test_a_map_is_rounded_only_where_that_is_allowed() -> None:
    maps = np.random.default_rng(0).normal(size=(2, 1000, 2))
    for allowed in (True, False):
        history: UndoHistory[int] = UndoHistory(int(1.6 * maps[0].nbytes), lambda positions, answer=allowed: answer)
        for step, positions in enumerate(maps):
            history.begin_step("step", step, positions)
        history.trim()
        assert len(history.names) == (2 if allowed else 1), "else it is forgotten"
        found = history.go_to(0, 2, None).positions
        np.testing.assert_array_equal(found, maps[0].astype(np.float32) if allowed else maps[1])


@pytest.mark.parametrize("seed", range(3))
def test_packing_loses_nothing(seed: int) -> None:
    positions = np.random.default_rng(seed).normal(size=(100, 3)) * 10.0 ** (50 * seed)
    kept = KeptMap(positions)
    kept.pack()
    np.testing.assert_array_equal(kept.positions(), positions)
    smooth = KeptMap(np.linspace(0, 1, 30_000).reshape(-1, 3))
    before = smooth.byte_count
    smooth.pack()
    assert smooth.byte_count < 0.85 * before


def test_choices_that_weigh_count_towards_the_limit() -> None:
    history: UndoHistory[str] = UndoHistory(100, weigh=lambda choices: sum(map(len, choices)))
    for name in range(12):
        history.begin_step(str(name), "x" * 30, None)
    history.trim()
    assert history.byte_count <= 100
    assert history.names == tuple(str(name) for name in range(9, 12))
    assert history.done == 3
