"""Undo and redo bring the convergence curves of their moment back, and the run goes on from their last row."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.app.fake_engine import let_reports_arrive
from tests.app.loop_worker import LoopWorker, garbage_of_this_thread
from workbench.app.document.document import Document
from workbench.app.document.engine_bridge import EngineBridge
from workbench.app.document.history import COLUMNS, History
from workbench.app.document.run_curves import RunCurves, begin_of_run, rows_after
from workbench.app.document.switches import Switches
from workbench.app.sessions.undoing import Undoing, chosen_bytes
from workbench.engine.messages import HistoryRow, Refused


class Room:
    """A document on the engine, its history of steps and of rows, and no window."""

    def __init__(self) -> None:
        self.bridge = EngineBridge(LoopWorker)
        self.document = Document(self.bridge)
        self.undoing = Undoing(self.document)
        self.history = History()
        self.switches = Switches(self.document, self.history)
        self.curves = RunCurves(self.document, self.history, self.switches)
        self.undoing.curves = self.curves.kept
        self.document.open("sample:bar")
        let_reports_arrive()
        free = self.document.anchors
        self.document.set_anchors(free.with_target(60, self.document.positions[60] + [0.3, 0.4]))
        let_reports_arrive()

    @property
    def rows(self) -> list[tuple[float, ...]]:
        return list(zip(*(self.history.column(name).tolist() for name in COLUMNS), strict=True))

    @property
    def now(self) -> tuple[object, ...]:
        assert self.document.positions is not None
        return self.rows, list(self.switches), self.document.session, self.document.positions.tobytes()

    def steps(self, count: int) -> None:
        for _ in range(count):
            self.document.step()

    def end(self) -> None:
        self.undoing.wait()
        let_reports_arrive()
        self.document.deleteLater()


@pytest.fixture(autouse=True)
def collected_here(qapp: object):  # type: ignore[no-untyped-def]
    with garbage_of_this_thread():
        yield


@pytest.fixture
def room(qapp: object):  # type: ignore[no-untyped-def]
    room = Room()
    yield room
    room.end()


def step(room: Room, value: int) -> None:
    room.undoing._changed_at = 0.0  # as after a pause: another step of the history
    room.steps(1 + value)


def anchor(room: Room, value: int) -> None:
    room.document.add_anchor(9 * value)


def choose(room: Room, value: int) -> None:
    room.document.choose(solver=("slim", "l-bfgs", "projected-newton")[value % 3], solver_parameters={})


def reset(room: Room, value: int) -> None:
    room.document.reset()


DEEDS = st.tuples(st.sampled_from((step, step, anchor, choose, reset)), st.integers(0, 4))


@settings(max_examples=4, suppress_health_check=[HealthCheck.too_slow])
@given(st.lists(DEEDS, min_size=2, max_size=6), st.lists(st.integers(0, 6), min_size=2, max_size=6))
def test_every_moment_has_its_curves_again(qapp: object, deeds: list, visits: list[int]) -> None:
    room = Room()
    history = room.undoing.history
    moments = {history.done: room.now}
    for deed, value in deeds:
        deed(room, value)
        let_reports_arrive()
        moments[history.done] = room.now
    for visit in (*visits, max(moments)):
        place = min(moments, key=lambda done: (abs(done - visit), done))
        room.undoing.go_to(place)
        let_reports_arrive()
        assert room.now == moments[place]
    room.end()


def test_a_run_goes_on_where_the_curves_end(room: Room) -> None:
    step(room, 5)
    let_reports_arrive()
    step(room, 3)
    let_reports_arrive()
    iterations = room.history.column("iteration").tolist()
    assert max(iterations) == 10 and room.undoing.history.names[-2:] == ("Step", "Step")
    room.undoing.undo()
    let_reports_arrive()
    assert room.history.column("iteration")[-1] == 6
    before = room.rows
    room.document.choose(solver="slim")
    room.steps(2)
    let_reports_arrive()
    assert room.rows[: len(before)] == before
    assert np.unique(room.history.column("iteration")[len(before) - 1 :]).tolist() == [6, 7, 8]
    assert (np.diff(room.history.column("seconds")) >= 0).all(), "on one clock"
    assert [switch.iteration for switch in room.switches] == [6]


def test_what_was_under_way_does_not_come_into_the_curves(room: Room) -> None:
    """Nobody reads reports between the steps and the undo: their rows come with the map that is brought back."""
    before = room.now
    step(room, 4)
    room.undoing.undo()
    assert room.now == before, "at once, before the engine has answered"
    let_reports_arrive()
    assert room.now == before
    room.undoing.redo()
    let_reports_arrive()
    step(room, 2)
    room.document.reset()
    let_reports_arrive()
    assert room.history.column("iteration").max() == 0, "a start made anew begins with its own rows"


def test_another_start_leaves_no_row_of_the_one_before(room: Room) -> None:
    """Nobody reads reports between the two starts."""
    steps = (room.document.reset, lambda: room.document.choose(initializer="harmonic"), room.document.reset)
    for make in steps:
        make()
    let_reports_arrive()
    assert room.history.column("iteration").tolist() == [0.0]
    assert room.history.column("energy")[0] == room.document.snapshot.row.energy  # type: ignore[union-attr]


def test_going_to_and_fro_at_once_loses_no_map(room: Room) -> None:
    step(room, 4)
    let_reports_arrive()
    end = room.now
    room.undoing.undo()
    let_reports_arrive()
    room.undoing.redo()
    room.undoing.undo()  # before the newest map has come
    room.undoing.redo()
    let_reports_arrive()
    assert room.now == end


def test_a_moment_that_is_refused_hides_no_map(room: Room) -> None:
    step(room, 1)
    let_reports_arrive()
    room.undoing.undo()
    serial = room.document.anchor_serial
    room.bridge.refused.emit(Refused(room.document.generation, "TakeUp", "It does not suit.", serial=serial))
    let_reports_arrive()
    assert room.document._taken_up is None
    room.steps(2)
    let_reports_arrive()
    assert room.history.column("iteration").max() >= 2


def test_moments_share_the_rows_that_they_keep() -> None:
    history = History()
    row = HistoryRow(0, 0.0, 5.0, 1.0, 0.5, 1.0, 0, 0.0)
    kept = []
    for number in range(200):
        history.extend([replace(row, iteration=number, energy=5.0 - 0.01 * number)])
        kept.append(history.kept())
    assert len({id(curves.table) for curves in kept}) == 1, "a moment costs no copy"
    history.go_back(kept[50])
    history.extend([replace(row, iteration=51, energy=9.0)])
    assert kept[199].table[COLUMNS.index("energy"), 51] == 5.0 - 0.01 * 51, "what followed then is still there"
    assert (kept[50].iteration, kept[-1].iteration, len(history)) == (50, 199, 52)
    history.clear()
    history.extend([replace(row, energy=7.0)])
    assert kept[0].table[COLUMNS.index("energy"), 0] == 5.0


def test_rows_of_before_are_told_from_those_after() -> None:
    row = HistoryRow(0, 0.0, 5.0, 1.0, 0.5, 1.0, 0, 0.0)
    rows = [replace(row, iteration=i, seconds=s) for i, s in ((7, 0.7), (8, 0.8), (3, 0.3), (4, 0.4))]
    assert rows_after(rows, 3, 0.3) == rows[3:] and rows_after(rows, 9, 0.9) == rows
    assert begin_of_run(rows) == -1 and begin_of_run([row]) == 0
    assert begin_of_run([*rows, row, rows[3], row, replace(row, energy=4.0), rows[3]]) == 7


def test_curves_count_in_what_undoing_may_take(room: Room) -> None:
    step(room, 3)
    moments = [moment.choices for moment in room.undoing.history._moments()]
    tables = {id(moment.curves.table): moment.curves.table.nbytes for moment in moments if moment.curves is not None}
    bare = [replace(moment, curves=None) for moment in moments]
    assert tables and chosen_bytes(moments) == chosen_bytes(bare) + sum(tables.values())
