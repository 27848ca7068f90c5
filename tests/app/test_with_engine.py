"""The window with the real engine process: what a user does in the first minute."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from tests.app.conftest import Hand, WindowMaker, pixel_of
from workbench.app.document.engine_bridge import engine_worker
from workbench.app.main_window import MainWindow


@pytest.fixture
def live(make_window: WindowMaker, qtbot: QtBot) -> MainWindow:
    """A window on the first sample, its solver running."""
    window = make_window(engine_worker, source="")
    qtbot.waitUntil(lambda: len(window.document.anchors) > 0)
    qtbot.waitUntil(lambda: window.document.snapshot.anchor_serial == window.document.anchor_serial)
    return window


def spread(window: MainWindow) -> float:
    return float(np.ptp(window.document.positions, axis=0).max())


def test_open_anchor_drag_pause_switch_close(live: MainWindow, qtbot: QtBot) -> None:
    document, target = live.document, live.target.view
    hand = Hand(target)
    free = int(np.argmin(np.linalg.norm(document.positions - document.positions.mean(axis=0), axis=1)))
    count = len(document.anchors)
    hand.click(pixel_of(target, free))
    assert len(document.anchors) == count + 1
    qtbot.waitUntil(lambda: len(live.histogram.counts) > 0)
    before, counts = document.positions, live.histogram.counts.copy()

    anchored = int(document.anchors.vertices[0])
    begin = pixel_of(target, anchored)
    inverted: list[int] = []
    document.snapshot_taken.connect(lambda: inverted.append(int(document.snapshot.inverted.sum())))
    hand.press(begin)
    for step in range(1, 31):
        hand.move(begin + QPoint(-2 * step, step))
        QTest.qWait(16)
    qtbot.waitUntil(lambda: not np.allclose(document.positions, before))
    hand.release(begin + QPoint(-60, 30))
    qtbot.waitUntil(lambda: not np.array_equal(live.histogram.counts, counts))
    assert not any(inverted), "no map that was drawn has an inverted triangle"
    assert live.reporter.drag_meter.delays

    goal = np.array(document.anchors.targets[anchored])
    close = 1e-8 * document.mesh.diameter
    qtbot.waitUntil(lambda: np.linalg.norm(document.positions[anchored] - goal) <= close)
    qtbot.waitUntil(lambda: document.snapshot.phase == "finished")
    assert document.snapshot.status.value in live.status.sentence.text()

    qtbot.waitUntil(lambda: live.panel.distortion.combo.count() > 0)
    document.choose(distortion="mips")
    document.run()
    qtbot.waitUntil(lambda: document.snapshot.distortion == "mips")
    document.choose(distortion="arap")
    qtbot.waitUntil(lambda: document.snapshot.distortion == "arap")

    document.pause()
    qtbot.waitUntil(lambda: document.snapshot.phase == "idle")
    live.activateWindow()
    QTest.qWaitForWindowActive(live)
    QTest.keyClick(live, Qt.Key.Key_Home)
    qtbot.waitUntil(lambda: document.snapshot.row.iteration == 0)


def test_a_killed_engine_comes_back_in_the_middle_of_a_drag(live: MainWindow, qtbot: QtBot) -> None:
    document, target = live.document, live.target.view
    hand = Hand(target)
    anchored = int(document.anchors.vertices[0])
    begin = pixel_of(target, anchored)
    hand.press(begin)
    for step in range(1, 11):
        hand.move(begin + QPoint(-2 * step, 0))
        QTest.qWait(16)
    os.kill(live.bridge._worker.process_id, signal.SIGKILL)
    qtbot.waitUntil(live.error_bar.isVisible)
    assert "restarted" in live.error_bar.sentence.text()
    for step in range(11, 31):
        hand.move(begin + QPoint(-2 * step, 0))
        QTest.qWait(16)
    hand.release(begin + QPoint(-60, 0))
    goal = np.array(document.anchors.targets[anchored])
    close = 1e-6 * document.mesh.diameter
    qtbot.waitUntil(lambda: np.linalg.norm(document.positions[anchored] - goal) <= close)


def test_a_surface_is_mapped_and_saved(make_window: WindowMaker, qtbot: QtBot, tmp_path: Path) -> None:
    window = make_window(engine_worker, source="sample:bumpy-disc")
    document = window.document
    qtbot.waitUntil(lambda: document.positions is not None)
    assert document.kind == "parameterize"
    document.run()
    qtbot.waitUntil(lambda: document.snapshot.phase == "finished")
    path = tmp_path / "map.obj"
    with qtbot.waitSignal(window.commands.saver.saved):
        window.commands.save_map(str(path))
    lines = path.read_text().splitlines()
    assert sum(line.startswith("vt ") for line in lines) == document.mesh.vertex_count
    first = next(line for line in lines if line.startswith("vt ")).split()[1:]
    np.testing.assert_array_equal([float(x) for x in first], document.positions[0])


def test_a_file_that_is_none_is_refused_with_a_sentence(live: MainWindow, qtbot: QtBot, tmp_path: Path) -> None:
    path = tmp_path / "picture.obj"
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(200))
    live.open(str(path))
    qtbot.waitUntil(live.error_bar.isVisible)
    assert live.error_bar.sentence.text()
    number = live.document.snapshot.number
    live.document.step()
    qtbot.waitUntil(lambda: live.document.snapshot.number > number)


TWENTY = """
import sys
from pathlib import Path
from PySide6.QtCore import QEvent, QTimer
from PySide6.QtWidgets import QApplication
from workbench.app.main import make_application
application = make_application()
from tests.app.fake_engine import FakeWorker
from workbench.app.document.engine_bridge import engine_worker
from workbench.app.main_window import MainWindow
from workbench.app.settings import Settings
from workbench.app.appearance.theme import ThemeSwitch
for cycle in range(20):
    # the real engine now and then: starting twenty processes takes longer than the test is worth
    make_worker, source = (engine_worker, "") if cycle % 7 == 3 else (FakeWorker, "grid")
    window = MainWindow(ThemeSwitch(application, "light"), Settings(sys.argv[1]), make_worker)
    window.show()
    window.start(source)
    QTimer.singleShot(60 + 20 * (cycle % 3), window.close)
    application.exec()
    window.deleteLater()
    del window
    QApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
print("twenty")
"""


def test_twenty_windows_one_after_the_other_end_well(tmp_path: Path, project_root: Path, qapp: object) -> None:
    done = subprocess.run(
        [sys.executable, "-X", "faulthandler", "-c", TWENTY, str(tmp_path / "s.ini")],
        cwd=project_root,
        capture_output=True,
        text=True,
        timeout=240,
        check=False,
    )
    assert done.returncode == 0, done.stderr[-3000:]
    assert done.stdout.strip().endswith("twenty")
