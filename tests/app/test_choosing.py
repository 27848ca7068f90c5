"""Anchors chosen under a real mouse: lassos, several at once, loops and paths."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from tests.app.conftest import Hand, pixel_of
from workbench.app.main_window import MainWindow
from workbench.app.views.mesh_view import MeshView
from workbench.core.mesh import Mesh

NONE, SHIFT, CTRL = (
    Qt.KeyboardModifier.NoModifier,
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.ControlModifier,
)
LEFT = Qt.MouseButton.LeftButton


def draw(view: MeshView, corners: list[QPoint], modifiers: Qt.KeyboardModifier = NONE) -> None:
    """Press at the first corner, go round all, release at the last."""
    QTest.mousePress(view.overlay, LEFT, modifiers, corners[0])
    for begin, end in itertools.pairwise(corners):
        for step in range(1, 5):
            QTest.mouseMove(view.overlay, begin + (end - begin) * step / 4)
    QTest.mouseRelease(view.overlay, LEFT, modifiers, corners[-1])


def triangle_round(view: MeshView, vertices: list[int]) -> list[QPoint]:
    """A lasso with three corners well outside the middle of some vertices."""
    pixels = view.project(view.geometry_shown.points[vertices])
    middle, reach = pixels.mean(axis=0), 2.0 * np.ptp(pixels, axis=0).max() + 12.0
    angles = np.radians([90, 210, 330])
    return [QPoint(round(middle[0] + reach * np.cos(a)), round(middle[1] + reach * np.sin(a))) for a in angles]


def in_triangle(view: MeshView, corners: list[QPoint]) -> set[int]:
    """Vertices inside, by the signs of three areas."""
    pixels = view.project(view.geometry_shown.vertices)
    a = np.array([[c.x(), c.y()] for c in corners], dtype=float)
    b = np.roll(a, -1, axis=0)
    sides = [(q[0] - p[0]) * (pixels[:, 1] - p[1]) - (q[1] - p[1]) * (pixels[:, 0] - p[0]) for p, q in zip(a, b, strict=True)]
    return set(np.flatnonzero((np.array(sides) > 0).all(axis=0) | (np.array(sides) < 0).all(axis=0)).tolist())


def pin(window: MainWindow, *vertices: int) -> None:
    window.document.pin(np.array(vertices))


def test_a_lasso_anchors_what_is_inside_and_says_what_it_does(window: MainWindow) -> None:
    view, document = window.target.view, window.document
    corners = triangle_round(view, [136, 137, 157])
    inside = in_triangle(view, corners)
    assert len(inside) > 3
    QTest.keyClick(window, Qt.Key.Key_L)
    assert "lasso" in window.status.sentence.text() and "Esc" in view.overlay.scene.hint
    assert "lasso" in window.source.view.overlay.scene.hint, "it can be drawn in either view"
    QTest.mousePress(view.overlay, LEFT, NONE, corners[0])
    QTest.mouseMove(view.overlay, corners[1])
    assert view.overlay.scene.outline is not None
    QTest.mouseMove(view.overlay, corners[2])
    QTest.mouseRelease(view.overlay, LEFT, NONE, corners[2])
    assert set(document.anchors.targets) == inside == set(document.selected_anchors.tolist())
    assert len(document.selection) == 1, "as one group"
    for one in (view, window.source.view):
        assert one.overlay.scene.outline is None and one.overlay.scene.hint == ""
    other = triangle_round(view, [40])
    QTest.keyClick(window, Qt.Key.Key_L)
    draw(view, other, SHIFT)
    assert set(document.selected_anchors.tolist()) == inside | in_triangle(view, other), "Shift adds"
    QTest.keyClick(window, Qt.Key.Key_L)
    draw(view, other, CTRL)
    assert set(document.anchors.targets) == inside - in_triangle(view, other), "Ctrl takes away"
    names = window.undoing.history.names
    assert len(names) >= 3 and names[-1].startswith("Remove")


def test_anchors_are_selected_by_a_lasso_shift_adds_ctrl_takes_away_and_esc_leaves(window: MainWindow) -> None:
    view, document = window.target.view, window.document
    pin(window, 21, 23, 100, 230)
    near = triangle_round(view, [21, 23])

    def select(around: list[QPoint], modifiers: Qt.KeyboardModifier) -> set[int]:
        QTest.keyClick(window, Qt.Key.Key_L, SHIFT)
        draw(view, around, modifiers)
        return set(document.selected_anchors.tolist())

    assert select(near, NONE) == {21, 23} and len(document.anchors) == 4
    assert select(triangle_round(view, [230]), SHIFT) == {21, 23, 230}
    assert select(triangle_round(view, [21]), CTRL) == {23, 230}
    assert select(triangle_round(view, [100]), NONE) == {100}
    QTest.keyClick(window, Qt.Key.Key_B, SHIFT)
    draw(view, [near[0], near[2]])
    QTest.keyClick(window, Qt.Key.Key_A, CTRL)
    assert len(document.selected_anchors) == 4
    QTest.keyClick(window, Qt.Key.Key_L, SHIFT)
    assert "Select" in view.overlay.scene.hint
    QTest.keyClick(window, Qt.Key.Key_B)
    assert "box" in view.overlay.scene.hint and "box" in window.source.view.overlay.scene.hint, "the keys change the shape"
    QTest.keyClick(window, Qt.Key.Key_Escape)
    assert view.overlay.scene.hint == "" and len(document.selected_anchors) == 4
    Hand(view).click(pixel_of(view, 60))
    assert 60 in document.anchors, "a click sets an anchor again"


def test_what_a_solid_hides_is_taken_where_it_is_asked_for(solid_window: MainWindow) -> None:
    window, view = solid_window, solid_window.target.view
    everywhere = [
        QPoint(2, 2),
        QPoint(view.width() - 2, 2),
        QPoint(view.width() - 2, view.height() - 2),
        QPoint(2, view.height() - 2),
    ]

    def count() -> int:
        window.document.clear_anchors()
        QTest.keyClick(window, Qt.Key.Key_L)
        draw(view, everywhere)
        return len(window.document.anchors)

    seen = count()
    QTest.keyClick(window, Qt.Key.Key_L)
    QTest.keyClick(window, Qt.Key.Key_T)
    assert window.actions_by_name["through"].isChecked() and "hidden ones, too" in view.overlay.scene.hint
    QTest.keyClick(window, Qt.Key.Key_Escape)
    assert count() == window.document.mesh.vertex_count > seen > 10
    window.actions_by_name["through"].trigger()
    assert count() == seen


def test_several_anchors_are_clicked_moved_together_grouped_and_removed(window: MainWindow) -> None:
    view, document = window.target.view, window.document
    pin(window, 0, 20, 136, 272)
    hand = Hand(view)
    hand.click(pixel_of(view, 0))
    QTest.mouseClick(view.overlay, LEFT, SHIFT, pixel_of(view, 136))
    QTest.mouseClick(view.overlay, LEFT, SHIFT, pixel_of(view, 272))
    QTest.mouseClick(view.overlay, LEFT, CTRL, pixel_of(view, 272))
    assert set(document.selected_anchors.tolist()) == {0, 136}
    assert set(view.overlay.scene.selected.tolist()) == {0, 136} and not document.anchors.groups
    before = document.anchors
    steps = len(window.undoing.history.names)
    begin = pixel_of(view, 136)
    hand.drag(begin, begin + QPoint(24, -16))
    shifts = {v: np.subtract(document.anchors.targets[v], before.targets[v]) for v in before.targets}
    np.testing.assert_allclose(shifts[0], shifts[136], atol=1e-12)
    assert np.linalg.norm(shifts[136]) > 0.01 and not shifts[20].any() and not shifts[272].any()
    assert len(window.undoing.history.names) == steps + 1
    QTest.keyClick(window, Qt.Key.Key_G, CTRL)
    assert set(document.anchors.together_with([0]).tolist()) == {0, 136}
    window.undoing.undo()
    assert not document.anchors.groups
    window.undoing.redo()
    hand.press(pixel_of(view, 20), Qt.MouseButton.RightButton)
    hand.release(pixel_of(view, 20), Qt.MouseButton.RightButton)
    assert 20 not in document.anchors, "one that is not selected goes at once"
    window.undoing.undo()
    document.select_all([0, 20, 136])
    hand.press(pixel_of(view, 20), Qt.MouseButton.RightButton)
    hand.release(pixel_of(view, 20), Qt.MouseButton.RightButton)
    texts = [action.text().replace("&", "") for action in window.handling.menu.menu.actions()]
    window.handling.menu.menu.close()
    assert "Let go of all 3 selected" in texts and "Group anchors" in texts and 20 in document.anchors
    hand.click(pixel_of(view, 20))
    hand.click(pixel_of(view, 0))
    assert set(document.selected_anchors.tolist()) == {0, 136}, "one of a group stands for all"
    QTest.keyClick(window, Qt.Key.Key_G, CTRL | SHIFT)
    hand.click(pixel_of(view, 0))
    assert document.selected_anchors.tolist() == [0]
    QTest.mouseClick(view.overlay, LEFT, SHIFT, pixel_of(view, 20))
    QTest.keyClick(window, Qt.Key.Key_Delete)
    assert set(document.anchors.targets) == {136, 272}


def test_a_path_is_shown_while_the_pointer_moves_and_pinned_by_the_second_click(window: MainWindow) -> None:
    view, document = window.target.view, window.document
    hand = Hand(view)
    QTest.keyClick(window, Qt.Key.Key_P)
    hand.click(pixel_of(view, 0))
    hand.move(pixel_of(view, 12))
    for one in (view, window.source.view):
        assert len(one.overlay.scene.sketches["pin"].segments) == 12
    hand.move(pixel_of(view, 6))
    assert len(view.overlay.scene.sketches["pin"].segments) == 6
    assert not len(document.anchors)
    hand.click(pixel_of(view, 6))
    assert document.anchors.vertices.tolist() == list(range(7)) == sorted(document.selection)
    assert "pin" not in view.overlay.scene.sketches
    QTest.keyClick(window, Qt.Key.Key_P)
    hand.click(pixel_of(view, 100))
    QTest.keyClick(window, Qt.Key.Key_Escape)
    hand.click(pixel_of(view, 200))
    assert sorted(document.anchors.targets) == [*range(7), 200], "Esc left: the click sets an anchor"


def test_the_loop_that_is_clicked_is_pinned_and_no_other(window: MainWindow, monkeypatch: pytest.MonkeyPatch) -> None:
    mesh = window.document.mesh
    hole = mesh.vertices[mesh.simplices].mean(axis=1)
    middle = int(np.argmin(np.linalg.norm(hole - [1.0, 0.5], axis=1)))
    pierced = Mesh(mesh.vertices, np.delete(mesh.simplices, middle, axis=0))
    monkeypatch.setattr(type(window.document), "mesh", property(lambda self: pierced))
    corners = sorted(mesh.simplices[middle].tolist())
    view = window.target.view
    hand = Hand(view)
    window.actions_by_name["pin-loop"].trigger()
    hand.move(pixel_of(view, corners[0]))
    assert len(view.overlay.scene.sketches["pin"].segments) == 3
    hand.move(pixel_of(view, 21 + 10))
    assert len(view.overlay.scene.sketches["pin"].segments) == 2 * (20 + 12), "the nearest one, away from both"
    hand.click(pixel_of(view, corners[0]))
    assert sorted(window.document.anchors.targets) == corners
    monkeypatch.undo()


def test_a_click_beside_everything_leaves_picking(window: MainWindow) -> None:
    window.actions_by_name["pin-loop"].trigger()
    QTest.mouseClick(window.target.view.overlay, LEFT, NONE, QPoint(4, 4))
    assert window.handling.pinning.deed == "" and not len(window.document.anchors)


@pytest.mark.parametrize("name", ["select-all", "group", "ungroup", "remove", "clear", "move", "turn", "scale"])
def test_what_finds_no_anchors_says_so_and_is_no_step(window: MainWindow, name: str) -> None:
    said, steps = window.status.sentence, window.undoing.history.names
    window.status.say("")
    window.actions_by_name[name].trigger()
    assert "nchor" in said.text() and "click" in said.text(), "and what to do"
    assert window.undoing.history.names == steps


def test_ungrouping_what_is_in_no_group_is_no_step(window: MainWindow) -> None:
    pin(window, 3, 9)
    window.document.select_all((3, 9))
    steps = window.undoing.history.names
    window.actions_by_name["ungroup"].trigger()
    assert "in a group" in window.status.sentence.text() and window.undoing.history.names == steps
