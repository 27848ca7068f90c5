"""Sessions in the window: saved, opened, undone, kept through a crash; nothing is lost unasked."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QCoreApplication, QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QMessageBox
from pytestqt.qtbot import QtBot

from tests.app.conftest import Hand, WindowMaker, pixel_of
from tests.app.fake_engine import FakeWorker, grid_mesh
from tests.app.loop_worker import garbage_of_this_thread
from tests.app.session_hand import mesh_file, wait_for_desk
from workbench.app.document.document import Document
from workbench.app.document.engine_bridge import EngineBridge, engine_worker
from workbench.app.main_window import MainWindow
from workbench.app.sessions.session_desk import Found
from workbench.app.sessions.undoing import Undoing
from workbench.cli import main
from workbench.engine.messages import Refused
from workbench.engine.session_file import read_session, source_trouble, write_session
from workbench.session.record import SessionRecord
from workbench.session.session import Session

# ---------------------------------------------------------------------------------------------- undo


class Desk:
    """A document on the fake engine, without a window, and its history."""

    def __init__(self) -> None:
        self.document = Document(EngineBridge(FakeWorker))
        self.undoing = Undoing(self.document)
        self.document.open("grid")
        self.settle()

    def settle(self) -> None:
        """Let reports arrive; they are taken at most once in 12 ms."""
        for _ in range(2):
            QCoreApplication.processEvents()
            time.sleep(0.013)
        QCoreApplication.processEvents()

    @property
    def now(self) -> tuple[object, ...]:
        document = self.document
        return document.session, document.anchors, document.positions.tobytes()

    def end(self) -> None:
        self.undoing.wait()
        self.settle()
        self.document.deleteLater()


@pytest.fixture
def collected_here(qapp: object) -> Iterator[None]:
    with garbage_of_this_thread():
        yield


@pytest.fixture
def desk(collected_here: None) -> Iterator[Desk]:
    desk = Desk()
    yield desk
    desk.end()


def anchor(desk: Desk, value: int) -> None:
    desk.document.add_anchor(value * 7)


def drag(desk: Desk, value: int) -> None:
    document = desk.document
    if len(document.anchors):
        vertex = int(document.anchors.vertices[value % len(document.anchors)])
        target = np.array(document.anchors.targets[vertex])
        for step in range(1, 4):
            document.move_anchor(vertex, target + 0.01 * step * (value + 1), dragging=step < 3)


def test_a_drag_is_one_step_and_one_that_is_taken_back_is_none(desk: Desk) -> None:
    anchor(desk, 3)
    desk.settle()
    drag(desk, 1)
    desk.settle()
    assert desk.undoing.history.names == ("Set anchor", "Move anchor")
    vertex = 21
    target = np.array(desk.document.anchors.targets[vertex])
    desk.document.move_anchor(vertex, target, True)  # taken up, and not moved yet
    desk.document.move_anchor(vertex, target + 1.0, True)
    assert desk.undoing.history.names[-2:] == ("Move anchor", "Move anchor")
    desk.document.move_anchor(vertex, target, False)
    assert desk.undoing.history.names == ("Set anchor", "Move anchor")


def test_drawing_a_slider_is_one_step_named_by_its_last_value(desk: Desk) -> None:
    formula = "t*arap + mips"
    for value in (1.0, 2.0, 3.0):
        desk.document.choose(distortion=formula, distortion_parameters={"t": value})
        desk.settle()
    assert desk.undoing.history.names == ("t*arap + mips, t = 1", "t = 3")
    desk.undoing.undo()
    assert desk.document.session.distortion_parameters == {"t": 1.0}
    desk.undoing.undo()
    assert desk.document.session.distortion == "symmetric-dirichlet"


def test_undo_goes_back_to_the_mesh_before(desk: Desk) -> None:
    anchor(desk, 2)
    desk.settle()
    before = desk.now
    desk.document.open("bumpy")
    desk.settle()
    assert desk.document.kind == "parameterize" and desk.undoing.history.undo_name == "Open bumpy"
    desk.undoing.undo()
    desk.settle()
    desk.settle()
    assert desk.now == before and desk.document.kind == "plane"


def test_a_moment_whose_mesh_is_gone_is_not_gone_to(desk: Desk) -> None:
    document = desk.document
    document.open("closed", fixes=("cut",))
    desk.settle()
    document.open("grid")
    desk.settle()
    names, done = desk.undoing.history.names, desk.undoing.history.done
    desk.undoing.history.last.choices.session.__dict__["fixes"] = ()  # as if the file were another one now
    now = desk.now
    desk.undoing.undo()
    desk.settle()
    desk.settle()
    assert desk.now == now and (desk.undoing.history.names, desk.undoing.history.done) == (names, done)


def test_a_run_is_undone_to_the_map_before_it(desk: Desk) -> None:
    desk.document.step()
    desk.settle()
    before = desk.now
    desk.document.run()
    desk.settle()
    desk.undoing.undo()
    desk.settle()
    assert desk.now == before and not desk.document.wants_to_run
    desk.undoing.redo()
    desk.settle()
    assert desk.document.wants_to_run


def test_keys_menu_and_list_undo(window: MainWindow, qtbot: QtBot) -> None:
    document = window.document
    count = window.undoing.history.done  # the window is shared by the tests of this file
    document.add_anchor(30)
    document.add_anchor(60)
    QTest.qWait(30)
    assert window.actions_by_name["undo"].text() == "Undo set anchor"
    QTest.keyClick(window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier)
    assert 60 not in document.anchors and 30 in document.anchors
    QTest.qWait(30)
    QTest.keyClick(window, Qt.Key.Key_Z, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier)
    assert 60 in document.anchors
    window.steps.list.itemClicked.emit(window.steps.list.item(count))
    assert not len(document.anchors) and window.actions_by_name["redo"].text() == "Redo set anchor"
    assert window.actions_by_name["undo"].isEnabled() is (count > 0)


# ---------------------------------------------------------------------------------------------- files


def test_the_title_marks_what_is_not_saved_and_a_session_comes_back(
    make_window: WindowMaker, qtbot: QtBot, tmp_path: Path
) -> None:
    window = make_window(source=str(mesh_file(tmp_path)))
    document = window.document
    qtbot.waitUntil(lambda: document.positions is not None)
    assert not window.isWindowModified()
    document.add_anchor(3)
    document.add_anchor(9)
    document.move_anchor(9, np.array([1.0, 2.0]), False)
    QTest.qWait(30)
    assert window.isWindowModified()
    path = tmp_path / "mine.dwb"
    window.sessions.save_to(str(path))
    wait_for_desk(window, qtbot)
    assert not window.isWindowModified() and "mine.dwb" in window.windowTitle()
    assert window.settings.recent_sessions == [str(path)]
    session, positions = document.complete_session, document.positions
    document.clear_anchors()
    document.choose(distortion="mips")
    assert window.isWindowModified()
    window.open(str(path))
    wait_for_desk(window, qtbot)
    qtbot.waitUntil(lambda: not document.opening_source and np.array_equal(document.positions, positions))
    assert document.complete_session == session
    assert not window.isWindowModified()
    assert "Reading" not in window.status.sentence.text(), "where its mesh needs no reading, nothing else says that it is open"
    window.undoing.undo()
    assert document.session.distortion == "mips" and not len(document.anchors)
    window.undoing.redo()
    assert document.complete_session == session
    window.sessions.save()
    wait_for_desk(window, qtbot)
    assert not window.isWindowModified()


def test_a_missing_mesh_is_asked_for(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    path = tmp_path / "lost.json"
    path.write_text('{"format": "distortion-workbench session", "version": 1, "source": {"path": "gone.obj"}}')
    window.sessions.open(str(path))
    wait_for_desk(window, qtbot)
    box = window.findChild(QMessageBox)
    assert box is not None and "gone.obj" in box.text()
    assert window.document.session.source == "grid"
    box.reject()
    QTest.qWait(20)


def opened_in(window: MainWindow, qtbot: QtBot, path: Path) -> None:
    window.open(str(path))
    wait_for_desk(window, qtbot)
    qtbot.waitUntil(lambda: not window.document.opening_source and window.document.positions is not None)
    QTest.qWait(30)


def test_a_session_on_another_mesh_than_it_names_is_not_as_its_file_has_it(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    desk, path = window.sessions.desk, tmp_path / "mine.dwb"
    write_session(path, SessionRecord(Session(source=str(mesh_file(tmp_path))), "0" * 64, grid_mesh().vertices))
    found = Found(str(path), read_session(path), source_trouble(read_session(path)))
    assert "another" in found.trouble
    desk.open(found)
    qtbot.waitUntil(lambda: desk.path == str(path))
    assert window.isWindowModified(), "it is used as it is, and the file has another sha256"
    other = tmp_path / "moved" / "grid.obj"
    other.parent.mkdir()
    other.write_text("v 0 0 0\n")
    desk.open(found, str(other))
    qtbot.waitUntil(lambda: window.document.session.source == str(other) and not window.document.opening_source)
    assert desk.path == str(path) and window.isWindowModified()


def test_a_session_that_does_not_fit_its_mesh_leaves_its_file_alone(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    path = tmp_path / "mine.dwb"
    write_session(path, SessionRecord(Session(source=str(mesh_file(tmp_path))), map=np.zeros((7, 2))))
    opened_in(window, qtbot, path)
    assert window.error_bar.isVisible() and window.sessions.desk.path == "", "Ctrl+S would take its place"


@pytest.mark.parametrize("has_map", [True, False])
@pytest.mark.parametrize(
    "anchors",
    [
        {"anchor_vertices": (0,), "anchor_targets": ((0.0, 0.0, 0.0),)},
        {"anchor_vertices": (10**9,), "anchor_targets": ((0.0, 0.0),)},
    ],
    ids=["in space", "beyond the mesh"],
)
def test_anchors_that_are_not_of_the_mesh_never_come_to_the_views(
    window: MainWindow, qtbot: QtBot, tmp_path: Path, anchors: dict, has_map: bool
) -> None:
    session = Session(source=str(mesh_file(tmp_path)), **anchors)
    opened_in(window, qtbot, tmp_path / "grid.obj")
    write_session(tmp_path / "mine.dwb", SessionRecord(session, map=grid_mesh().vertices if has_map else None))
    opened_in(window, qtbot, tmp_path / "mine.dwb")
    assert window.error_bar.isVisible() and not len(window.document.anchors) and window.sessions.desk.path == ""


def test_a_session_whose_mesh_is_refused_gives_its_name_to_no_other(window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    closed = tmp_path / "closed.obj"
    closed.write_text("v 0 0 0\n")
    path = tmp_path / "mine.dwb"
    write_session(path, SessionRecord(Session(source=str(closed))))
    opened_in(window, qtbot, path)
    assert window.document.session.source == "grid" and window.sessions.desk.path == ""
    opened_in(window, qtbot, Path("bumpy"))
    assert window.sessions.desk.path == "" and "mine" not in window.windowTitle()
    opened_in(window, qtbot, path)
    window.document.try_again(("cut",))
    qtbot.waitUntil(lambda: window.document.session.source == str(closed))
    assert window.sessions.desk.path == str(path), "with the fix it is that session"
    window.document.open("grid")
    qtbot.waitUntil(lambda: window.document.session.source == "grid")


def test_a_session_that_the_engine_refuses_leaves_the_name_of_the_present_one(
    window: MainWindow, qtbot: QtBot, tmp_path: Path
) -> None:
    desk, document = window.sessions.desk, window.document
    path = tmp_path / "mine.dwb"
    write_session(path, SessionRecord(Session(source="grid"), map=grid_mesh().vertices))
    desk.open(Found(str(path), replace(read_session(path), session=Session(source="grid")), ""))
    assert desk.path == str(path)
    window.bridge.refused.emit(Refused(document.generation, "TakeUp", "It does not suit.", serial=document.anchor_serial))
    assert desk.path == "" and window.error_bar.isVisible()
    started = replace(read_session(path), session=Session(source=str(mesh_file(tmp_path)), initializer="lscm"), map=None)
    desk.open(Found(str(path), started, ""))
    qtbot.waitUntil(lambda: document.session.initializer == "lscm" and desk.path == str(path))
    window.bridge.refused.emit(Refused(document.generation, "Reset", "It makes no start here."))
    assert document.session.initializer == "" and window.isWindowModified(), "it is not as the file has it"


@pytest.mark.parametrize("distortion", ["__import__('os').system('id')", "().__class__", "sigma.__class__", "no-such"])
def test_a_formula_that_is_none_is_refused_before_anything_is_opened(
    window: MainWindow, qtbot: QtBot, tmp_path: Path, distortion: str
) -> None:
    path = tmp_path / "bad.json"
    begin = '{"format": "distortion-workbench session", "version": 1, "source": {"path": "sample:bar"}, "distortion": "'
    path.write_text(begin + distortion + '"}')
    window.sessions.open(str(path))
    wait_for_desk(window, qtbot)
    assert window.error_bar.isVisible() and window.document.session.source == "grid"


def test_closing_asks_only_where_a_file_would_be_out_of_date(make_window: WindowMaker, qtbot: QtBot, tmp_path: Path) -> None:
    window = make_window(source=str(mesh_file(tmp_path)))
    document = window.document
    qtbot.waitUntil(lambda: document.positions is not None)
    window.sessions.save_to(str(tmp_path / "mine.dwb"))
    wait_for_desk(window, qtbot)
    document.add_anchor(5)
    window.close()
    assert window.isVisible()
    box = next(box for box in window.findChildren(QMessageBox) if box.isVisible())
    box.button(QMessageBox.StandardButton.Save).click()
    wait_for_desk(window, qtbot)
    qtbot.waitUntil(lambda: not window.isVisible())
    assert read_session(tmp_path / "mine.dwb").session.anchor_vertices == (5,)


def test_window_and_command_line_come_to_the_same_energy(make_window: WindowMaker, qtbot: QtBot, tmp_path: Path) -> None:
    window = make_window(engine_worker, source="sample:bar")
    document = window.document
    qtbot.waitUntil(lambda: document.positions is not None and bool(len(document.anchors)))

    def rested() -> bool:
        snapshot, session = document.snapshot, document.session
        is_told = (snapshot.distortion, snapshot.solver) == (session.distortion, session.solver)
        return is_told and snapshot.phase == "finished" and snapshot.anchor_serial == document.anchor_serial

    document.run()
    qtbot.waitUntil(rested)
    hand, view = Hand(window.target.view), window.target.view
    begin = pixel_of(view, int(document.anchors.vertices[0]))
    hand.drag(begin, begin + QPoint(25, -30))
    qtbot.waitUntil(rested)
    pulled, last = document.anchors.vertices[1:2], int(document.anchors.vertices[-1])
    soft = document.anchors.weighted(pulled.tolist(), 2.0).moved(pulled, document.anchors.targets_of(pulled) + 0.2)
    document.set_anchors(soft.switched([last], on=False))
    qtbot.wait(300)
    qtbot.waitUntil(rested)
    for change in (
        {"distortion": "lam*symmetric_dirichlet + (1 - lam)*mips", "distortion_parameters": {"lam": 0.25}},
        {"solver": "l-bfgs"},
        {"solver": "projected-newton"},
    ):
        document.choose(**change)
        qtbot.wait(300)
        qtbot.waitUntil(rested)
    window.sessions.save_to(str(tmp_path / "s.dwb"))
    wait_for_desk(window, qtbot)
    record = read_session(tmp_path / "s.dwb")
    assert len(record.legs) >= 3 and record.legs[0].origin == "map", "the hand had its part"
    assert record.energy == document.snapshot.row.energy
    assert record.session.anchors_off == {last} and set(record.session.anchor_weights) == {2.0, np.inf}
    assert np.linalg.norm(document.positions[pulled] - soft.targets_of(pulled)) > 1e-3, "it yields"
    assert main(["run", str(tmp_path / "s.dwb"), "--out", str(tmp_path / "out"), "--quiet"]) == 0
    with np.load(tmp_path / "out" / "map.npz") as case:
        np.testing.assert_allclose(case["X"], document.positions, atol=1e-9 * document.mesh.diameter)
    record_again = (tmp_path / "out" / "report.json").read_text()
    assert '"same_energy": true' in record_again


def test_an_energy_that_hangs_on_an_earlier_start_is_not_recorded(window: MainWindow) -> None:
    """Whoever repeats the session finds the barrier where the last map has it, and would find another energy."""
    rested = window.document.snapshot
    recorded = []
    for id in ("mips", "symmetric-dirichlet-filtered"):
        window.document.choose(distortion=id)
        told = replace(
            rested, phase="finished", distortion=window.document.session.distortion, anchor_serial=window.document.anchor_serial
        )
        window.document._take_snapshot(told)
        recorded.append(window.sessions.desk.record().energy)
    assert recorded == [rested.row.energy, None]
