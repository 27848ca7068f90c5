"""Windows that are closed and destroyed at hostile moments: nothing is raised, nothing is told, nothing is left."""

from __future__ import annotations

import gc
import threading
from pathlib import Path

import shiboken6
from PySide6.QtCore import QEvent, QObject, QPoint
from PySide6.QtWidgets import QApplication, QDialog, QMainWindow, QWidget
from pytestqt.qtbot import QtBot

from tests.app.conftest import Hand, WindowMaker, pixel_of
from tests.app.fake_race import InlineRaceWorker
from workbench.app.background import Background, silence_all
from workbench.app.main_window import MainWindow
from workbench.app.race.set_up_dialog import RaceChoice
from workbench.engine.race_messages import Entrant

OWN_WINDOWS = (
    "signatures",
    "dissect",
    "judge",
    "figure",
    "refine",
    "help",
    "cite",
    "preferences",
    "equations",
    "about",
    "palette",
)
"""Actions that open a window or a dialog of the main window."""


def objects_of_windows() -> list[QObject]:
    """All objects of the window's classes that are alive in Qt."""
    return [o for o in gc.get_objects() if isinstance(o, QObject) and _is_ours(o) and shiboken6.isValid(o)]


def _is_ours(thing: QObject) -> bool:
    return type(thing).__module__.startswith("workbench.app")


def let_threads_end(window: MainWindow) -> None:
    """What each of them reports is in the queue then, and nobody has heard it; a film goes on."""
    filming = window.time_line.filming
    in_films = filming.findChildren(Background) if filming is not None else []
    for work in window.findChildren(Background):
        if work not in in_films:
            work.wait(60.0)


def end(window: QWidget) -> None:
    window.close()
    window.deleteLater()
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    assert not shiboken6.isValid(window)


def pull(window: MainWindow, qtbot: QtBot) -> None:
    document = window.document
    qtbot.waitUntil(lambda: window.target.view.geometry_shown is not None)
    for vertex in (0, 20):
        document.add_anchor(vertex)
    document.move_anchor(20, document.positions[20] + [0.2, 0.1], False)
    qtbot.waitUntil(lambda: document.snapshot.anchor_serial == document.anchor_serial)


def film(window: MainWindow, folder: Path) -> None:
    window.time_line.dock.show()
    window.time_line.film()
    window.time_line.filming.save(str(folder / "film.gif"))
    window.time_line.player.toggle()


def race(window: MainWindow, qtbot: QtBot) -> None:
    racing = window.commands.racing
    racing.make_worker = InlineRaceWorker
    racing.begin(RaceChoice((Entrant("Newton", "projected-newton"), Entrant("AQP", "aqp")), "", True, 4, 1e-9))
    qtbot.waitUntil(lambda: all(record.frame is not None for record in racing.race.model.records))
    racing.race.actions_by_name["run"].trigger()
    racing.ask_contestants()


def drag(window: MainWindow) -> None:
    hand, begin = Hand(window.target.view), pixel_of(window.target.view, 20)
    hand.press(begin)
    for step in range(1, 4):
        hand.move(begin - QPoint(12, 7) * step)
    assert window.document.is_held


def test_nothing_is_left_of_a_window_that_ends_in_the_middle_of_everything(
    make_window: WindowMaker, qtbot: QtBot, tmp_path: Path
) -> None:
    known = {id(thing) for thing in objects_of_windows()}
    window = make_window()
    pull(window, qtbot)
    window.inspector.toggle.trigger()
    for name in OWN_WINDOWS:
        window.actions_by_name[name].trigger()
    film(window, tmp_path)
    race(window, qtbot)
    window.document.toggle()
    window.undoing.set_memory(2**20)
    drag(window)
    window.commands.save_map(str(tmp_path / "map.obj"))
    let_threads_end(window)
    assert len(window.findChildren(Background)) > 5
    end(window)
    qtbot.wait(30)
    left = {type(thing).__name__ for thing in objects_of_windows() if id(thing) not in known}
    assert left <= {"ThemeSwitch"}, "whatever belongs to a window ends with it"


def test_a_thread_that_outlasts_its_window_tells_nobody(qtbot: QtBot) -> None:
    gate = threading.Event()
    heard: list[object] = []

    def work() -> int:
        gate.wait(60.0)
        return 1 // len(heard)

    for is_destroyed in (True, False):
        window = QWidget()
        part = QObject(window)
        late = Background(work, part)
        late.failed.connect(heard.append)
        late.wait = lambda seconds=0.0: None  # as after the longest patience
        late.start()
        silence_all(window)
        if is_destroyed:
            end(window)
        gate.set()
        late._thread.join()
        qtbot.wait(20)
        if not is_destroyed:
            end(window)
    assert not heard


def test_windows_that_were_closed_mind_nothing_that_goes_on(window: MainWindow, qtbot: QtBot) -> None:
    pull(window, qtbot)
    before = set(window.findChildren(QMainWindow)) | set(window.findChildren(QDialog))
    for name in OWN_WINDOWS:
        window.actions_by_name[name].trigger()
    race(window, qtbot)
    let_threads_end(window)
    for opened in {*window.findChildren(QMainWindow), *window.findChildren(QDialog)} - before:
        opened.close()
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    for theme in ("dark", "light"):
        window.commands.choose_theme(theme)
    window.document.choose(distortion="mips")
    window.document.step()
    window.undoing.undo()
    window.open("bumpy")
    qtbot.waitUntil(lambda: window.document.kind == "parameterize")
    window.bridge.stop()
    qtbot.wait(50)
    window.commands.signatures.deleteLater()  # it is kept with its maps, and its plot has a widget without a parent
    window.commands.signatures = None
