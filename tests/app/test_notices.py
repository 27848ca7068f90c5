"""What is told: bars that push nothing about, repeats counted, a list that is capped, lines from other threads."""

from __future__ import annotations

import logging
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QWidget
from pytestqt.qtbot import QtBot

from workbench.app.appearance.theme import DARK, LIGHT, Theme
from workbench.app.main_window import MainWindow
from workbench.app.notices.floating_column import FloatingColumn
from workbench.app.notices.log_dock import LogDock
from workbench.app.notices.notice import Notice
from workbench.app.notices.notice_list import MOST, NoticeList, level_colour
from workbench.app.status.progress_bar import ProgressLine
from workbench.engine.messages import LogLine


def texts(window: MainWindow) -> list[str]:
    return [notice.text for notice in window.noticing.notices.notices]


def test_a_message_moves_no_view(window: MainWindow) -> None:
    before = window.target.view.geometry(), window.source.view.geometry()
    window.error_bar.show_message("The file is gone; choose another one.", details="a\nb\n" * 20)
    window.error_bar.details_button.click()
    QTest.qWait(30)
    assert (window.target.view.geometry(), window.source.view.geometry()) == before
    host = window.bars.parentWidget()
    assert window.bars.isVisible() and host.rect().contains(window.bars.geometry())
    window.error_bar.dismiss()
    QTest.qWait(10)
    assert not window.bars.isVisible(), "an empty column would take clicks from the views"


def test_long_work_is_told_in_full_the_first_time_already(qtbot: QtBot) -> None:
    host = QWidget()
    qtbot.addWidget(host)
    host.resize(600, 400)
    column, line = FloatingColumn(host), ProgressLine(host)
    column.add(line)
    host.show()
    qtbot.waitExposed(host)
    line.begin("Kernels are being compiled, which takes about half a minute; " * 3)
    qtbot.waitUntil(line.isVisible)
    QTest.qWait(20)
    label, parts = line.label, (line.label, line.bar, line.cancel_button)
    assert all(line.rect().contains(part.geometry()) for part in parts)
    assert label.geometry().right() < line.bar.x() and line.bar.geometry().right() < line.cancel_button.x()
    assert label.heightForWidth(label.width()) <= label.height(), "no word is cut off"


def test_the_same_again_is_counted_and_another_begins_anew(window: MainWindow) -> None:
    for _ in range(12):
        window.error_bar.show_message("It does not work; try another one.")
    assert window.error_bar.count.text() == "× 12" and not window.error_bar.count.isHidden()
    window.error_bar.show_message("Something else is wrong; mend it.")
    assert window.error_bar.count.isHidden()
    window.error_bar.dismiss()


def test_what_was_read_goes_with_the_next_step_or_esc_and_what_offers_a_fix_stays(
    window: MainWindow, monkeypatch: pytest.MonkeyPatch
) -> None:
    bar = window.error_bar
    bar.show_message("That was not a number; type one.")
    window.document.pin(np.array([0]))
    assert not bar.isHidden(), "nobody has read it yet"
    now = time.monotonic()
    monkeypatch.setattr("workbench.app.status.error_bar.time.monotonic", lambda: now + 60.0)
    window.document.pin(np.array([1]))
    assert bar.isHidden()
    bar.show_message("That was not a number; type one.")
    QTest.keyClick(window, Qt.Key.Key_Escape)
    assert bar.isHidden()
    bar.show_message("The surface is closed; cut it.", ["cut"])
    QTest.keyClick(window, Qt.Key.Key_Escape)
    assert not bar.isHidden()
    bar.dismiss()


def test_why_a_map_does_not_begin_with_the_texture_of_its_file_stays_to_be_read(
    window: MainWindow, qtbot: QtBot, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("workbench.app.status.reporter.why_not_own_start", lambda *_: "Those turn over.")
    window.open("grid")
    qtbot.waitUntil(lambda: window.document.positions is not None and not window.document.opening_source)
    QTest.qWait(30)
    assert window.error_bar.sentence.text() == "Those turn over." and not window.error_bar.isHidden()
    assert "Those turn over." in texts(window)
    window.error_bar.dismiss()


def test_the_log_has_what_bar_status_loggers_engine_and_threads_told(window: MainWindow, qtbot: QtBot) -> None:
    window.noticing.notices.clear()
    window.status.say("A sentence of the status line.")
    window.error_bar.show_message("A sentence of the bar.", details="its details")
    window.bridge.log_line.emit(LogLine(logging.WARNING, "my_plugin", "A line of the engine."))
    on_thread = threading.Thread(target=lambda: logging.getLogger("of_a_plugin").info("A line of %s.", "a thread"))
    on_thread.start()
    on_thread.join()
    wanted = {"A sentence of the status line.", "A sentence of the bar.", "A line of the engine.", "A line of a thread."}
    qtbot.waitUntil(lambda: wanted <= set(texts(window)))
    dock = window.noticing.dock
    dock.level.setCurrentIndex(dock.level.findData(logging.WARNING))
    dock.copy_all()
    copied = QApplication.clipboard().text()
    assert "its details" in copied and "engine.my_plugin" in copied and "status line" not in copied
    dock.level.setCurrentIndex(dock.level.findData(logging.INFO))
    window.error_bar.dismiss()


def test_the_log_is_searched_and_saved(window: MainWindow, tmp_path: Path) -> None:
    window.noticing.notices.clear()
    for text in ("apples", "pears", "Apples and pears"):
        window.noticing.notices.add(Notice(logging.WARNING, text))
    dock = window.noticing.dock
    dock.search.setText("APPLES")
    assert len(dock.text.splitlines()) == 2
    dock.save(str(tmp_path / "log.txt"))
    assert (tmp_path / "log.txt").read_text(encoding="utf-8") == dock.text
    dock.save(str(tmp_path / "no" / "log.txt"))
    assert "folder" in window.error_bar.sentence.text()
    dock.search.clear()
    window.error_bar.dismiss()


def test_the_list_is_capped_and_counts_those_that_take_turns() -> None:
    notices = NoticeList(LIGHT)
    for _ in range(40):
        notices.add(Notice(logging.INFO, "tick"))
        notices.add(Notice(logging.INFO, "tock"))
    assert [n.count for n in notices.notices] == [40, 40]
    for number in range(MOST + 10):
        notices.add(Notice(logging.INFO, str(number)))
    assert notices.rowCount() == len(notices.notices) == MOST and notices.notices[-1].text == str(MOST + 9)


def test_a_window_that_is_closed_listens_no_longer(window: MainWindow) -> None:
    handlers = list(logging.getLogger().handlers)
    window.noticing.close()
    assert len(logging.getLogger().handlers) == len(handlers) - 1
    window.noticing._bridge.install()


@pytest.mark.parametrize("theme", [LIGHT, DARK], ids=lambda theme: theme.name)
def test_words_can_be_read_on_their_ground(theme: Theme) -> None:
    """Contrast of 4.5 as WCAG 2 asks for text."""
    for name in ("detail", "note", "warning", "error"):
        assert contrast(level_colour(theme, name), theme.base) >= 4.5, name
    assert contrast(theme.warning_text, theme.warning) >= 4.5
    assert contrast(theme.faint, theme.window) >= 4.5
    assert contrast("#777777", "#888888") < 4.5, "the measure can fail"


def contrast(text: str, ground: str) -> float:
    """Ratio of the relative luminances of two colours."""
    bright, dark = sorted((luminance(text), luminance(ground)), reverse=True)
    return (bright + 0.05) / (dark + 0.05)


def luminance(colour: str) -> float:
    """Relative luminance of #rrggbb in sRGB."""
    parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def test_in_a_narrow_log_what_was_told_keeps_its_room(qtbot: QtBot, qapp: QApplication) -> None:
    notices = NoticeList(LIGHT)
    dock = LogDock(notices, None)
    qtbot.addWidget(dock)
    notices.add(Notice(logging.WARNING, "A sentence that is to be read.", "workbench.window", "its details"))
    for width in (330, 1000):
        dock.resize(width, 160)
        dock.show()
        qtbot.waitUntil(lambda w=width: dock.table.width() > 0.8 * w)  # type: ignore[misc]
        assert dock.table.isColumnHidden(3) == (width < 500)
        assert dock.table.columnWidth(2) > 0.35 * width and not dock.details.isVisible()
    dock.table.selectRow(0)
    assert dock.details.isVisible() and "its details" in dock.details.toPlainText()
    notices.clear()
    assert not dock.details.isVisible()
