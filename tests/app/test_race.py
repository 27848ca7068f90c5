"""The race in the window: set-up, linked views, one clock, differences, switching, what is kept."""

from __future__ import annotations

import csv
import os
import signal
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, QPointF, Qt
from PySide6.QtGui import QWheelEvent
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication
from pytestqt.qtbot import QtBot

from tests.app.fake_race import InlineRaceWorker
from workbench.app.main_window import MainWindow
from workbench.app.race.race_window import RaceWindow
from workbench.app.race.racing import Racing
from workbench.app.race.set_up_dialog import RaceChoice, SetUpDialog
from workbench.core.mesh import Mesh
from workbench.engine.messages import SetAnchors, SetProblem, TakeMap
from workbench.engine.race_messages import Entrant

NEWTON = Entrant("Newton", "projected-newton")
AQP = Entrant("AQP", "aqp")
DESCENT = Entrant("Descent", "gradient-descent")
NO_ANCHORS = SetAnchors(np.empty(0, np.int64), np.empty((0, 2)), np.empty(0))


@pytest.fixture
def racing(window: MainWindow, qtbot: QtBot) -> Iterator[Racing]:
    """The grid with two anchors, one of them pulled; races run on the test's own thread."""
    made = window.commands.racing
    made.make_worker = InlineRaceWorker
    document = window.document
    document.add_anchor(0)
    document.add_anchor(document.mesh.vertex_count - 1)
    document.move_anchor(document.mesh.vertex_count - 1, document.positions[-1] + [0.2, 0.3], False)
    yield made
    made.close()
    QTest.qWait(20)
    assert made.race is None
    made._drafts.clear()
    document.clear_anchors()


def begin(racing: Racing, qtbot: QtBot, *entrants: Entrant, distortion: str = "", iterations: int = 25) -> RaceWindow:
    racing.begin(RaceChoice(entrants, distortion, True, iterations, 1e-9))
    race = racing.race
    assert race is not None
    qtbot.waitUntil(lambda: all(record.frame is not None for record in race.model.records))
    return race


def activate(race: RaceWindow) -> None:
    """Keys go to the active window only."""
    race.activateWindow()
    QTest.qWaitForWindowActive(race)
    QTest.qWait(50)  # shortcuts follow a moment later


def finish(race: RaceWindow, qtbot: QtBot) -> None:
    if not race.model.is_over:
        race.actions_by_name["run"].trigger()
    qtbot.waitUntil(lambda: race.model.is_over)
    settle(race, qtbot)


def settle(race: RaceWindow, qtbot: QtBot) -> None:
    """Until every view shows what is known."""
    qtbot.waitUntil(lambda: not race.grid.turns._stale)
    QTest.qWait(20)


# ----------------------------------------------------------------------------------------- set-up


@pytest.fixture
def dialog(racing: Racing, window: MainWindow, qtbot: QtBot) -> Iterator[SetUpDialog]:
    window.actions_by_name["race"].trigger()
    qtbot.waitUntil(lambda: racing.dialog is not None)
    made = racing.dialog
    yield made
    if racing.dialog is not None:
        made.reject()
    QApplication.processEvents()


def test_solvers_that_do_not_fit_are_grey_and_say_why(dialog: SetUpDialog) -> None:
    def listed() -> dict[str, tuple[bool, str]]:
        dialog._fill_menu()
        return {action.text(): (action.isEnabled(), action.toolTip()) for action in dialog.menu.actions()}

    assert len(dialog.drafts) >= 2 and dialog.race_button.isEnabled()
    enabled, tip = listed()["Local/global"]
    assert not enabled and "arap" in tip
    assert listed()["Gradient descent"][0]
    dialog.distortion_box.setCurrentIndex(dialog.distortion_box.findData("arap"))
    assert listed()["Local/global"][0]
    dialog.add_solver("local-global")
    assert dialog.race_button.isEnabled()
    dialog.distortion_box.setCurrentIndex(0)
    assert not dialog.race_button.isEnabled() and "arap" in dialog.error.text()


def test_a_preset_brings_its_distortion_and_parameters(dialog: SetUpDialog, qtbot: QtBot) -> None:
    for id in ("anderson", "acceleration"):
        dialog.preset.setCurrentIndex(dialog.preset.findData(id))
        dialog.preset.activated.emit(dialog.preset.currentIndex())
        if id == "anderson":
            assert dialog.distortion_box.currentData() == "arap" and dialog.race_button.isEnabled()
    assert dialog.drafts[1].parameters == {"accelerate": False}
    with qtbot.waitSignal(dialog.chosen) as caught:
        dialog.race_button.click()
    choice = caught.args[0]
    assert [entrant.solver for entrant in choice.entrants] == ["aqp", "aqp"]
    assert not choice.distortion  # that of another comparison does not stay


def test_names_differ_and_numbers_are_bounded(dialog: SetUpDialog) -> None:
    while len(dialog.drafts) < 6:
        dialog.add_solver("aqp")
    assert len({draft.label for draft in dialog.drafts}) == 6
    assert not dialog.add_button.isEnabled() and dialog.race_button.isEnabled()
    dialog.name.setText(dialog.drafts[0].label)
    dialog.name.textEdited.emit(dialog.drafts[0].label)
    assert not dialog.race_button.isEnabled() and dialog.drafts[0].label in dialog.error.text()
    dialog.tolerance.setText("soon")
    while dialog.drafts:
        dialog.remove_button.click()
    assert "2 to 6" in dialog.error.text()


def test_maps_from_files_take_part_and_others_are_refused(
    dialog: SetUpDialog, window: MainWindow, qtbot: QtBot, tmp_path: Path, square: Mesh
) -> None:
    mesh = window.document.mesh
    np.savez(tmp_path / "wide.npz", V=mesh.vertices, S=mesh.simplices, X=mesh.vertices * 1.5)
    np.savez(tmp_path / "other.npz", V=square.vertices, S=square.simplices, X=square.vertices)
    count = len(dialog.drafts)
    dialog.add_maps([str(tmp_path / "wide.npz")])
    qtbot.waitUntil(lambda: len(dialog.drafts) == count + 1)
    np.testing.assert_allclose(dialog.drafts[-1].map, mesh.vertices * 1.5)
    assert dialog.drafts[-1].label == "wide"
    dialog.add_maps([str(tmp_path / "other.npz"), str(tmp_path / "wide.npz"), str(tmp_path / "none.npz")])
    qtbot.waitUntil(lambda: len(dialog.drafts) == count + 2)
    qtbot.waitUntil(lambda: all(name in dialog.error.text() for name in ("other.npz", "none.npz")))


def test_the_documents_choices_go_to_the_start(racing: Racing, window: MainWindow, qtbot: QtBot) -> None:
    race = begin(racing, qtbot, NEWTON, Entrant("given", map=window.document.positions * 1.1))
    set_up = race.model.set_up
    np.testing.assert_array_equal(set_up.start, window.document.positions)
    np.testing.assert_array_equal(np.sort(set_up.anchors.vertices), np.sort(window.document.anchors.vertices))
    assert set_up.problem.distortion == window.document.session.distortion
    assert not window.document.is_running


# ----------------------------------------------------------------------------------------- race


def test_everyone_has_a_view_with_the_newest_map(racing: Racing, qtbot: QtBot) -> None:
    race = begin(racing, qtbot, NEWTON, AQP, DESCENT)
    finish(race, qtbot)
    assert [pane.name.text() for pane in race.grid.panes] == ["Newton", "AQP", "Descent"]
    for pane, record in zip(race.grid.panes, race.model.records, strict=True):
        shown = pane.geometry_shown.frame.to_display(record.frame.positions)
        np.testing.assert_allclose(pane.geometry_shown.points, shown, atol=1e-6)
        assert f"iteration {record.frame.iteration}" in pane.numbers.text()
    np.testing.assert_allclose(
        race.grid.panes[0].geometry_shown.frame.centre, race.grid.panes[1].geometry_shown.frame.centre
    )  # one frame, or linked cameras would show different places


def test_cameras_are_linked(racing: Racing, qtbot: QtBot) -> None:
    race = begin(racing, qtbot, NEWTON, AQP, DESCENT)
    settle(race, qtbot)
    views = [pane.view for pane in race.grid.panes]
    before = views[0].camera.half_height
    where = QPointF(30, 40)
    still = Qt.MouseButton.NoButton
    wheel = QWheelEvent(
        where, views[1].overlay.mapToGlobal(where), QPoint(), QPoint(0, 120), still,
        Qt.KeyboardModifier.NoModifier, Qt.ScrollPhase.NoScrollPhase, False,
    )  # fmt: skip
    QApplication.sendEvent(views[1].overlay, wheel)
    assert views[1].camera.half_height < before
    assert all(view.camera is views[1].camera for view in views)
    race.actions_by_name["fit"].trigger()
    assert views[0].camera.half_height == pytest.approx(before) and views[2].camera is views[0].camera


def test_all_views_share_one_range_of_colours(racing: Racing, qtbot: QtBot) -> None:
    race = begin(racing, qtbot, NEWTON, DESCENT)
    finish(race, qtbot)
    race.colours.fit()
    quantity = race.colours.quantity.id
    every = np.concatenate([record.frame.fields[quantity] for record in race.model.records])
    np.testing.assert_array_equal(race.colours.values, every)
    assert race.colours.range.low <= np.quantile(every, 0.02) and race.colours.range.high >= np.quantile(every, 0.98)
    assert race.legend.bar.range is race.colours.range


def test_the_curves_are_the_rows(racing: Racing, qtbot: QtBot) -> None:
    race = begin(racing, qtbot, NEWTON, AQP)
    finish(race, qtbot)
    race.curves.refresh()
    for index, record in enumerate(race.model.records):
        x, y = race.curves.curves["energy", index].getOriginalDataset()
        np.testing.assert_array_equal(x, record.history.column("iteration"))
        np.testing.assert_array_equal(y, record.history.column("energy"))
        seconds = record.history.column("seconds")
        assert (np.diff(seconds) > 0).all()
    race.timeline.axis.setCurrentIndex(race.timeline.axis.findData("seconds"))
    x, _ = race.curves.curves["energy", 0].getOriginalDataset()
    np.testing.assert_array_equal(x, race.model.records[0].history.column("seconds"))


@pytest.mark.parametrize("logarithmic", [False, True])
def test_a_given_map_is_a_level_line_over_the_whole_axis(
    racing: Racing, window: MainWindow, qtbot: QtBot, logarithmic: bool
) -> None:
    race = begin(racing, qtbot, NEWTON, Entrant("given", map=window.document.positions * 1.1))
    finish(race, qtbot)
    race.timeline.scales["x"].setChecked(logarithmic)
    race.curves.refresh()
    x, y = race.curves.curves["energy", 1].getOriginalDataset()
    assert y[0] == y[1] == race.model.records[1].history.column("energy")[0]
    (left, right), _ = race.curves._plots[0].getViewBox().viewRange()
    low, high = (10.0**left, 10.0**right) if logarithmic else (left, right)
    assert x[0] <= max(low, 0.0) and x[1] >= race.model.end_of("iteration") and high >= x[1]
    assert "iteration" not in race.grid.panes[1].numbers.text()


def test_the_slider_moves_all_views_back_and_live_brings_them_forth(racing: Racing, qtbot: QtBot) -> None:
    race = begin(racing, qtbot, NEWTON, DESCENT)
    finish(race, qtbot)
    model = race.model
    ends = [record.frame.positions for record in model.records]
    race.timeline.slider.setValue(0)
    qtbot.waitUntil(lambda: all(record.frame.iteration == 0 for record in model.records))
    settle(race, qtbot)
    for pane in race.grid.panes:
        np.testing.assert_allclose(
            pane.geometry_shown.points, pane.geometry_shown.frame.to_display(model.set_up.start), atol=1e-6
        )
        assert "iteration 0" in pane.numbers.text()
    assert not race.timeline.live.isChecked()
    activate(race)
    QTest.keyClick(race, Qt.Key.Key_L)
    qtbot.waitUntil(lambda: all(record.frame.iteration > 0 for record in model.records))
    assert all(np.array_equal(record.frame.positions, end) for record, end in zip(model.records, ends, strict=True))


def test_flipping_changes_places_and_back(racing: Racing, qtbot: QtBot) -> None:
    race = begin(racing, qtbot, NEWTON, DESCENT, AQP)
    finish(race, qtbot)
    activate(race)

    def shown() -> list[int]:
        settle(race, qtbot)
        for pane in race.grid.panes:
            frame = race.model.records[pane.shown].frame
            np.testing.assert_allclose(
                pane.geometry_shown.points, pane.geometry_shown.frame.to_display(frame.positions), atol=1e-6
            )
        return [pane.shown for pane in race.grid.panes]

    assert shown() == [0, 1, 2]
    QTest.keyClick(race, Qt.Key.Key_X)
    assert shown() == [1, 0, 2] and "flipped" in race.grid.panes[0].name.text()
    QTest.keyPress(race, Qt.Key.Key_Y)
    assert shown() == [0, 1, 2]
    QTest.keyRelease(race, Qt.Key.Key_Y)
    assert shown() == [1, 0, 2]
    race.compare.second.setCurrentIndex(2)
    assert shown() == [2, 1, 0]
    QTest.keyClick(race, Qt.Key.Key_X)
    assert shown() == [0, 1, 2]


def test_differences_are_to_the_map_of_a(racing: Racing, qtbot: QtBot) -> None:
    race = begin(racing, qtbot, NEWTON, DESCENT)
    finish(race, qtbot)
    colours, (a, b) = race.colours, [record.frame for record in race.model.records]
    race.compare.mode.setCurrentIndex(race.compare.mode.findData("displacement"))
    assert colours.values_of(0) is None
    mesh = race.model.mesh
    far = np.linalg.norm(b.positions - a.positions, axis=1)[mesh.simplices].mean(axis=1) / mesh.diameter
    np.testing.assert_allclose(colours.values_of(1), far, rtol=1e-5, atol=1e-9)
    race.compare.mode.setCurrentIndex(race.compare.mode.findData("difference"))
    id = colours.quantity.id
    np.testing.assert_allclose(colours.values_of(1), b.fields[id] - a.fields[id])
    assert colours.range.centre == 0.0
    race.compare.first.setCurrentIndex(1)
    np.testing.assert_allclose(colours.values_of(0), a.fields[id] - b.fields[id])
    assert colours.values_of(1) is None


def test_a_switch_is_marked_on_the_curves(racing: Racing, qtbot: QtBot) -> None:
    race = begin(racing, qtbot, NEWTON, DESCENT)
    finish(race, qtbot)
    rows = len(race.model.records[1].history)
    race.model.switch(1, "mips", "projected-newton", {}, SetProblem("mips"))
    qtbot.waitUntil(lambda: bool(race.model.records[1].frame.markers))
    finish(race, qtbot)
    race.curves.refresh()
    x, y = race.curves.markers["energy", 1].getOriginalDataset()
    record = race.model.records[1]
    assert len(x) == 1 and x[0] == record.history.column("iteration")[rows]
    assert y[0] == record.history.column("energy")[rows]
    assert race.curves._marks._shown == [(x[0], "Descent: mips")]
    assert record.entrant.solver == "projected-newton" and record.problem.distortion == "mips"
    race.model.switch(0, "no", "local-global", {}, None)
    qtbot.waitUntil(race.error_bar.isVisible)
    assert "arap" in race.error_bar.sentence.text()
    assert race.model.records[0].entrant.solver == "projected-newton"


def test_everyone_goes_on_with_the_anchors_of_the_document(racing: Racing, window: MainWindow, qtbot: QtBot) -> None:
    race = begin(racing, qtbot, NEWTON, DESCENT)
    finish(race, qtbot)
    document, model = window.document, race.model
    vertex = document.mesh.vertex_count - 1
    target = document.mesh.vertices[vertex, :2] + [0.4, -0.2]
    document.move_anchor(vertex, target, False)
    race.actions_by_name["anchors"].trigger()
    qtbot.waitUntil(lambda: all(record.frame.markers for record in model.records))
    finish(race, qtbot)
    np.testing.assert_allclose(model.records[0].frame.positions[vertex], target, atol=1e-9)
    for record, pane in zip(model.records, race.grid.panes, strict=True):
        (marker,) = record.frame.markers
        assert "2 anchors" in marker.sentence
        assert record.terms[marker.index] != record.terms[0]  # another energy: no error to the best of before
        row = np.flatnonzero(pane.view.overlay.scene.anchor_vertices == vertex)
        shown = pane.geometry_shown.frame.to_display(target[None])
        np.testing.assert_allclose(pane.view.overlay.scene.anchor_points[row], shown, atol=1e-6)


def test_the_arrow_keys_go_through_time(racing: Racing, qtbot: QtBot) -> None:
    race = begin(racing, qtbot, NEWTON, DESCENT)
    finish(race, qtbot)
    activate(race)
    end, descent = race.model.end_of("iteration"), race.model.records[1]
    QTest.keyClick(race, Qt.Key.Key_Left)
    qtbot.waitUntil(lambda: descent.frame.iteration == end - 1)
    settle(race, qtbot)
    assert f"{end - 1:.0f} of {end:.0f}" in race.grid.panes[1].numbers.text()
    QTest.keyClick(race, Qt.Key.Key_Left, Qt.KeyboardModifier.ShiftModifier)
    qtbot.waitUntil(lambda: descent.frame.iteration == end - 11)
    for _ in range(11):
        QTest.keyClick(race, Qt.Key.Key_Right)
    qtbot.waitUntil(lambda: descent.frame.iteration == end)
    assert race.model.is_live
    QTest.keyClick(race, Qt.Key.Key_W, Qt.KeyboardModifier.ControlModifier)
    qtbot.waitUntil(lambda: racing.race is None)


def test_maps_that_have_shrunk_are_fitted_once_more(racing: Racing, window: MainWindow, qtbot: QtBot) -> None:
    race = begin(racing, qtbot, NEWTON, DESCENT, iterations=200)
    race.begin(replace(race.model.set_up, start=window.document.positions * 6.0, anchors=NO_ANCHORS))
    qtbot.waitUntil(lambda: all(record.frame is not None for record in race.model.records))
    before = race.grid.panes[0].view.camera.half_height
    finish(race, qtbot)
    view = race.grid.panes[0].view
    extents = np.ptp(np.concatenate([view.project(pane.geometry_shown.points) for pane in race.grid.panes]), axis=0)
    assert view.camera.half_height < 0.5 * before
    assert 0.5 < (extents / view.size_in_pixels).max() < 1.0


def test_colours_follow_the_distortion_of_another_race(racing: Racing, qtbot: QtBot) -> None:
    race = begin(racing, qtbot, NEWTON, DESCENT)
    racing.begin(RaceChoice((NEWTON, AQP), "mips", True, 5, 1e-9))
    assert race.colours.quantity.id == race.compare.chooser.current == "mips"
    qtbot.waitUntil(lambda: all(r.frame is not None and "mips" in r.frame.fields for r in race.model.records))


def test_a_contestant_that_fails_says_so_and_the_others_race(racing: Racing, qtbot: QtBot) -> None:
    race = begin(racing, qtbot, NEWTON, Entrant("wrong", "local-global"))
    finish(race, qtbot)
    assert race.grid.panes[1].phase.text() == "failed" and "arap" in race.grid.panes[1].numbers.text()
    assert race.model.records[0].frame.phase == "finished"


def test_the_document_takes_a_map(racing: Racing, window: MainWindow, qtbot: QtBot) -> None:
    race = begin(racing, qtbot, NEWTON, DESCENT)
    finish(race, qtbot)
    race.grid.panes[0].take_action.trigger()
    taken = [command for command in window.bridge._worker.commands if isinstance(command, TakeMap)]
    assert len(taken) == 1 and taken[0].generation == window.document.generation
    np.testing.assert_array_equal(taken[0].positions, race.model.records[0].frame.positions)
    window.open("grid")
    qtbot.waitUntil(lambda: not window.document.opening_source)
    race.grid.panes[0].take_action.trigger()
    assert "another mesh" in race.error_bar.sentence.text()
    assert sum(isinstance(command, TakeMap) for command in window.bridge._worker.commands) == 1


def test_restart_and_other_contestants_begin_anew(racing: Racing, qtbot: QtBot) -> None:
    race = begin(racing, qtbot, NEWTON, DESCENT, AQP)
    assert race.windowTitle().startswith("Race: ") and len(race.windowTitle()) > len("Race: "), "of which mesh"
    finish(race, qtbot)
    race.actions_by_name["restart"].trigger()
    qtbot.waitUntil(lambda: all(r.frame is not None and r.iterations == 0 for r in race.model.records))
    assert all(len(record.history) == 1 for record in race.model.records)
    racing.begin(RaceChoice((AQP, NEWTON), "arap", True, 10, 1e-6))
    qtbot.waitUntil(lambda: all(record.frame is not None for record in race.model.records))
    assert [pane.name.text() for pane in race.grid.panes] == ["AQP", "Newton"]
    finish(race, qtbot)
    assert race.model.set_up.problem.distortion == "arap"


def test_tables_and_curves_are_kept(racing: Racing, qtbot: QtBot, tmp_path: Path) -> None:
    race = begin(racing, qtbot, NEWTON, DESCENT)
    finish(race, qtbot)
    with qtbot.waitSignal(race.saver.saved):
        race.saver.save(str(tmp_path))
    with open(tmp_path / "table.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["contestant"] for row in rows] == ["Newton", "Descent"]
    assert float(rows[0]["energy"]) == race.model.records[0].history.column("energy")[-1]
    with open(tmp_path / "history.csv", newline="") as file:
        assert sum(1 for _ in csv.DictReader(file)) == sum(len(record.history) for record in race.model.records)
    assert all((tmp_path / f"curves.{ending}").stat().st_size > 1000 for ending in ("svg", "pdf", "png"))
    race.saver.save(str(tmp_path / "table.csv" / "no"))
    qtbot.waitUntil(race.error_bar.isVisible)


def test_themes_reach_the_race(racing: Racing, window: MainWindow, qtbot: QtBot) -> None:
    race = begin(racing, qtbot, NEWTON, DESCENT)
    window.commands.choose_theme("dark")
    try:
        assert race.theme.is_dark and race.grid.panes[0].view.theme.is_dark
    finally:
        window.commands.choose_theme("light")


# ----------------------------------------------------------------------------------------- a process of its own


def test_a_killed_process_is_said_and_the_race_begins_anew(racing: Racing, qtbot: QtBot) -> None:
    racing.make_worker = None
    racing.begin(RaceChoice((NEWTON, DESCENT), "", True, 100_000, 0.0))
    race = racing.race
    model = race.model
    qtbot.waitUntil(lambda: all(record.frame is not None for record in model.records))
    race.actions_by_name["run"].trigger()
    qtbot.waitUntil(lambda: model.records[1].iterations > 5)
    assert model.is_running and race.actions_by_name["run"].text() == "Pause"
    os.kill(model.bridge._worker.process_id, signal.SIGKILL)
    qtbot.waitUntil(race.error_bar.isVisible)
    assert "killed" in race.error_bar.sentence.text() and not model.is_running
    assert not race.actions_by_name["run"].isEnabled()
    kept = model.records[0].frame.positions
    assert kept is not None  # what was shown stays
    race.actions_by_name["restart"].trigger()
    qtbot.waitUntil(lambda: model.is_ready and all(r.frame is not None for r in model.records))
    assert race.error_bar.isHidden()
    race.actions_by_name["step"].trigger()
    qtbot.waitUntil(lambda: all(record.iterations == 1 for record in model.records))
