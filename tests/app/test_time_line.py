"""The time line: maps are kept as they come, looked back at, gone on from, compared, filmed; the newest stays what it is."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image
from PySide6.QtCore import QObject, Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from tests.app.fake_engine import grid_mesh
from workbench.app.document.anchor_set import AnchorSet
from workbench.app.document.document import Document
from workbench.app.main_window import MainWindow
from workbench.app.timeline import player
from workbench.app.timeline.comparison import compare
from workbench.app.timeline.film_plan import frames_of
from workbench.app.timeline.looking_back import Measurer
from workbench.app.timeline.time_line import TimeLine
from workbench.core.errors import WorkbenchError
from workbench.core.measure import Measure
from workbench.engine.messages import Reset
from workbench.session.moments import Moment, MomentRecord

CORNERS = (0, 20)


@pytest.fixture
def line(window: MainWindow, qtbot: QtBot) -> TimeLine:
    """The time line of a window in which a corner of the grid was pulled, bit by bit."""
    window.time_line.dock.show()
    document = window.document
    for vertex in CORNERS:
        document.add_anchor(vertex)
    pull(document, 6)
    settle(window, qtbot)
    return window.time_line


def pull(document: Document, count: int) -> None:
    target = np.array(document.anchors.targets[CORNERS[1]])
    for step in range(1, count + 1):
        document.move_anchor(CORNERS[1], target + [0.08 * step, 0.02 * step], dragging=step < count)
        QTest.qWait(20)  # reports are taken at most once in 12 ms


def settle(window: MainWindow, qtbot: QtBot) -> None:
    qtbot.waitUntil(lambda: window.document.snapshot.anchor_serial == window.document.anchor_serial)


def look(line: TimeLine, qtbot: QtBot, index: int) -> Moment:
    """Show a moment, and wait until the views do."""
    moment = line.recorder.record[index]
    line.looking.show(index)
    document = line._document
    qtbot.waitUntil(lambda: document.shown.phase == "past" and np.array_equal(document.shown.positions, moment.positions))
    return moment


def drawn(window: MainWindow) -> np.ndarray:
    """Where the target draws the vertices, in units of the mesh."""
    geometry = window.target.view.geometry_shown
    return geometry.vertices[:, :2] / geometry.frame.scale + geometry.frame.centre


# ---------------------------------------------------------------------------------------------- looking back


def test_maps_are_kept_as_they_come(line: TimeLine, window: MainWindow, qtbot: QtBot) -> None:
    record = line.recorder.record
    assert len(record) >= 5
    assert np.array_equal(record[-1].positions, window.document.positions)
    assert np.allclose(record[0].positions, grid_mesh().vertices)
    window.open("bumpy")
    qtbot.waitUntil(lambda: window.document.kind == "parameterize" and window.document.positions is not None)
    assert len(record) <= 2, "another mesh begins anew"


def test_looking_back_shows_an_earlier_map_everywhere_and_changes_nothing(
    line: TimeLine, window: MainWindow, qtbot: QtBot
) -> None:
    document = window.document
    window.set_target_style("det")
    qtbot.waitUntil(lambda: "det" in document.snapshot.fields)
    newest, kept = document.positions, len(line.recorder.record)
    pictures = line.badges()
    assert all(badge.isHidden() for badge in pictures.values())
    moment = look(line, qtbot, 2)
    assert np.allclose(drawn(window), moment.positions, atol=1e-5)
    edges = moment.positions[document.mesh.simplices[:, 1:]] - moment.positions[document.mesh.simplices[:, :1]]
    before = document.mesh.vertices[document.mesh.simplices[:, 1:]] - document.mesh.vertices[document.mesh.simplices[:, :1]]
    assert np.allclose(window.target.view.surface._values, np.linalg.det(edges) / np.linalg.det(before), rtol=1e-3)
    qtbot.waitUntil(lambda: window.histogram.counts.sum() == document.mesh.simplex_count)
    assert all(badge.isVisible() and "Past" in badge.text() for view, badge in pictures.items() if view.isVisible())
    assert document.positions is newest
    assert len(line.recorder.record) == kept
    line.looking.go_live()
    assert np.allclose(drawn(window), newest, atol=1e-5)
    assert all(badge.isHidden() for badge in pictures.values())
    window.set_target_style("plain")


def test_the_solver_goes_on_while_somebody_looks_back(line: TimeLine, window: MainWindow, qtbot: QtBot) -> None:
    moment = look(line, qtbot, 1)
    kept = len(line.recorder.record)
    worker = window.bridge._worker
    worker._positions = worker._positions * 1.1
    worker._publish()
    qtbot.waitUntil(lambda: len(line.recorder.record) == kept + 1)
    assert not line.looking.is_live
    assert np.allclose(drawn(window), moment.positions, atol=1e-5)
    line.looking.go_live()
    assert np.allclose(drawn(window), worker._positions, atol=1e-5)


def test_views_that_want_other_colours_get_them_of_the_same_moment(line: TimeLine, window: MainWindow, qtbot: QtBot) -> None:
    look(line, qtbot, 1)
    window.set_target_style("sigma1")
    qtbot.waitUntil(lambda: "sigma1" in window.document.shown.fields)
    assert window.document.shown.phase == "past"
    window.set_target_style("plain")


def test_whatever_is_done_is_done_to_the_newest_map(line: TimeLine, window: MainWindow, qtbot: QtBot) -> None:
    newest = window.document.positions
    look(line, qtbot, 1)
    window.document.add_anchor(70)
    assert line.looking.is_live
    assert np.allclose(window.document.anchors.targets[70], newest[70])
    look(line, qtbot, 1)
    window.undoing.undo()
    assert line.looking.is_live
    qtbot.waitUntil(lambda: 70 not in window.document.anchors)


def test_going_on_takes_map_and_anchors_and_is_one_step(line: TimeLine, window: MainWindow, qtbot: QtBot) -> None:
    document = window.document
    newest, anchors = document.positions, document.anchors
    moment = look(line, qtbot, 4)
    positions = moment.positions.copy()
    line.go_on()
    assert line.looking.is_live
    qtbot.waitUntil(lambda: np.array_equal(document.positions, positions))
    assert document.anchors == moment.belongings != anchors
    assert window.undoing.history.undo_name == "Take a map"
    window.undoing.undo()
    qtbot.waitUntil(lambda: np.array_equal(document.positions, newest))
    assert document.anchors == anchors


def test_a_rounded_map_that_flips_is_not_gone_on_from(line: TimeLine, window: MainWindow, qtbot: QtBot) -> None:
    moment = look(line, qtbot, 2)
    flipped = moment.positions.astype(np.float32)
    flipped[5], flipped[6] = flipped[6].copy(), flipped[5].copy()
    moment.positions_kept = flipped
    newest = window.document.positions
    line.go_on()
    assert window.document.positions is newest
    assert "single precision" in window.error_bar.sentence.text()
    window.error_bar.dismiss()
    line.looking.go_live()


# ---------------------------------------------------------------------------------------------- the panel


def test_keys_of_the_slider_are_its_own(line: TimeLine, window: MainWindow, qtbot: QtBot) -> None:
    slider, looking = line.dock.slider, line.looking
    count = len(line.recorder.record)
    slider.setFocus()
    window.bridge._worker.commands.clear()
    key = Qt.Key
    for pressed, expected in (
        (key.Key_Left, count - 2), (key.Key_Left, count - 3), (key.Key_Right, count - 2), (key.Key_Home, 0),
        (key.Key_Left, 0), (key.Key_End, count - 1), (key.Key_Home, 0), (key.Key_L, count - 1),
    ):  # fmt: skip
        QTest.keyClick(slider, pressed)
        assert looking.index == expected
    QTest.keyClick(slider, key.Key_Left, Qt.KeyboardModifier.ShiftModifier)
    assert looking.index == max(count - 11, 0)
    assert not any(isinstance(command, Reset) for command in window.bridge._worker.commands)
    for name, place in (("A", 1), ("B", 3)):
        looking.show(place)
        QTest.keyClick(slider, getattr(key, f"Key_{name}"))
    QTest.keyClick(slider, key.Key_X)
    assert looking.index == 1
    QTest.keyClick(slider, key.Key_X)
    assert looking.index == 3
    line.mark("B")
    assert set(slider.marked) == {"A"}, "the same once more lets it go"
    looking.go_live()


def test_the_mouse_goes_to_the_nearest_moment(line: TimeLine, qtbot: QtBot) -> None:
    slider, record = line.dock.slider, line.recorder.record
    qtbot.waitUntil(lambda: slider.width() > 200)
    for index in (1, len(record) // 2):
        place = slider.rect().center()
        place.setX(round(slider._x(record[index].time)))
        QTest.mouseClick(slider, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, place)
        assert abs(record[line.looking.index].time - record[index].time) < 0.02 * record.end
    place.setX(slider.width() - 1)
    QTest.mouseClick(slider, Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, place)
    assert line.looking.is_live


def test_what_the_user_did_is_noted(line: TimeLine, window: MainWindow, qtbot: QtBot) -> None:
    def notes() -> list[str]:
        return [note for moment in line.recorder.record for note in moment.notes]

    assert any("anchor" in note for note in notes())
    before = notes()
    document = window.document
    target = np.array(document.anchors.targets[CORNERS[1]])
    document.move_anchor(CORNERS[1], target + 0.1, dragging=True)
    assert len(notes()) == len(before) + 1
    document.move_anchor(CORNERS[1], target, dragging=False)
    assert notes() == before, "a drag that was taken back is nothing"
    settle(window, qtbot)
    document.choose(solver="slim")
    assert "locally injective" in notes()[-1]
    window.undoing.undo()
    assert "locally injective" in notes()[-1]
    assert len(notes()) == len(before) + 2
    settle(window, qtbot)
    window.undoing.redo()
    assert len(notes()) == len(before) + 3
    document.choose(solver="projected-newton")


def test_it_is_played_to_its_end(line: TimeLine, qtbot: QtBot) -> None:
    line.player.speed = 4.0
    line.player.toggle()
    assert line.player.is_playing
    assert line.looking.index == 0
    places: list[int] = []
    line.looking.changed.connect(lambda: places.append(line.looking.index))
    qtbot.waitUntil(lambda: not line.player.is_playing)
    assert line.looking.is_live
    assert places == sorted(places)
    line.player.speed = 1.0


class Shown(QObject):
    """Which moment is looked at, without views."""

    def __init__(self) -> None:
        super().__init__()
        self.index, self.is_live = 0, True

    def show(self, index: int) -> None:
        self.index, self.is_live = index, False


@pytest.mark.parametrize("speed", [0.25, 1.0, 4.0])
def test_it_is_played_as_quickly_as_it_is_wanted(qapp: object, speed: float, monkeypatch: pytest.MonkeyPatch) -> None:
    now, record, shown = [50.0], MomentRecord(), Shown()
    for step in range(120):
        record.add(np.zeros((3, 2)), np.zeros(1, bool), 0.1 * step)
    monkeypatch.setattr(player, "time", SimpleNamespace(perf_counter=lambda: now[0]))
    played = player.Player(record, shown)
    played.speed = speed
    played.toggle()
    for _ in range(20):
        now[0] += 0.1
        played._beat()
    assert record[shown.index].time == pytest.approx(2.0 * speed, abs=0.06)
    now[0] += 3600.0  # the window was held up
    played._beat()
    assert record[shown.index].time < 2.5 * speed
    played.stop()


def test_a_map_that_is_told_again_is_kept_once(line: TimeLine, window: MainWindow, qtbot: QtBot) -> None:
    document, count = window.document, len(line.recorder.record)
    told: list[int] = []
    document.snapshot_taken.connect(lambda: told.append(document.snapshot.number))
    document.watch("test", (window.quantities["mips"],))
    qtbot.waitUntil(lambda: bool(told))
    document.watch("test")
    assert len(line.recorder.record) == count


def test_memory_is_chosen_for_good(line: TimeLine, window: MainWindow) -> None:
    line.set_memory(64)
    assert line.recorder.record.limit == 64 * 2**20
    assert window.settings.time_line_memory == 64
    line.set_memory(256)


# ---------------------------------------------------------------------------------------------- comparing


def moment_of(positions: np.ndarray, anchors: AnchorSet | None = None, time: float = 0.0) -> Moment:
    return Moment(time, positions, b"", len(grid_mesh().simplices), 0, 1.0, 0, belongings=anchors)


def test_differences_are_those_of_the_maps() -> None:
    mesh, measure = grid_mesh(), Measure("det")
    anchors = AnchorSet.at(np.array(CORNERS), mesh.vertices)
    first, second = moment_of(mesh.vertices, anchors), moment_of(mesh.vertices * [2.0, 1.5], anchors)
    found = compare(Measurer(mesh), first, second, measure, is_held=False)
    assert np.allclose(found.difference, 2.0, rtol=1e-6)
    assert found.largest * mesh.diameter == pytest.approx(np.hypot(2.0, 0.5))
    assert found.distances.max() <= found.largest
    assert not compare(Measurer(mesh), first, first, measure, is_held=False).difference.any()


def test_without_anchors_place_and_direction_mean_nothing() -> None:
    mesh = grid_mesh()
    turned = mesh.vertices @ np.array([[0.6, 0.8], [-0.8, 0.6]]) + [3.0, -7.0]
    first, second = moment_of(mesh.vertices), moment_of(turned)
    assert compare(Measurer(mesh), first, second, Measure("det"), is_held=False).largest < 1e-12
    assert compare(Measurer(mesh), first, second, Measure("det"), is_held=True).largest > 1.0


def test_the_window_of_two_moments(line: TimeLine, window: MainWindow, qtbot: QtBot) -> None:
    line.looking.show(0)
    line.mark("A")
    line.looking.go_live()
    line.mark("B")
    window.actions_by_name["past-compare"].trigger()
    assert line.comparing is not None
    dialog = line.comparing.dialog
    assert dialog is not None
    qtbot.waitUntil(lambda: dialog.comparison is not None)
    found = dialog.comparison
    assert "E of A" in dialog.words.text()
    for _ in range(2):
        corners = dialog.view.project(dialog._geometry.points)
        assert (corners >= 0).all() and (corners <= dialog.view.size_in_pixels).all(), "A and B are seen whole, from one place"
        dialog.flip.click()
    for mode, values in (("difference", found.difference), ("displacement", found.distances), ("maps", found.values[1])):
        dialog.mode.setCurrentIndex(dialog.mode.findData(mode))
        assert np.allclose(dialog.view.surface._values, values)
    assert dialog.range.low <= found.values[1].min()
    dialog.flip.click()
    assert np.allclose(dialog.view.surface._values, found.values[0])
    dialog.mode.setCurrentIndex(dialog.mode.findData("difference"))
    assert dialog.range.centre == 0.0
    dialog.with_arrows.setChecked(True)
    assert np.allclose(np.linalg.norm(dialog.arrows._vectors, axis=1).max() / dialog._geometry.frame.scale,
                       found.largest * window.document.mesh.diameter)  # fmt: skip
    window.open("bumpy")
    qtbot.waitUntil(lambda: line.comparing.dialog is None)


# ---------------------------------------------------------------------------------------------- films


@pytest.mark.parametrize(("rate", "speed"), [(25.0, 1.0), (10.0, 0.5), (30.0, 4.0)])
def test_frames_are_what_was_to_be_seen(rate: float, speed: float) -> None:
    record, random = MomentRecord(), np.random.default_rng(5)
    for now in np.cumsum(random.uniform(0.001, 0.3, 80)):
        record.add(np.zeros((3, 2)), np.zeros(1, bool), float(now))
    frames = frames_of(record[:], rate, "time", speed)
    assert (len(frames) - 1) / rate == pytest.approx(record.end / speed, abs=1.0 / rate)
    for number, frame in enumerate(frames[:-1]):
        now = number * speed / rate
        assert frame.time <= now + 1e-9
        assert not [t for t in record.times if frame.time < t <= now]
    assert (frames[0], frames[-1]) == (record[0], record[-1])
    assert frames_of(record[:], rate, "maps", speed) == list(record)


def test_a_film_that_never_ends_is_refused() -> None:
    ends = [moment_of(np.zeros((3, 2)), time=time) for time in (0.0, 3600.0)]
    with pytest.raises(WorkbenchError, match="frames"):
        frames_of(ends, 60.0, "time", 0.05)


def test_a_film_is_made_beside_the_window(line: TimeLine, window: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    window.actions_by_name["film"].trigger()
    assert line.filming is not None
    dialog = line.filming.dialog
    assert dialog is not None
    for box, side in zip(dialog.sides, (200, 150), strict=True):
        box.setValue(side)
    dialog.pace.setCurrentIndex(dialog.pace.findData("maps"))
    qtbot.waitUntil(lambda: not dialog.picture.pixmap().isNull())
    count = len(line.recorder.record)
    qtbot.waitUntil(lambda: dialog.note.text().startswith(f"{count} frames"))
    path = tmp_path / "a.gif"
    line.filming.save(str(path))
    assert line.filming.is_working
    assert dialog.bar.isVisible()
    qtbot.waitUntil(lambda: not line.filming.is_working)
    with Image.open(path) as image:
        assert (image.n_frames, image.size) == (count, (200, 150))
        first = np.asarray(image.convert("RGB")).astype(int)
        image.seek(count - 1)
        assert np.abs(np.asarray(image.convert("RGB")).astype(int) - first).max() > 60
    assert dialog.bar.isHidden()
    line.filming.save(str(tmp_path / "b.gif"))
    dialog.cancel.click()
    qtbot.waitUntil(lambda: not line.filming.is_working)
    assert list(tmp_path.iterdir()) == [path]
    line.filming.save(str(tmp_path / "c.avi"))
    assert ".gif" in dialog.note.text()
    dialog.close()
    window.actions_by_name["film"].trigger()
    again = line.filming.dialog
    assert again is not None
    assert again.plan == dialog.plan, "the next film begins with the choices of the last"
    again.take_kept({"width": "wide", "height": -3, "rate": True, "ground": 7, "captions": "maybe", "speed": 1e9})
    assert again.plan.film.width == 200
    again.close()


def test_the_time_line_fits_into_a_small_window(window: MainWindow) -> None:
    """1280 pixels hold it between the panel of choices and a column of colour maps with the inspector."""
    dock = window.time_line.dock
    beside = window.panel_dock.minimumSizeHint().width() + window.inspector.minimumSizeHint().width()
    assert dock.minimumSizeHint().width() + beside + 12 <= 1280
    for name in ("past-go-on", "past-compare"):
        action = window.actions_by_name[name]
        assert len(action.iconText()) < len(action.text()) and action.toolTip()
