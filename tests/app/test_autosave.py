"""The last good state: kept every few seconds, and offered where a window did not end by itself."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

from PySide6.QtWidgets import QMessageBox, QPushButton
from pytestqt.qtbot import QtBot

from tests.app.conftest import WindowMaker
from tests.app.session_hand import mesh_file, wait_for_desk
from workbench.app.sessions.autosave import Autosave
from workbench.engine.session_file import read_session, write_session

DRAGGING = """
import sys, time
from pathlib import Path
import numpy as np
from workbench.app.main import make_application

if __name__ == "__main__":
    application = make_application()
    from tests.app.fake_engine import FakeWorker
    from workbench.app.main_window import MainWindow
    from workbench.app.sessions import autosave
    from workbench.app.settings import Settings
    from workbench.app.appearance.theme import ThemeSwitch

    folder = Path(sys.argv[1])
    autosave.INTERVAL = 300
    window = MainWindow(ThemeSwitch(application, "light"), Settings(folder / "window.ini"), FakeWorker)
    window.autosave = autosave.Autosave(window, folder / "recovery")
    window.start(str(folder / "grid.obj"))
    window.anchor_files.dock.show()
    window.autosave.start()
    document = window.document
    while document.positions is None:
        application.processEvents()
    document.add_anchor(4)
    begin = time.time()
    while True:
        document.move_anchor(4, np.array([time.time() - begin, 0.5]), True)
        application.processEvents()
        print(time.time() - begin, flush=True)
        time.sleep(0.02)
"""


def test_a_window_that_is_killed_in_the_middle_of_a_drag_loses_little_and_the_next_start_offers_it(
    make_window: WindowMaker, qtbot: QtBot, tmp_path: Path, project_root: Path
) -> None:
    mesh_file(tmp_path)
    child = subprocess.Popen(
        [sys.executable, "-c", DRAGGING, str(tmp_path)],
        cwd=project_root,
        env={**os.environ, "PYTHONPATH": str(project_root)},
        stdout=subprocess.PIPE,
        text=True,
    )

    def kept_places() -> set[float]:
        """Where the anchor is, in the states that are kept."""
        states = [read_session(path).session for path in (tmp_path / "recovery").glob("[!.]*.dwb")]
        return {place[0] for state in states for place in state.anchor_targets}

    seen: set[float] = set()
    assert child.stdout is not None
    for _ in child.stdout:
        seen |= kept_places()
        if len(seen) > 3:  # states of one drag, each in the place of the one before
            break
    os.kill(child.pid, signal.SIGKILL)
    child.wait()
    child.stdout.close()
    (kept,) = (tmp_path / "recovery").glob("[!.]*.dwb")
    (place,) = kept_places()
    assert place >= max(seen), "what was kept last is whole"

    window = make_window()
    qtbot.waitUntil(lambda: window.document.positions is not None)
    window.autosave = Autosave(window, tmp_path / "recovery")
    window.autosave.start()
    assert window.anchor_files.dock.isVisible(), "panels lie as they did"
    box = window.findChild(QMessageBox, "recovery")
    assert box is not None and box.isVisible()
    next(button for button in box.findChildren(QPushButton) if button.text() == "Recover").click()
    assert read_session(window.autosave.path).session.anchor_vertices == (4,), "nor is it lost if this window is killed now"
    qtbot.waitUntil(lambda: 4 in window.document.anchors)
    assert not kept.exists() and window.isWindowModified()


def test_what_is_in_use_is_not_offered_and_an_orderly_end_leaves_the_last_session(
    make_window: WindowMaker, qtbot: QtBot, tmp_path: Path
) -> None:
    window = make_window(source=str(mesh_file(tmp_path)))
    qtbot.waitUntil(lambda: window.document.positions is not None)
    window.autosave = Autosave(window, tmp_path)
    window.autosave.start()
    window.document.add_anchor(8)
    window.autosave.keep()
    wait_for_desk(window, qtbot)
    assert window.autosave.path.is_file() and window.isWindowModified()
    other = Autosave(window, tmp_path)
    other.start()
    assert window.findChild(QMessageBox, "recovery") is None, "its owner lives"
    other.end()
    window.open("bumpy")
    qtbot.waitUntil(lambda: window.document.kind == "parameterize")
    wait_for_desk(window, qtbot)
    assert read_session(tmp_path / "last.dwb").session.anchor_vertices == (8,), "what gave way was not saved"
    (tmp_path / "last.dwb").unlink()
    window.undoing.undo()
    qtbot.waitUntil(lambda: window.document.kind == "plane" and 8 in window.document.anchors)
    window.close()
    assert not list(tmp_path.glob("*-*.dwb"))
    assert read_session(tmp_path / "last.dwb").session.anchor_vertices == (8,)


def test_states_that_cannot_be_read_do_not_stand_before_older_ones(
    make_window: WindowMaker, qtbot: QtBot, tmp_path: Path
) -> None:
    window = make_window(source=str(mesh_file(tmp_path)))
    qtbot.waitUntil(lambda: window.document.positions is not None)
    window.document.add_anchor(8)
    write_session(tmp_path / "100-old.dwb", window.sessions.desk.record())
    torn, part = tmp_path / "200-new.dwb", tmp_path / ".100-old-1f.dwb"
    for path in (torn, part):
        path.write_text("")
    autosave = Autosave(window, tmp_path)
    autosave.start()
    box = window.findChild(QMessageBox, "recovery")
    assert box is not None and "1 anchor" in box.informativeText().replace("\u00a0", " ")
    assert not torn.exists() and not part.exists()
    box.close()
    autosave.end()


def test_a_folder_that_takes_no_states_is_told(make_window: WindowMaker, tmp_path: Path) -> None:
    window = make_window()
    in_the_way = tmp_path / "recovery"
    in_the_way.write_text("no folder")
    Autosave(window, in_the_way).start()
    assert str(in_the_way) in window.error_bar.sentence.text() and window.error_bar.isVisible()
