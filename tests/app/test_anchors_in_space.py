"""Anchors of solids under a real mouse: pulled, locked, turned in groups, chosen by face and by box, placed by numbers."""

from __future__ import annotations

import math

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from tests.app.conftest import Hand, pixel_of
from tests.app.space_hand import anchor_face, face_of, facing_sides, middle_of_face, turn_by_ring
from workbench.app.actions import TEXTS
from workbench.app.handling.pacing import TurnPacer, turned_angle
from workbench.app.handling.rigid_motion import RigidMotion
from workbench.app.main_window import MainWindow
from workbench.app.views.mesh_view import MeshView
from workbench.engine.messages import SetAnchors

SHIFT, ALT, CTRL = (
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.AltModifier,
    Qt.KeyboardModifier.ControlModifier,
)


def nearest_corner(window: MainWindow) -> int:
    """The vertex that is nearest to the eye in the target."""
    view = window.target.view
    return int(view.camera.project(view.geometry_shown.points, view.size_in_pixels)[1].argmax())


def hold_and_move(view: MeshView, begin: QPoint, end: QPoint) -> Hand:
    """A drag that has not ended yet."""
    hand = Hand(view)
    hand.press(begin)
    for step in range(1, 6):
        hand.move(begin + (end - begin) * step / 5)
        QTest.qWait(20)
    return hand


def test_an_anchor_moves_in_the_plane_of_the_view_and_with_the_pointer(solid_window: MainWindow) -> None:
    window, view = solid_window, solid_window.target.view
    vertex = nearest_corner(window)
    begin = pixel_of(view, vertex)
    Hand(view).click(begin)
    before = np.array(window.document.anchors.targets[vertex])
    Hand(view).drag(begin, begin + QPoint(40, -25))
    shift = np.array(window.document.anchors.targets[vertex]) - before
    assert abs(shift @ view.camera.axes[2]) < 1e-9 * np.linalg.norm(shift)
    pixels = view.camera.axes[:2] @ shift * view.geometry_shown.frame.scale * view.camera.pixels_per_unit(view.size_in_pixels)
    np.testing.assert_allclose(pixels, [40, 25], atol=1.0)


def test_keys_lock_a_drag_and_esc_takes_it_back(solid_window: MainWindow, qtbot: QtBot) -> None:
    window, view = solid_window, solid_window.target.view
    vertex = nearest_corner(window)
    begin = pixel_of(view, vertex)
    Hand(view).click(begin)
    before = np.array(window.document.anchors.targets[vertex])

    def shift() -> np.ndarray:
        return np.array(window.document.anchors.targets[vertex]) - before

    hand = hold_and_move(view, begin, begin + QPoint(30, 22))
    free = shift()
    for key, axis in ((Qt.Key.Key_X, 0), (Qt.Key.Key_Y, 1), (Qt.Key.Key_Z, 2)):
        QTest.keyClick(window, key)
        assert np.flatnonzero(np.abs(shift()) > 1e-12).tolist() == [axis]
        assert view.overlay.scene.guide is not None and "along" in view.overlay.scene.hold_words
    QTest.keyClick(window, Qt.Key.Key_Z)
    np.testing.assert_allclose(shift(), free, atol=1e-12, err_msg="the same key frees it again")
    QTest.keyClick(window, Qt.Key.Key_X, SHIFT)
    assert abs(shift()[0]) < 1e-12 < np.abs(shift()[1:]).min()
    QTest.keyClick(window.windowHandle(), Qt.Key.Key_Y)  # as the window system sends it
    assert np.flatnonzero(np.abs(shift()) > 1e-12).tolist() == [1]
    QTest.keyClick(window.windowHandle(), Qt.Key.Key_Escape)
    np.testing.assert_array_equal(shift(), 0.0)
    assert not [c for c in window.bridge._worker.commands if isinstance(c, SetAnchors)][-1].dragging
    hand.move(begin)
    hand.release(begin)
    np.testing.assert_array_equal(shift(), 0.0)
    assert vertex in window.document.anchors


def test_n_pulls_along_the_normal(solid_window: MainWindow) -> None:
    window, view = solid_window, solid_window.target.view
    axis, _ = facing_sides(window)[0]
    Hand(view).click(middle_of_face(window, *facing_sides(window)[0]))
    (vertex,) = window.document.anchors.vertices.tolist()
    before = np.array(window.document.anchors.targets[vertex])
    begin = pixel_of(view, vertex)
    hand = hold_and_move(view, begin, begin + QPoint(30, 22))
    QTest.keyClick(window, Qt.Key.Key_N)
    shift = np.array(window.document.anchors.targets[vertex]) - before
    assert np.flatnonzero(np.abs(shift) > 1e-6 * np.abs(shift).max()).tolist() == [axis]
    hand.release(begin + QPoint(30, 22))


def test_a_drag_on_the_surface_turns_the_view_and_a_click_anchors(solid_window: MainWindow) -> None:
    window, view = solid_window, solid_window.target.view
    where = middle_of_face(window, *facing_sides(window)[0])
    axes = view.camera.axes.copy()
    Hand(view).drag(where, where + QPoint(30, 10))
    assert not np.allclose(view.camera.axes, axes)
    assert not len(window.document.anchors)
    Hand(view).click(middle_of_face(window, *facing_sides(window)[0]))
    assert len(window.document.anchors) == 1


def test_a_whole_face_is_one_group_that_moves_and_goes_together(solid_window: MainWindow, qtbot: QtBot) -> None:
    window, view = solid_window, solid_window.target.view
    first = anchor_face(window)
    assert sorted(window.document.anchors.vertices.tolist()) == first.tolist()
    second = anchor_face(window, 1)
    assert sorted(window.document.selected_anchors.tolist()) == second.tolist()
    assert set(view.overlay.scene.anchor_vertices[view.overlay.scene.is_selected]) == set(second)
    before = dict(window.document.anchors.targets)
    alone = int(np.setdiff1d(first, second)[0])
    vertex = max(second.tolist(), key=lambda v: np.hypot(*(view.project(view.geometry_shown.points[[v]])[0] - [400, 300])))
    begin = pixel_of(view, vertex)
    Hand(view).drag(begin, begin + QPoint(25, 0))
    after = window.document.anchors.targets
    shifts = np.array([np.subtract(after[v], before[v]) for v in second.tolist()])
    assert np.linalg.norm(shifts[0]) > 0.01
    np.testing.assert_allclose(shifts, np.tile(shifts[0], (len(second), 1)), atol=1e-12)
    assert after[alone] == before[alone]
    QTest.keyClick(window, Qt.Key.Key_Delete)
    assert sorted(window.document.anchors.vertices.tolist()) == np.setdiff1d(first, second).tolist()


@pytest.mark.parametrize("is_running", [False, True])
def test_a_ring_turns_a_group_by_half_a_turn(solid_window: MainWindow, qtbot: QtBot, is_running: bool) -> None:
    window = solid_window
    axis, _ = facing_sides(window)[0]
    vertices = anchor_face(window)
    if is_running:
        window.document.run()
    before = window.document.anchors.targets_of(vertices)
    angle = turn_by_ring(window, axis, 180)
    qtbot.waitUntil(lambda: not window.desk.is_turning)
    after = window.document.anchors.targets_of(vertices)
    expected = RigidMotion(turn=angle * np.eye(3)[axis], centre=before.mean(axis=0)).of(before)
    np.testing.assert_allclose(after, expected, atol=0.06 * np.ptp(before))
    np.testing.assert_allclose(
        np.linalg.norm(after - after.mean(axis=0), axis=1), np.linalg.norm(before - before.mean(axis=0), axis=1), atol=1e-12
    )


def test_a_box_anchors_what_is_seen_and_with_ctrl_what_is_behind(solid_window: MainWindow, qtbot: QtBot) -> None:
    window, view = solid_window, solid_window.target.view
    low, high = QPoint(2, 2), QPoint(view.width() - 2, view.height() - 2)

    def draw(modifiers: Qt.KeyboardModifier) -> int:
        window.document.clear_anchors()
        overlay = view.overlay
        QTest.mousePress(overlay, Qt.MouseButton.LeftButton, modifiers, low)
        QTest.mouseMove(overlay, high)
        QTest.mouseRelease(overlay, Qt.MouseButton.LeftButton, modifiers, high)
        return len(window.document.selected_anchors)

    seen, everything = draw(SHIFT), draw(SHIFT | CTRL)
    assert everything == window.document.mesh.vertex_count
    at_three_faces = len(np.unique(np.concatenate([face_of(window, axis, side) for axis, side in facing_sides(window)])))
    assert seen == at_three_faces
    QTest.keyClick(window, Qt.Key.Key_B)
    window.document.clear_anchors()
    Hand(view).drag(low, high)
    assert len(window.document.anchors) == seen
    window.document.clear_anchors()
    QTest.keyClick(window, Qt.Key.Key_B)
    QTest.keyClick(window, Qt.Key.Key_Escape)
    Hand(view).drag(low, QPoint(60, 60))
    assert not len(window.document.anchors), "Esc gave the box up: the drag turned the view"


def test_the_right_button_offers_what_can_be_done(solid_window: MainWindow) -> None:
    window, view = solid_window, solid_window.target.view
    hand = Hand(view)

    def offered(where: QPoint) -> dict[str, object]:
        hand.press(where, Qt.MouseButton.RightButton)
        hand.release(where, Qt.MouseButton.RightButton)
        menu = window.handling.menu.menu
        actions = {action.text().partition("\t")[0].replace("&", ""): action for action in menu.actions()}
        menu.close()
        return actions

    where = middle_of_face(window, *facing_sides(window)[0])
    offered(where)["Anchor this face"].trigger()
    group = window.document.selected_anchors
    assert len(group) > 4
    corner = int(group[0])
    texts = offered(pixel_of(view, corner))
    texts["Let go of this anchor"].trigger()
    assert corner not in window.document.anchors and len(window.document.anchors) == len(group) - 1
    other = int(group[1])
    offered(pixel_of(view, other))["Let each move alone"].trigger()
    assert window.document.selected_anchors.tolist() == [other]
    hand.click(pixel_of(view, other), Qt.MouseButton.RightButton)
    assert other not in window.document.anchors, "a single anchor goes at once"


def test_anchors_are_placed_by_numbers(solid_window: MainWindow, qtbot: QtBot) -> None:
    window, view = solid_window, solid_window.target.view
    vertex = nearest_corner(window)
    Hand(view).click(pixel_of(view, vertex))
    QTest.keyClick(view.overlay, Qt.Key.Key_Return)
    dialog = window.handling.menu.dialog
    before = window.document.anchors.targets[vertex]
    dialog.apply()
    assert window.document.anchors.targets[vertex] == before, "what nobody changed stays to the last bit"
    dialog.places[1].setValue(0.123456789)
    dialog.apply()
    assert window.document.anchors.targets[vertex] == (before[0], pytest.approx(0.123456789, abs=1e-14), before[2])
    window.document.clear_anchors()
    axis, _ = facing_sides(window)[0]
    vertices = anchor_face(window)
    window.document.run()
    start = window.document.anchors.targets_of(vertices)
    dialog.angle.setValue(540.0)
    dialog.axis.setCurrentIndex(axis)
    window.bridge._worker.commands.clear()
    dialog.apply()
    qtbot.waitUntil(lambda: not window.desk.is_turning)
    sent = [c.targets for c in window.bridge._worker.commands if isinstance(c, SetAnchors)]
    angles = np.unwrap([turned_angle(start, targets, np.eye(3)[axis]) for targets in sent])
    assert angles[-1] == pytest.approx(3.0 * math.pi), "one and a half times round"
    assert np.abs(np.diff(angles, prepend=0.0)).max() < math.pi / 2
    dialog.places[0].setValue(dialog.places[0].value() + 0.25)
    dialog.angle.setValue(90.0)
    dialog.apply()
    qtbot.waitUntil(lambda: not window.desk.is_turning)
    centre = window.document.anchors.targets_of(vertices).mean(axis=0)
    np.testing.assert_allclose(centre, start.mean(axis=0) + [0.25, 0.0, 0.0], atol=1e-5)
    assert dialog.angle.value() == 0.0
    assert dialog.places[0].text() == f"{centre[0]:.6g}", "it shows where they are now"
    dialog.reject()


def test_a_side_of_a_figure_turns_in_the_plane(window: MainWindow) -> None:
    view = window.target.view
    right = [c for c in range(273) if c % 21 == 20]
    where = (pixel_of(view, right[0]) + pixel_of(view, right[-1])) / 2 + QPoint(-3, 0)
    QTest.mouseClick(view.overlay, Qt.MouseButton.LeftButton, ALT, where)
    assert sorted(window.document.selected_anchors.tolist()) == right
    before = window.document.anchors.targets_of(np.array(right))
    angle = turn_by_ring(window, 2, 90)
    after = window.document.anchors.targets_of(np.array(right))
    assert turned_angle(before, after, np.array([0.0, 0.0, 1.0])) == pytest.approx(angle, abs=0.05)


def test_a_turn_that_the_map_cannot_follow_ends_where_it_is(
    solid_window: MainWindow, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    window = solid_window
    axis, _ = facing_sides(window)[0]
    vertices = anchor_face(window)
    window.document.run()
    start = window.document.anchors.targets_of(vertices)
    monkeypatch.setattr("workbench.app.handling.anchor_desk.PATIENCE", 0.2)
    monkeypatch.setattr(window.bridge._worker, "_blend", lambda command: None)  # the map stands still
    window.desk.take_up()
    with qtbot.waitSignal(window.desk.given_up) as ended:
        window.desk.move(RigidMotion(turn=3.0 * np.eye(3)[axis], centre=start.mean(axis=0)), False)
    assert not window.desk.is_turning and not window.document.is_held
    assert math.radians(ended.args[0]) == pytest.approx(1.2)
    angle = turned_angle(start, window.document.anchors.targets_of(vertices), np.eye(3)[axis])
    assert angle == pytest.approx(1.2)
    assert "cannot follow" in window.status.sentence.text()


def test_a_turn_waits_for_the_map_and_counts_whole_turns() -> None:
    start = np.random.default_rng(0).normal(size=(12, 3))
    axis = np.array([0.0, 0.6, 0.8])
    for way in (1.0, -1.0):
        wanted = RigidMotion(turn=way * 7.0 * axis, centre=np.ones(3))
        pacer, places, parts = TurnPacer(start), start, [0.0]
        while parts[-1] < 1.0 and len(parts) < 20:
            parts.append(pacer.part(wanted, places))
            places = wanted.part(parts[-1]).of(start)
        assert len(parts) == 1 + math.ceil(7.0 / 1.2)
        assert np.diff(parts).max() * 7.0 <= 1.2 + 1e-9
    pacer = TurnPacer(start)
    assert pacer.part(wanted, start) == pacer.part(wanted, start), "it stands still while the map does"


def test_no_key_is_used_twice() -> None:
    keys = [key for text in TEXTS.values() for key in text.keys]
    assert len(keys) == len(set(keys))
