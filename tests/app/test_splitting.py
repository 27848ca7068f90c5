"""Views that are split, closed, linked and changed, under a real mouse."""

from __future__ import annotations

import random
from collections.abc import Iterator

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QAction, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from tests.app.conftest import Hand, pixel_of, pixels_of
from workbench.app.main_window import MainWindow
from workbench.app.splitting.splitting import MOST_PANES
from workbench.app.views.mesh_view import MeshView


@pytest.fixture
def window(window: MainWindow) -> Iterator[MainWindow]:
    """The window of the module, its views as they begin; they are so again at the end."""
    yield window
    window.splitting.arrange({}, {})
    window.splitting.set_visible_all()
    for name in ("source", "target"):
        window.splitting[name].tools.chain.setChecked(True)
    window.set_target_style("plain")
    window.splitting.active = "target"
    QTest.qWait(20)


def turn_wheel(view: MeshView, at: QPoint, steps: int = 1) -> None:
    nothing = Qt.KeyboardModifier.NoModifier
    event = QWheelEvent(
        QPointF(at), QPointF(view.overlay.mapToGlobal(at)), QPoint(), QPoint(0, 120 * steps), Qt.MouseButton.NoButton, nothing,
        Qt.ScrollPhase.NoScrollPhase, False,
    )  # fmt: skip
    QApplication.sendEvent(view.overlay, event)


def middle(view: MeshView) -> QPoint:
    return QPoint(view.width() // 2, view.height() // 2)


def action_of(window: MainWindow, name: str, text: str) -> QAction:
    """An entry of the menu of a view, opened by its button."""
    tools = window.splitting[name].tools
    QTest.mouseClick(tools.more, Qt.MouseButton.LeftButton)
    return next(action for action in tools.menu.actions() if action.text().replace("&", "") == text)


def choose(window: MainWindow, name: str, text: str) -> None:
    action = action_of(window, name, text)
    menu = window.splitting[name].tools.menu
    action.trigger()
    menu.close()  # a menu that is open would keep the wheel from all else
    QTest.qWait(20)


def same_camera(one: MeshView, other: MeshView) -> bool:
    a, b = one.camera, other.camera
    return bool(np.allclose(a.focal, b.focal) and np.allclose(a.axes, b.axes) and np.isclose(a.half_height, b.half_height))


def test_a_view_is_split_by_its_menu_and_shows_what_it_showed(window: MainWindow, qtbot: QtBot) -> None:
    window.set_target_style("det")
    choose(window, "target", "Split below")
    (pane,) = window.splitting.panes
    assert pane.y() > window.target.y() and pane.x() == window.target.x()
    assert pane.chooser.current == "det" and pane.legend.isVisible()
    assert pane.view.geometry_shown is window.target.view.geometry_shown
    qtbot.wait(50)
    background = pixels_of(pane.view)[2, 2]
    assert (pixels_of(pane.view) != background).any(axis=2).mean() > 0.1, "the mesh is to be seen"
    QTest.keyClick(window, Qt.Key.Key_Backslash, Qt.KeyboardModifier.ControlModifier)
    assert len(window.splitting.panes) == 2, "the key splits the view that is new"
    choose(window, "pane-1", "Close this view")
    choose(window, "pane-2", "Close this view")
    assert not window.splitting.panes and len(window.grid.leaves()) == 2


def test_anchors_are_dragged_in_a_pane_and_every_view_follows(window: MainWindow, qtbot: QtBot) -> None:
    pane = window.splitting.split("target", "right")
    assert pane is not None
    qtbot.wait(200)
    vertex = 6 * 21 + 10
    begin = pixel_of(pane.view, vertex)
    end = begin + QPoint(30, -20)
    there, pixel = pane.view.position_at((end.x(), end.y())), 1.0 / pane.view.pixels_per_unit
    Hand(pane.view).drag(begin, end)
    qtbot.wait(120)
    assert vertex in window.document.anchors.targets
    np.testing.assert_allclose(window.document.anchors.targets[vertex], there, atol=2.0 * pixel)
    assert pane.view.overlay.scene.anchor_vertices.tolist() == [vertex]
    assert window.target.view.overlay.scene.anchor_vertices.tolist() == [vertex]
    window.document.clear_anchors()


def test_a_pane_shows_the_other_side_when_asked(window: MainWindow, qtbot: QtBot) -> None:
    window.splitting.split("target", "right")
    (pane,) = window.splitting.panes
    pane.sides.setCurrentIndex(pane.sides.findData("source"))
    pane.sides.activated.emit(pane.sides.currentIndex())
    (other,) = window.splitting.panes
    assert other.is_source and other.view.geometry_shown is window.source.view.geometry_shown
    window.open("bumpy")
    qtbot.waitUntil(lambda: window.document.kind == "parameterize" and window.target.view.geometry_shown is not None)
    assert other.view.geometry_shown is window.source.view.geometry_shown, "another mesh reaches panes, too"


def test_there_are_no_more_than_eight_views_and_none_pushes_the_window_apart(window: MainWindow, qtbot: QtBot) -> None:
    size = window.size()
    while window.splitting.split("target", "right") is not None:
        qtbot.wait(5)
    assert "no room" in window.status.sentence.text() and 1 <= len(window.splitting.panes) < MOST_PANES
    qtbot.wait(30)
    assert window.size() == size, "views share the room that there is"
    window.splitting.arrange({}, {})
    window.resize(2400, 1400)
    qtbot.wait(30)
    for row in range(MOST_PANES):
        assert window.splitting.split("target", "right" if row % 2 else "below") is not None
    assert window.splitting.split("source", "below") is None
    assert "close one" in window.status.sentence.text()
    assert len(window.grid.leaves()) == 8
    window.splitting.arrange({}, {})
    window.resize(size)
    qtbot.wait(30)


def test_the_last_view_stays(window: MainWindow) -> None:
    window.splitting.close_view("source")
    assert not window.source.isVisible()
    window.splitting.close_view("target")
    assert window.target.isVisible() and "last view" in window.status.sentence.text()
    window.splitting.set_visible("source", True)
    assert window.source.isVisible()


@pytest.mark.parametrize("where", ["pane", "target"])
def test_a_view_that_goes_in_the_middle_of_a_drag_takes_the_drag_back(window: MainWindow, where: str, qtbot: QtBot) -> None:
    """The hand cannot let go in it: an anchor that counted as held would stop undo for good."""
    document = window.document
    document.add_anchor(136)
    before = document.anchors
    window.splitting.split("target", "right")
    (pane,) = window.presenter.more
    qtbot.waitUntil(lambda: pane.view.geometry_shown is not None and pane.view.isVisible())
    QTest.qWait(60)
    view, name = (pane.view, pane.objectName()) if where == "pane" else (window.target.view, "target")
    hand, at = Hand(view), pixel_of(view, 136)
    hand.press(at)
    for step in range(1, 5):
        hand.move(at + QPoint(7, 4) * step)
        QTest.qWait(20)
    assert document.is_held and document.anchors != before
    window.actions_by_name["undo"].trigger()
    assert "let it go" in window.status.sentence.text() and document.is_held, (
        "nothing is undone under the hand, and that is said"
    )
    window.splitting.close_view(name)
    assert not document.is_held and document.anchors == before
    QTest.qWait(30)
    window.undoing.undo()
    assert 136 not in document.anchors
    window.splitting.set_visible("target", True)
    for other in list(window.presenter.more):
        window.splitting.close_view(other.objectName())


def test_cameras_of_one_kind_go_together_and_never_with_another(window: MainWindow, qtbot: QtBot) -> None:
    source = window.source.view.camera
    turn_wheel(window.target.view, middle(window.target.view), 1)
    qtbot.wait(120)
    assert window.source.view.camera is source, "a figure does not follow its map"
    window.open("bumpy")
    qtbot.waitUntil(lambda: window.document.kind == "parameterize" and window.target.view.geometry_shown is not None)
    of_map, of_source = window.splitting.split("target", "below"), window.splitting.split("source", "below")
    assert of_map is not None and of_source is not None
    qtbot.wait(80)
    source, target = window.source.view.camera, window.target.view.camera
    turn_wheel(of_map.view, middle(of_map.view) + QPoint(20, 10), 3)
    qtbot.waitUntil(lambda: same_camera(of_map.view, window.target.view))
    assert window.target.view.camera.half_height < target.half_height
    assert window.source.view.camera is source, "a surface in space does not follow a figure"
    target = window.target.view.camera
    where = QPoint(12, 12)
    Hand(of_source.view).drag(where, where + QPoint(60, 30))
    qtbot.waitUntil(lambda: same_camera(of_source.view, window.source.view))
    assert not np.allclose(window.source.view.camera.axes, source.axes)
    assert window.target.view.camera is target
    QTest.mouseClick(window.splitting["pane-1"].tools.chain, Qt.MouseButton.LeftButton)
    held = of_map.view.camera
    turn_wheel(window.target.view, middle(window.target.view), 2)
    qtbot.wait(120)
    assert of_map.view.camera is held, "a chain that is open lets each go its own way"
    QTest.mouseClick(window.splitting["pane-1"].tools.chain, Qt.MouseButton.LeftButton)
    assert same_camera(of_map.view, window.target.view), "closed again, it takes the camera of the others"


def test_any_sequence_of_splits_keeps_every_view_in_one_place(window: MainWindow) -> None:
    chance = random.Random(5)
    splitting = window.splitting
    for _ in range(40):
        name = chance.choice([leaf.name for leaf in splitting.leaves])
        if chance.random() < 0.55:
            splitting.split(name, chance.choice(("right", "below")))
        elif name.startswith("pane"):
            splitting.close_view(name)
        leaves = [leaf.objectName() for grid in splitting.grids.values() for leaf in grid.leaves()]
        assert sorted(leaves) == sorted(leaf.name for leaf in splitting.leaves)
        assert len(splitting.panes) <= MOST_PANES
        layout, sides = splitting.layout(), {pane.objectName(): pane.side for pane in splitting.panes}
    splitting.arrange({}, {})
    assert [leaf.objectName() for leaf in window.grid.leaves()] == ["source", "target"]
    splitting.arrange(layout, sides)
    again = splitting.layout()
    assert {name: shape(tree) for name, tree in again.items()} == {name: shape(tree) for name, tree in layout.items()}


def test_views_that_are_closed_again_leave_the_others_as_large_as_they_were(window: MainWindow) -> None:
    splitting = window.splitting
    window.grid.root.setSizes([300, 600])
    stack = []
    for name, side in (("target", "right"), ("source", "below"), ("target", "below")):
        stack.append(sizes_of(window))
        assert splitting.split(name, side) is not None
    while stack:
        splitting.close_view(splitting.panes[-1].objectName())
        QTest.qWait(20)
        now, before = sizes_of(window), stack.pop()
        assert now.keys() == before.keys()
        assert all(np.abs(np.subtract(now[name], before[name])).max() <= 4 for name in now), (now, before)


def sizes_of(window: MainWindow) -> dict[str, tuple[int, int]]:
    """Width and height of each view of the centre, once it is laid out."""
    QTest.qWait(20)
    return {leaf.objectName(): leaf.size().toTuple() for leaf in window.grid.leaves()}


def shape(tree: dict) -> tuple:
    """A layout without its sizes."""
    return tree["split"], tuple(part if isinstance(part, str) else shape(part) for part in tree["parts"])


def test_lines_are_drawn_everywhere_or_in_one_view(window: MainWindow, qtbot: QtBot) -> None:
    pane = window.splitting.split("target", "right")
    assert pane is not None
    window.actions_by_name["boundary"].trigger()
    views = [leaf.view for leaf in window.splitting.leaves]
    qtbot.waitUntil(lambda: all(view.surface.lines.boundary.is_shown for view in views))
    choose(window, "pane-1", "Boundary")
    assert not pane.view.surface.lines.boundary.is_shown and window.target.view.surface.lines.boundary.is_shown
    before = pixels_of(window.target.view)
    window.actions_by_name["scale-bar"].trigger()
    qtbot.wait(30)
    after = pixels_of(window.target.view)
    changed = np.argwhere((before != after).any(axis=2))
    assert len(changed) and changed.min(axis=0)[0] > 0.8 * before.shape[0], "the bar stands in the lower corner"
    window.actions_by_name["wireframe"].trigger()
    qtbot.wait(50)
    assert (pixels_of(window.target.view) != after).any()
    for name in ("boundary", "scale-bar", "wireframe"):
        window.actions_by_name[name].trigger()


def test_a_range_of_a_views_own_leaves_the_others_alone(window: MainWindow, qtbot: QtBot) -> None:
    window.set_target_style("det")
    pane = window.splitting.split("target", "right")
    assert pane is not None
    shared = window.quantities.range_of("det")
    pane.legend.bar.own_wanted.emit(True)
    own = window.colouring.range_of(pane)
    own.set_ends(0.25, 0.5)
    own.set_clipped(True)
    assert own is not shared and pane.legend.bar.range is own and window.target.legend.bar.range is shared
    assert not shared.is_locked and not shared.is_clipped
    qtbot.wait(60)
    inside = pixel_of(pane.view, 6 * 21 + 10)
    red, green, blue = pixels_of(pane.view)[inside.y() - 3, inside.x() + 6]
    assert green > red and green > blue, "det 1 lies beyond the upper end, which is marked green"
    pane.legend.bar.own_wanted.emit(False)
    assert window.colouring.range_of(pane) is shared
