"""The window with a fake engine and a real mouse."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QMimeData, QPoint, QPointF, Qt, QUrl
from PySide6.QtGui import QDropEvent, QImage, QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu
from pytestqt.qtbot import QtBot

from tests.app.conftest import Hand, WindowMaker, pixel_of, pixels_of
from workbench.app.handling.anchor_tool import DRAG_INTERVAL
from workbench.app.main_window import MainWindow
from workbench.app.menus import fill_samples
from workbench.app.views.mesh_view import MeshView
from workbench.core.status import Status
from workbench.engine.messages import Load, Pause, Reset, Run, SetAnchors, SetProblem, SetSolver, Step


def commands(window: MainWindow, kind: type) -> list:
    return [c for c in window.bridge._worker.commands if isinstance(c, kind)]


def test_opens_with_source_target_and_panels(window: MainWindow, qtbot: QtBot) -> None:
    assert window.source.view.geometry_shown is not None
    assert window.target.view.geometry_shown is not None
    qtbot.waitUntil(lambda: len(window.histogram.counts) > 0)
    qtbot.waitUntil(lambda: all(dock.legend.numbers.text() for dock in window.maps))
    assert "480 triangles" in window.source.caption.text()


def test_a_click_sets_an_anchor_in_either_view_and_both_show_it(window: MainWindow) -> None:
    Hand(window.target.view).click(pixel_of(window.target.view, 0))
    Hand(window.source.view).click(pixel_of(window.source.view, 272))
    assert window.document.anchors.vertices.tolist() == [0, 272]
    for pane in (window.source, window.target):
        assert pane.view.overlay.scene.anchor_vertices.tolist() == [0, 272]
    assert window.document.selected == 272


def test_hovering_shows_the_vertex_in_both_views(window: MainWindow, qtbot: QtBot) -> None:
    Hand(window.source.view).move(pixel_of(window.source.view, 136) + QPoint(3, 2))
    QTest.qWait(20)
    for pane in (window.source, window.target):
        assert pane.view.overlay.scene.hovered == 136
    window.open("grid")
    qtbot.waitUntil(lambda: window.target.view.geometry_shown is not None and not window.document.opening_source)
    QTest.qWait(20)
    for pane in (window.source, window.target):
        assert pane.view.overlay.scene.hovered_point is None, "the mark is of the mesh before"


def test_a_vertex_that_has_left_the_view_is_not_named_at_its_edge(window: MainWindow) -> None:
    view = window.source.view
    scene = view.overlay.scene

    def name_shows() -> bool:
        named = pixels_of(view)
        vertex, scene.hovered = scene.hovered, -1
        differs = bool((named != pixels_of(view)).any())
        scene.hovered = vertex
        return differs

    window.presenter.hover(0)  # a pointer that rests elsewhere on the screen may be told of at any time
    assert name_shows()
    far = pixel_of(view, 272)
    view.set_camera(view.camera.zoomed(20.0, (far.x(), far.y()), view.size_in_pixels))
    window.presenter.hover(0)
    assert not view.rect().contains(pixel_of(view, 0)) and not name_shows()
    window.commands.fit()


def test_dragging_moves_the_map_and_the_histogram(window: MainWindow, qtbot: QtBot) -> None:
    target = window.target.view
    hand = Hand(target)
    hand.click(pixel_of(target, 0))
    QTest.keyClick(window, Qt.Key.Key_Space)
    qtbot.waitUntil(lambda: len(window.histogram.counts) > 0)
    before = window.document.positions
    counts = window.histogram.counts.copy()
    begin = pixel_of(target, 272)
    hand.drag(begin, begin + QPoint(-40, 30))
    qtbot.waitUntil(lambda: not np.allclose(window.document.positions, before))
    qtbot.waitUntil(lambda: not np.array_equal(window.histogram.counts, counts))
    sent = commands(window, SetAnchors)
    assert any(c.dragging for c in sent)
    assert not sent[-1].dragging, "the last one says that the hand let go"
    assert [c.serial for c in sent] == sorted({c.serial for c in sent})
    moved = window.document.anchors.targets[272]
    np.testing.assert_allclose(moved, target.position_at((begin.x() - 40.0, begin.y() + 30.0)), atol=0.02)
    assert window.reporter.drag_meter.recent is not None


def test_a_map_that_went_out_of_sight_is_fitted_unless_somebody_looks_elsewhere(window: MainWindow) -> None:
    view, positions = window.target.view, window.document.positions
    width = np.ptp(positions, axis=0).max()
    camera = view.camera
    for away, is_fitted in (
        ([0.4 * width, 0.0], False),
        ([0.0, 9.0 * width], True),
        ([-90.0 * width, 0.0], True),
        ([1.0 * width, 1.0 * width], True),
    ):
        view.fit()
        view.geometry_shown.write(positions + away)
        view.points_changed()
        before = view.camera
        view.fit_if_it_is_gone()
        assert (view.camera is not before) == is_fitted
        at = view.project(view.geometry_shown.points)
        assert (at.max(axis=0) > 0).all() and (at.min(axis=0) < view.size_in_pixels).all()
        view.geometry_shown.write(positions)
    view.set_camera(replace(camera, focal=camera.focal + [50.0, 0.0, 0.0]))
    chosen = view.camera
    view.fit_if_it_is_gone()
    assert view.camera is chosen
    view.fit()


def test_a_map_that_rests_fills_its_views_while_one_that_moves_may_breathe(window: MainWindow) -> None:
    positions = window.document.positions
    middle = 0.5 * (positions.min(axis=0) + positions.max(axis=0))
    geometry = window.target.view.geometry_shown
    for view in (window.target.view, *(dock.view for dock in window.maps)):
        for phase, size, is_fitted in (
            ("running", 0.6, False),
            ("running", 0.3, True),
            ("idle", 0.6, True),
            ("finished", 0.6, True),
        ):
            geometry.write(positions)
            view.fit()
            before = view.camera
            geometry.write(middle + size * (positions - middle))
            view.points_changed()
            view.fit_if_it_left(phase)
            assert (view.camera is not before) == is_fitted
            filled = np.ptp(view.project(geometry.points), axis=0) / view.size_in_pixels
            assert (filled.max() > 0.8) == is_fitted
    geometry.write(positions)
    window.presenter.refit_target()


def test_a_drag_is_passed_on_at_most_sixty_times_a_second(window: MainWindow, qtbot: QtBot) -> None:
    target, throttle = window.target.view, window.target_tool._throttle
    assert throttle.interval() >= 16
    throttle.setInterval(500)  # the law at a pace that a slow machine keeps, too
    hand = Hand(target)
    begin = pixel_of(target, 272)
    hand.move(begin)
    hand.press(begin)
    started = time.perf_counter()
    count = len(commands(window, SetAnchors))
    for step in range(50):
        hand.move(begin - QPoint(step + 3, 0))
        qtbot.wait(1)
    assert len(commands(window, SetAnchors)) - count <= (time.perf_counter() - started) / 0.5 + 2
    hand.release(begin - QPoint(53, 0))
    throttle.setInterval(DRAG_INTERVAL)
    expected = target.position_at((begin.x() - 53.0, float(begin.y())))
    np.testing.assert_allclose(window.document.anchors.targets[272], expected, atol=0.02)


def test_right_click_and_delete_remove_anchors(window: MainWindow) -> None:
    target = window.target.view
    hand = Hand(target)
    for vertex in (0, 20, 272):
        hand.click(pixel_of(target, vertex))
    hand.click(pixel_of(target, 20), Qt.MouseButton.RightButton)
    assert window.document.anchors.vertices.tolist() == [0, 272]
    QTest.keyClick(window, Qt.Key.Key_Delete)
    assert window.document.anchors.vertices.tolist() == [0]
    window.actions_by_name["clear"].trigger()
    assert not len(window.document.anchors)


def test_pin_boundary(window: MainWindow, qtbot: QtBot) -> None:
    window.actions_by_name["pin"].trigger()
    qtbot.waitUntil(lambda: len(window.document.anchors) == 2 * (20 + 12))


def test_wheel_zooms_and_middle_drag_pans_and_double_click_fits(window: MainWindow) -> None:
    view = window.target.view
    at = pixel_of(view, 40)
    scale = view.camera.half_height
    where = QPointF(at)
    wheel = QWheelEvent(
        where, view.overlay.mapToGlobal(where), QPoint(), QPoint(0, 240), Qt.MouseButton.NoButton,
        Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False,
    )  # fmt: skip
    QApplication.sendEvent(view.overlay, wheel)
    assert view.camera.half_height == pytest.approx(scale / 1.44)
    assert (pixel_of(view, 40) - at).manhattanLength() <= 1
    Hand(view).drag(at, at + QPoint(50, 20), Qt.MouseButton.MiddleButton)
    assert (pixel_of(view, 40) - at - QPoint(50, 20)).manhattanLength() <= 2
    QTest.mouseDClick(view.overlay, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, QPoint(4, 4))
    assert view.camera.half_height == pytest.approx(scale, rel=1e-3)


def test_a_surface_in_space_turns_and_still_takes_anchors(window: MainWindow, qtbot: QtBot) -> None:
    window.open("bumpy")
    qtbot.waitUntil(lambda: window.document.kind == "parameterize" and window.document.positions is not None)
    view = window.source.view
    axes = view.camera.axes.copy()
    Hand(view).drag(QPoint(10, 10), QPoint(60, 40))
    assert not np.allclose(view.camera.axes, axes)
    assert not len(window.document.anchors)
    vertex = view.vertex_at((view.width() / 2, view.height() / 2))
    assert vertex >= 0
    Hand(view).click(pixel_of(view, vertex))
    assert window.document.anchors.vertices.tolist() == [vertex]


def test_keys_run_pause_step_reset(window: MainWindow) -> None:
    QTest.keyClick(window, Qt.Key.Key_Space)
    assert len(commands(window, Run)) == 1
    assert window.actions_by_name["run"].text() == "Pause"
    QTest.keyClick(window, Qt.Key.Key_Space)
    assert len(commands(window, Pause)) == 1
    QTest.keyClick(window, Qt.Key.Key_Period)
    assert len(commands(window, Step)) == 1
    QTest.keyClick(window, Qt.Key.Key_Home)
    assert len(commands(window, Reset)) == 1


def test_choices_become_commands_while_it_runs(window: MainWindow) -> None:
    window.document.run()
    combo = window.panel.distortion.combo
    row = combo.findData("mips")
    assert row >= 0
    combo.setCurrentIndex(row)
    combo.activated.emit(row)
    assert commands(window, SetProblem)[-1].distortion == "mips"
    window.panel.boundary.setCurrentIndex(1)
    window.panel.boundary.activated.emit(1)
    assert commands(window, SetProblem)[-1].fixed_boundary
    assert not commands(window, SetProblem)[-1].allow_inversions
    window.panel.inversions.setCurrentIndex(1)
    window.panel.inversions.activated.emit(1)
    assert commands(window, SetProblem)[-1].allow_inversions
    row = window.panel.solver.combo.findData("gradient-descent")
    window.panel.solver.combo.setCurrentIndex(row)
    window.panel.solver.combo.activated.emit(row)
    assert commands(window, SetSolver)[-1].solver == "gradient-descent"
    window.panel.scale.setCurrentIndex(1)
    window.panel.scale.activated.emit(1)
    assert commands(window, Reset)[-1].match_area is False


def test_a_refusal_offers_its_fix_and_the_fix_opens(window: MainWindow, qtbot: QtBot) -> None:
    window.open("closed")
    qtbot.waitUntil(window.error_bar.isVisible)
    assert "cut" in window.error_bar.sentence.text()
    QTest.mouseClick(window.error_bar.fix_buttons[0], Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: window.document.session.fixes == ("cut",))
    assert commands(window, Load)[-1].fixes == ("cut",)
    assert window.source.view.surface.lines.cut.is_shown


def test_a_refused_file_leaves_the_present_map_alive(window: MainWindow, qtbot: QtBot) -> None:
    window.open("closed")
    qtbot.waitUntil(window.error_bar.isVisible)
    before = window.document.snapshot.number
    window.document.step()
    qtbot.waitUntil(lambda: window.document.snapshot.number > before)


def test_failures_show_their_traceback_in_the_details(window: MainWindow, qtbot: QtBot) -> None:
    window.open("raises")
    qtbot.waitUntil(window.error_bar.isVisible)
    window.error_bar.details_button.click()
    assert "Traceback" in window.error_bar.details.toPlainText()
    assert window.error_bar.details.isVisible()


def test_stop_ends_what_hangs_and_says_so(window: MainWindow, qtbot: QtBot) -> None:
    window.actions_by_name["stop"].trigger()
    assert window.bridge._worker.stop_count > 0
    qtbot.waitUntil(window.error_bar.isVisible)


def test_a_dropped_file_is_opened(window: MainWindow, tmp_path: Path) -> None:
    path = tmp_path / "bumpy.obj"
    path.write_text("")
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path))])
    drop = QDropEvent(
        QPointF(50, 50), Qt.DropAction.CopyAction, data, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier
    )
    window.dropEvent(drop)
    assert commands(window, Load)[-1].source == str(path)


def test_recent_files_and_screenshots(window: MainWindow, tmp_path: Path, qtbot: QtBot) -> None:
    path = tmp_path / "grid.obj"
    path.write_text("")
    window.open(str(path))
    qtbot.waitUntil(lambda: window.document.session.source == str(path))
    assert window.settings.recent_files[0] == str(path)
    for number, widget in enumerate((window, window.source.view)):
        shot = tmp_path / f"shot-{number}.png"
        window.commands.save_screenshot(widget, str(shot))
        qtbot.waitUntil(lambda path=shot: path.is_file() and path.stat().st_size > 1000)


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_views_and_plots_follow_the_theme(make_window: WindowMaker, qtbot: QtBot, theme: str) -> None:
    window = make_window(theme=theme)
    qtbot.waitUntil(lambda: window.document.positions is not None)
    QTest.qWait(150)
    picture = window.target.view.grab().toImage()
    colour = picture.pixelColor(3, 3)
    assert (colour.lightness() < 80) == (theme == "dark")
    other = "dark" if theme == "light" else "light"
    window.commands.choose_theme(other)
    QTest.qWait(150)
    assert (window.target.view.grab().toImage().pixelColor(3, 3).lightness() < 80) == (other == "dark")


def test_inverted_triangles_are_drawn_yellow(window: MainWindow, qtbot: QtBot) -> None:
    target = window.target.view
    hand = Hand(target)
    hand.click(pixel_of(target, 0))
    hand.click(pixel_of(target, 272))
    begin = pixel_of(target, 136)
    hand.drag(begin, QPoint(pixel_of(target, 272).x(), begin.y()), steps=4)  # the middle is folded over the right half
    qtbot.waitUntil(lambda: window.document.snapshot.inverted.any())
    for view in (target, window.source.view):
        qtbot.waitUntil(lambda v=view: yellow_pixels(v) > 10)
    window.set_source_style("det")  # factors from below 0 on a logarithmic scale
    qtbot.waitUntil(lambda: "det" in window.document.snapshot.fields)
    QTest.qWait(100)
    assert yellow_pixels(window.source.view) > 10
    window.set_source_style("checkerboard")


def yellow_pixels(view: MeshView) -> int:
    """Pixels of the colour of inverted triangles, also where a dark field of the board lies over it."""
    image = view.grab().toImage().convertToFormat(QImage.Format.Format_RGB888)
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    red, green, blue = np.moveaxis(rows[:, : 3 * image.width()].reshape(image.height(), -1, 3), 2, 0).astype(int)
    return int(((red > 90) & (green > 0.7 * red) & (blue < 0.4 * red)).sum())


def test_only_views_that_are_to_be_seen_are_drawn(window: MainWindow, qtbot: QtBot) -> None:
    dock = window.maps[0]
    dock.hide()
    qtbot.waitUntil(lambda: not dock.view.isVisible())
    QTest.qWait(150)
    drawn = []
    dock.view.drawn.connect(lambda: drawn.append(1))
    hand = Hand(window.target.view)
    begin = pixel_of(window.target.view, 272)
    hand.drag(begin, begin + QPoint(-20, 10))
    dock.show()
    assert not drawn


def test_the_menu_names_the_samples(window: MainWindow) -> None:
    menu = QMenu(window)
    fill_samples(window, menu)
    names = [action.text() for action in menu.actions()]
    assert {"Gingerbread man", "Ball"} <= set(names)


def test_a_step_that_lasts_is_named_with_the_way_out(window: MainWindow, monkeypatch: pytest.MonkeyPatch, qtbot: QtBot) -> None:
    monkeypatch.setattr("workbench.app.status.reporter.LONG_STEP", 0.0)
    window.document.run()
    qtbot.waitUntil(lambda: "Stop ends it" in window.status.sentence.text())
    window.document.pause()
    qtbot.waitUntil(lambda: "Stop ends it" not in window.status.sentence.text())


def test_a_run_from_an_inverted_start_says_what_unfolds_it(window: MainWindow) -> None:
    """Where it is seen: the status line shows a tip while the pointer is on Run."""
    rested = window.document.snapshot
    window.document._take_snapshot(replace(rested, phase="finished", status=Status.INVERTED_START))
    assert not window.error_bar.isHidden()
    assert "Symmetric Dirichlet, filtered barrier, which unfolds them" in window.error_bar.sentence.text()
    window.document._take_snapshot(replace(rested, phase="running", status=Status.RUNNING))
    assert window.error_bar.isHidden(), "it has been heeded"
