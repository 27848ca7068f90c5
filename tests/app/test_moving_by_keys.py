"""G, R and S under a real mouse and keyboard; mirror twins and what is near go along."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from tests.app.conftest import Hand, WindowMaker, pixel_of
from tests.app.space_hand import anchor_face, facing_sides
from workbench.app.document.engine_bridge import engine_worker
from workbench.app.handling.company import Customs
from workbench.app.main_window import MainWindow
from workbench.app.views.mesh_view import MeshView

NONE, SHIFT = Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ShiftModifier
KEYS = {
    "-": Qt.Key.Key_Minus,
    ".": Qt.Key.Key_Period,
    **{str(digit): Qt.Key(Qt.Key.Key_0.value + digit) for digit in range(10)},
}


def type_keys(window: MainWindow, text: str) -> None:
    for character in text:
        QTest.keyClick(window, KEYS[character])


def take(window: MainWindow, *vertices: int) -> np.ndarray:
    """Anchor and select these; where they are."""
    window.document.pin(np.array(vertices))
    window.document.select_all(vertices)
    return window.document.anchors.targets_of(np.array(vertices))


def now(window: MainWindow, *vertices: int) -> np.ndarray:
    return window.document.anchors.targets_of(np.array(vertices))


def units(view: MeshView, pixels: QPoint) -> np.ndarray:
    """A way on the screen, in units of the mesh."""
    return (
        np.array([pixels.x(), -pixels.y()]) / view.camera.pixels_per_unit(view.size_in_pixels) / view.geometry_shown.frame.scale
    )


@pytest.fixture(autouse=True)
def _no_company(window: MainWindow) -> None:
    window.desk.company.choose(**vars(Customs()))


def test_g_moves_with_the_pointer_and_no_button_and_a_click_makes_one_step(window: MainWindow) -> None:
    view, hand = window.target.view, Hand(window.target.view)
    before = take(window, 136, 140)
    steps = window.undoing.history.names
    begin = QPoint(60, 80)
    hand.move(begin)
    QTest.keyClick(window, Qt.Key.Key_G)
    for step in range(1, 6):
        hand.move(begin + QPoint(8, -5) * step)
        QTest.qWait(20)
    assert window.document.is_held and "Move" in view.overlay.scene.hint
    np.testing.assert_allclose(now(window, 136, 140) - before, [units(view, QPoint(40, -25))] * 2, atol=0.01)
    QTest.keyClick(window, Qt.Key.Key_Y)
    assert view.overlay.scene.guide is not None and "along y" in view.overlay.scene.hint
    hand.click(begin + QPoint(40, -25))
    np.testing.assert_allclose(now(window, 136, 140) - before, [units(view, QPoint(0, -25))] * 2, atol=0.01)
    assert not window.document.is_held and view.overlay.scene.hint == ""
    assert set(window.document.anchors.targets) == {136, 140}, "the click sets no anchor"
    assert window.undoing.history.names == (*steps, "Move 2 anchors")
    window.undoing.undo()
    np.testing.assert_array_equal(now(window, 136, 140), before)
    QTest.keyClick(window, Qt.Key.Key_G)
    hand.move(begin)
    Hand(window.source.view).click(pixel_of(window.source.view, 0))
    assert not window.document.is_held and set(window.document.anchors.targets) == {136, 140}, "nor does one in another view"


@pytest.mark.parametrize("way_out", ["escape", "right click"])
def test_what_is_cancelled_leaves_nothing_behind(window: MainWindow, way_out: str) -> None:
    view, hand = window.target.view, Hand(window.target.view)
    take(window, 136, 140)
    anchors, steps = window.document.anchors, window.undoing.history.names
    for key in (Qt.Key.Key_G, Qt.Key.Key_R, Qt.Key.Key_S):
        hand.move(QPoint(60, 80))
        QTest.keyClick(window, key)
        hand.move(QPoint(90, 130))
        assert window.document.anchors != anchors
        if way_out == "escape":
            QTest.keyClick(window, Qt.Key.Key_Escape)
        else:
            hand.press(QPoint(90, 130), Qt.MouseButton.RightButton)
            hand.release(QPoint(90, 130), Qt.MouseButton.RightButton)
        assert window.document.anchors == anchors and window.undoing.history.names == steps
        assert not window.document.is_held and view.overlay.scene.hint == ""
    QTest.keyClick(window, Qt.Key.Key_G)
    QTest.keyClick(window, Qt.Key.Key_Return)
    assert window.undoing.history.names == steps, "and neither does what nobody moved"


def test_typed_numbers_move_turn_and_scale_exactly(window: MainWindow) -> None:
    vertices = (136, 140, 178)
    before = take(window, *vertices)
    centre = before.mean(axis=0)
    QTest.keyClick(window, Qt.Key.Key_G)
    QTest.keyClick(window, Qt.Key.Key_X)
    type_keys(window, "1.55")
    QTest.keyClick(window, Qt.Key.Key_Backspace)
    type_keys(window, "-")
    assert "-1.5" in window.target.view.overlay.scene.hint
    QTest.keyClick(window, Qt.Key.Key_Return)
    np.testing.assert_array_equal(now(window, *vertices), before + [-1.5, 0.0])
    QTest.keyClick(window, Qt.Key.Key_G)
    type_keys(window, "1.5")
    QTest.keyClick(window, Qt.Key.Key_Tab)
    type_keys(window, ".25")
    QTest.keyClick(window, Qt.Key.Key_Enter)
    np.testing.assert_allclose(now(window, *vertices), before + [0.0, 0.25], atol=1e-15)
    window.undoing.undo()
    window.undoing.undo()
    QTest.keyClick(window, Qt.Key.Key_R)
    type_keys(window, "-90")
    QTest.keyClick(window, Qt.Key.Key_Return)
    x, y = (before - centre).T
    np.testing.assert_allclose(now(window, *vertices), centre + np.c_[y, -x], atol=1e-12)
    window.undoing.undo()
    QTest.keyClick(window, Qt.Key.Key_G)
    QTest.keyClick(window, Qt.Key.Key_S)
    assert "Scale" in window.target.view.overlay.scene.hint, "another deed instead"
    QTest.keyClick(window, Qt.Key.Key_Y)
    type_keys(window, "3")
    QTest.keyClick(window, Qt.Key.Key_Return)
    np.testing.assert_allclose(now(window, *vertices), centre + (before - centre) * [1.0, 3.0], atol=1e-12)


def test_r_turns_about_the_axis_that_is_locked(solid_window: MainWindow) -> None:
    window = solid_window
    vertices = anchor_face(window)
    before = window.document.anchors.targets_of(vertices)
    arms = before - before.mean(axis=0)
    for row, key in enumerate((Qt.Key.Key_X, Qt.Key.Key_Y, Qt.Key.Key_Z)):
        QTest.keyClick(window, Qt.Key.Key_R)
        QTest.keyClick(window, key)
        type_keys(window, "30")
        assert f"30|° about {'XYZ'[row]}" in window.target.view.overlay.scene.hint
        QTest.keyClick(window, Qt.Key.Key_Return)
        after = window.document.anchors.targets_of(vertices) - before.mean(axis=0)
        np.testing.assert_allclose(after[:, row], arms[:, row], atol=1e-12)
        a, b = np.delete(arms, row, axis=1).T if row != 1 else arms[:, [2, 0]].T
        turned = np.delete(after, row, axis=1).T if row != 1 else after[:, [2, 0]].T
        cos, sin = math.cos(math.radians(30)), math.sin(math.radians(30))
        np.testing.assert_allclose(turned, [cos * a - sin * b, sin * a + cos * b], atol=1e-12)
        window.undoing.undo()
    axis, _ = facing_sides(window)[0]
    Hand(window.target.view).move(QPoint(50, 60))
    QTest.keyClick(window, Qt.Key.Key_G)
    QTest.keyClick(window, (Qt.Key.Key_X, Qt.Key.Key_Y, Qt.Key.Key_Z)[axis], SHIFT)
    Hand(window.target.view).move(QPoint(90, 130))
    QTest.keyClick(window, Qt.Key.Key_Return)
    shifts = window.document.anchors.targets_of(vertices) - before
    assert np.abs(shifts[:, axis]).max() < 1e-12 < np.abs(np.delete(shifts, axis, axis=1)).min()


def test_the_keys_are_letters_where_text_is_written_and_say_so_where_nothing_is_selected(window: MainWindow) -> None:
    take(window, 136, 140)
    edit = window.panel.distortion.edit
    edit.setFocus()
    before = edit.toPlainText()
    for key in (Qt.Key.Key_G, Qt.Key.Key_R, Qt.Key.Key_S, Qt.Key.Key_L, Qt.Key.Key_O, Qt.Key.Key_P, Qt.Key.Key_M):
        QTest.keyClick(edit, key)
    assert len(edit.toPlainText()) == len(before) + 7
    assert not window.target_tool.is_dragging and not window.desk.company.customs.has_falloff
    edit.setPlainText(before)
    window.target.view.overlay.setFocus()
    window.document.select(-1)
    QTest.keyClick(window, Qt.Key.Key_G)
    assert not window.target_tool.is_dragging and "No anchor is selected" in window.status.sentence.text()


@pytest.mark.parametrize(("key", "word"), [(Qt.Key.Key_R, "turn"), (Qt.Key.Key_S, "scale")])
def test_one_anchor_alone_has_nothing_to_turn_about_and_that_is_said(window: MainWindow, key: Qt.Key, word: str) -> None:
    document, said = window.document, window.status.sentence
    document.pin(np.array([136, 140]))
    document.select(136)
    steps = window.undoing.history.names
    QTest.keyClick(window, key)
    assert not window.target_tool.is_dragging and f"alone does not {word}" in said.text()
    QTest.keyClick(window, Qt.Key.Key_G)
    window.status.say("")
    QTest.keyClick(window, key)
    assert "Move" in window.target.view.overlay.scene.hint and f"alone does not {word}" in said.text(), "it is moved still"
    QTest.keyClick(window, Qt.Key.Key_Escape)
    assert window.undoing.history.names == steps
    window.desk.company.choose(has_falloff=True, reach=10.0)
    QTest.keyClick(window, key)
    type_keys(window, "3")
    QTest.keyClick(window, Qt.Key.Key_Return)
    assert window.undoing.history.names == (*steps, "Move anchor"), "the one near by turns about it"
    window.desk.company.choose(has_falloff=False)
    document.select_all((136, 140))
    QTest.keyClick(window, key)
    assert window.target_tool.is_dragging, "two are turned about their centre"
    QTest.keyClick(window, Qt.Key.Key_Escape)


def test_a_mirror_twin_is_made_moves_likewise_and_goes_again_with_esc(window: MainWindow) -> None:
    view, document, hand = window.target.view, window.document, Hand(window.target.view)
    take(window, 0)
    QTest.keyClick(window, Qt.Key.Key_M)
    assert window.actions_by_name["mirror"].isChecked() and "x" in window.actions_by_name["mirror"].text()
    assert "mirror" in view.overlay.scene.sketches and "mirror" in window.source.view.overlay.scene.sketches
    steps = window.undoing.history.names
    begin = pixel_of(view, 0)
    hand.drag(begin, begin + QPoint(20, -14))
    assert set(document.anchors.targets) == {0, 20}, "the other lower corner"
    (x, y), (u, v) = now(window, 0, 20)
    assert (u, v) == (pytest.approx(2.0 - x), pytest.approx(y)) and x > 0.02
    assert window.undoing.history.names == (*steps, "Move 2 anchors")
    window.undoing.undo()
    assert set(document.anchors.targets) == {0}
    window.document.select(0)
    hand.press(begin)
    hand.move(begin + QPoint(30, 30))
    assert set(document.anchors.targets) == {0, 20}
    QTest.keyClick(window, Qt.Key.Key_Escape)
    hand.release(begin)
    assert set(document.anchors.targets) == {0} and window.undoing.history.names == steps
    window.actions_by_name["mirror-y"].trigger()
    before = take(window, 136)  # on the line: it can only go along it
    begin = pixel_of(view, 136)
    hand.drag(begin, begin + QPoint(20, -14))
    shift = now(window, 136)[0] - before[0]
    assert abs(shift[1]) < 1e-12 < shift[0] and set(document.anchors.targets) == {0, 136}
    QTest.keyClick(window, Qt.Key.Key_M)
    assert not window.desk.company.customs.mirror and "mirror" not in view.overlay.scene.sketches
    QTest.keyClick(window, Qt.Key.Key_M)
    assert window.desk.company.customs.mirror == "y", "the plane that was chosen last"


def test_a_group_with_a_mirror_twin_moves_as_one(window: MainWindow) -> None:
    group = (20, 19, 18)
    take(window, *group)
    window.handling.group()
    take(window, 0)
    before = now(window, *group)
    window.actions_by_name["mirror-x"].trigger()
    begin = pixel_of(window.target.view, 0)
    Hand(window.target.view).drag(begin, begin + QPoint(20, -14))
    shifts = now(window, *group) - before
    assert shifts[0][0] < -0.02 and shifts[0][1] > 0.01
    np.testing.assert_allclose(shifts, shifts[[0, 0, 0]], atol=1e-12)


def test_a_source_without_symmetry_is_told(window: MainWindow) -> None:
    window.actions_by_name["mirror-z"].trigger()
    assert "nothing to mirror" in window.status.sentence.text()
    begin = pixel_of(window.target.view, 0)
    take(window, 0)
    Hand(window.target.view).drag(begin, begin + QPoint(20, -14))
    assert set(window.document.anchors.targets) == {0}


def test_anchors_near_by_follow_as_far_as_the_wheel_says(window: MainWindow) -> None:
    view, document, hand = window.target.view, window.document, Hand(window.target.view)
    row = tuple(range(126, 147))
    before = take(window, *row)
    document.select(126)
    QTest.keyClick(window, Qt.Key.Key_O)
    assert window.actions_by_name["falloff"].isChecked()
    begin = pixel_of(view, 126)
    hand.press(begin)
    for step in range(1, 5):
        hand.move(begin + QPoint(-7, 5) * step)
        QTest.qWait(20)

    def shares() -> np.ndarray:
        shifts = now(window, *row) - before
        return np.linalg.norm(shifts, axis=1) / np.linalg.norm(shifts[0])

    narrow, scale = shares(), view.camera.half_height
    radius = window.desk.company.radius
    away = np.arange(21) * 0.1
    np.testing.assert_allclose(narrow, np.clip(1 - (away / radius) ** 2, 0, 1) ** 2, atol=1e-6)
    assert narrow[0] == 1.0 and 0.0 < narrow[1] < 1.0 and narrow[-1] == 0.0
    assert "reach" in view.overlay.scene.sketches and "Wheel" in view.overlay.scene.hint
    where = QPointF(begin)

    def turn_wheel(steps: int) -> None:
        wheel = QWheelEvent(
            where, view.overlay.mapToGlobal(where), QPoint(), QPoint(0, 120 * steps), Qt.MouseButton.NoButton,
            NONE, Qt.ScrollPhase.NoScrollPhase, False,
        )  # fmt: skip
        QApplication.sendEvent(view.overlay, wheel)

    for steps in (1, 1, 1, -3):
        wider = shares()
        turn_wheel(steps)
        assert (np.count_nonzero(shares()) - np.count_nonzero(wider)) * steps >= 0
    np.testing.assert_allclose(shares(), narrow, atol=1e-9, err_msg="who is not reached any longer goes back")
    turn_wheel(3)
    assert view.camera.half_height == scale, "the wheel does not zoom meanwhile"
    assert np.count_nonzero(shares()) > np.count_nonzero(narrow)
    hand.release(begin + QPoint(-28, 20))
    assert "reach" not in view.overlay.scene.sketches
    window.undoing.undo()
    np.testing.assert_array_equal(now(window, *row), before)


def test_what_is_kept_of_mirror_and_falloff_comes_back_and_nonsense_does_not(window: MainWindow) -> None:
    company = window.desk.company
    company.choose(mirror="y", has_falloff=True, along_edges=False, reach=0.5)
    kept = window.settings.handling()
    assert kept | vars(company.customs) == kept == json.loads(json.dumps(kept))
    company.choose(**vars(Customs()))
    window.handling.company._recall(kept)
    assert company.customs == Customs("y", True, False, 0.5)
    company.choose(**vars(Customs()))
    window.handling.company._recall({"mirror": "../x", "has_falloff": "yes", "reach": -1e300, "along_edges": 3, "more": 1})
    assert company.customs == Customs()


def test_whatever_is_thrown_about_no_map_is_inverted(make_window: WindowMaker, qtbot: QtBot) -> None:
    """The real engine: a mirrored pull with a falloff, then turns and stretches far beyond what a map can follow."""
    window = make_window(engine_worker, source="sample:gingerbread")
    document, view = window.document, window.target.view
    qtbot.waitUntil(lambda: len(document.anchors) > 2 and view.geometry_shown is not None)
    inverted: list[bool] = []
    document.snapshot_taken.connect(lambda: inverted.append(bool(document.snapshot.inverted.any())))
    window.desk.company.choose(mirror="x", has_falloff=True, reach=0.4)
    document.select_all([int(np.argmax(document.mesh.vertices[:, 0])), *document.anchors.targets])
    hand = Hand(view)
    for key, way in ((Qt.Key.Key_G, QPoint(260, -200)), (Qt.Key.Key_R, QPoint(-200, 160)), (Qt.Key.Key_S, QPoint(300, 300))):
        middle = QPoint(view.width() // 2 + 40, view.height() // 2)
        hand.move(middle)
        QTest.keyClick(window, key)
        for step in range(1, 12):
            hand.move(middle + way * step / 11)
            qtbot.wait(20)
        QTest.keyClick(window, Qt.Key.Key_Return)
        serial = document.anchor_serial
        qtbot.waitUntil(lambda s=serial: document.snapshot.anchor_serial >= s)
    qtbot.wait(200)
    assert len(inverted) > 10 and not any(inverted)
    assert np.abs(document.positions - document.mesh.vertices).max() > 0.1 * document.mesh.diameter, "the map did move"
