"""Exceptions that nobody caught: one dialog, a way to save, and the window lives."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from PySide6.QtCore import QTimer
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QFileDialog
from pytestqt.qtbot import QtBot

from workbench.app.faults.fault_hooks import FaultHooks
from workbench.app.main_window import MainWindow
from workbench.engine.log_file import FaultWatch, open_log

pytestmark = pytest.mark.qt_no_exception_capture


@pytest.fixture
def hooked(window: MainWindow, capsys: pytest.CaptureFixture[str]) -> Iterator[MainWindow]:
    """The window with the hooks of the program."""
    hooks = FaultHooks()
    hooks.install(with_qt=False)
    hooks.raised.connect(window.faults.take)
    window.faults._known.clear()
    yield window
    hooks.remove()
    window.faults.close()
    window.error_bar.dismiss()


def fail() -> None:
    raise ValueError("a slot that fails")


def fail_elsewhere() -> None:
    raise KeyError("another one")


def test_a_slot_that_raises_a_hundred_times_opens_one_dialog(hooked: MainWindow, qtbot: QtBot) -> None:
    for _ in range(100):
        QTimer.singleShot(0, fail)
    QTimer.singleShot(0, fail_elsewhere)
    qtbot.waitUntil(lambda: hooked.faults.dialog is not None and "another one" in hooked.faults.dialog.text)
    dialog = hooked.faults.dialog
    assert [type(w).__name__ for w in QApplication.topLevelWidgets()].count("FaultDialog") == 1
    assert "ValueError: a slot that fails (100 times)" in dialog.text
    dialog.copy_button.click()
    assert "def fail" not in QApplication.clipboard().text() and "in fail\n" in QApplication.clipboard().text()
    dialog.go_on_button.click()
    QTimer.singleShot(0, fail)
    qtbot.waitUntil(lambda: "Once more" in hooked.error_bar.sentence.text())
    assert hooked.faults.dialog is None, "what was told of once opens no second dialog"
    before = hooked.document.snapshot.number
    hooked.document.step()
    qtbot.waitUntil(lambda: hooked.document.snapshot.number > before)


def test_a_thread_that_raises_is_told_by_its_name(hooked: MainWindow, qtbot: QtBot) -> None:
    thread = threading.Thread(target=fail, name="my-thread")
    thread.start()
    thread.join()
    qtbot.waitUntil(lambda: hooked.faults.dialog is not None)
    assert "on the thread my-thread" in hooked.faults.dialog.text


def test_the_dialog_asks_where_to_save_the_session(hooked: MainWindow, qtbot: QtBot) -> None:
    QTimer.singleShot(0, fail)
    qtbot.waitUntil(lambda: hooked.faults.dialog is not None)
    hooked.faults.dialog.save_button.click()
    qtbot.waitUntil(lambda: bool(hooked.findChildren(QFileDialog)))
    for dialog in hooked.findChildren(QFileDialog):
        dialog.close()
    QTest.qWait(10)


def test_the_log_file_is_of_limited_size(tmp_path: Path) -> None:
    import logging

    handler = open_log(tmp_path)
    assert handler is not None
    for number in range(4000):
        handler.handle(logging.LogRecord("test", logging.INFO, "", 0, f"{number} " + 900 * "x", None, None))
    handler.close()
    files = sorted(tmp_path.glob("window.log*"))
    assert 2 <= len(files) <= 3 and sum(path.stat().st_size for path in files) < 3_100_000
    assert "3999 " in (tmp_path / "window.log").read_text(encoding="utf-8")


CRASH = """
import ctypes, sys
from pathlib import Path
from workbench.engine.log_file import FaultWatch
watch = FaultWatch(Path(sys.argv[1]))
watch.begin()
if sys.argv[2] == "end":
    watch.end()
else:
    ctypes.string_at(0)
"""


def test_a_hard_fault_is_told_at_the_next_start_once(tmp_path: Path) -> None:
    def run(how: str) -> int:
        call = [sys.executable, "-c", CRASH, str(tmp_path), how]
        return subprocess.run(call, capture_output=True, check=False, timeout=60).returncode

    assert run("end") == 0
    assert not list(tmp_path.glob("fault-*")), "nothing is left where nothing happened"
    assert run("crash") != 0
    watch = FaultWatch(tmp_path)
    told = watch.begin()
    assert "string_at" in told
    watch.end()
    again = FaultWatch(tmp_path)
    assert again.begin() == ""
    again.end()


def test_a_folder_that_cannot_be_written_stops_nothing(tmp_path: Path) -> None:
    place = tmp_path / "file"
    place.write_text("in the way")
    assert open_log(place) is None
    watch = FaultWatch(place)
    assert watch.begin() == ""
    watch.end()
