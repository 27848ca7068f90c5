"""Layouts of panels: by name, from start to start, on any screen, and views alone on all of it."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QByteArray, QRect, QSize, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QMainWindow, QMenu, QToolBar
from pytestqt.qtbot import QtBot

from tests.app.conftest import WindowMaker
from workbench.app.layouts.layouts import DEFAULT, SHOWN, TIPS
from workbench.app.layouts.screens import fitted
from workbench.app.layouts.small_screens import make_room
from workbench.app.main_window import MainWindow
from workbench.app.settings import Settings
from workbench.core.errors import WorkbenchError

pytestmark = pytest.mark.usefixtures("kept_inspector")

SIDES = st.integers(1, 6000)
PLACES = st.integers(-8000, 8000)


def shown(window: MainWindow) -> set[str]:
    return {dock.objectName() for dock in window.docks if dock.isVisible()}


@given(st.builds(QRect, PLACES, PLACES, SIDES, SIDES), st.builds(QRect, PLACES, PLACES, SIDES, SIDES))
def test_a_window_fits_the_screen_and_stays_where_it_fits(wanted: QRect, available: QRect) -> None:
    found = fitted(wanted, available)
    assert available.contains(found)
    assert found.width() == min(wanted.width(), available.width())
    if available.contains(wanted):
        assert found == wanted


def test_layouts_of_the_program_show_what_they_are_for(window: MainWindow) -> None:
    layouts = window.layouts
    layouts.apply(DEFAULT)
    usual = shown(window)
    assert {"choices", "histogram", "convergence"} <= usual and "inspector" not in usual
    size = window.size()
    for name, docks in SHOWN.items():
        layouts.apply(name)
        QTest.qWait(30)
        assert window.size() == size, "there is room for it in a window of common size"
        assert shown(window) == {dock.objectName() for dock in docks(window)}, name
    layouts.apply(DEFAULT)
    assert shown(window) == usual


@pytest.mark.parametrize("size", [(1600, 1000), (960, 540), (1200, 480)], ids=str)
def test_a_small_screen_has_the_panels_that_it_has_room_for(window: MainWindow, size: tuple[int, int]) -> None:
    window.layouts.apply(DEFAULT)
    before, available = shown(window), QSize(*size)
    fits = _fits(window.minimumSizeHint(), available)
    make_room(window, available)
    assert _fits(window.minimumSizeHint(), available)
    assert (shown(window) == before) is fits, "no panel is closed that there is room for"
    assert not window.panel_dock.isHidden() and not window.maps[-1].isHidden()
    window.layouts.apply(DEFAULT)
    assert shown(window) == before


def _fits(least: QSize, available: QSize) -> bool:
    return least.width() <= available.width() and least.height() <= available.height()


def test_a_panel_that_is_asked_for_comes_before_those_at_its_place(window: MainWindow, qtbot: QtBot) -> None:
    window.layouts.apply(DEFAULT)
    hidden = [dock for dock in window.docks if not dock.isVisible()]
    assert len(hidden) > 2
    for dock in hidden:
        dock.toggleViewAction().trigger()
        qtbot.waitUntil(lambda d=dock: not d.visibleRegion().isEmpty())
    window.layouts.apply(DEFAULT)


def test_a_layout_of_ones_own_comes_back_and_can_be_deleted(window: MainWindow) -> None:
    layouts = window.layouts
    layouts.apply("Drag")
    window.histogram.show()
    wanted = shown(window)
    layouts.save_as("  My   own & mine ")
    layouts.apply(DEFAULT)
    assert shown(window) != wanted
    menu = QMenu(window)
    layouts.fill_menu(menu)
    next(action for action in menu.actions() if action.text() == "My own && mine").trigger()
    assert shown(window) == wanted
    assert set(Settings(window.settings._store.fileName()).layouts()) == {"My own & mine"}
    layouts.delete("My own & mine")
    assert not layouts.own
    layouts.apply(DEFAULT)
    menu.deleteLater()


@pytest.mark.parametrize("name", ["", "   ", "x" * 41, *TIPS])
def test_a_name_that_cannot_be_used_is_refused(window: MainWindow, name: str) -> None:
    with pytest.raises(WorkbenchError):
        window.layouts.save_as(name)
    assert not window.layouts.own


def test_layouts_that_cannot_be_read_are_left_out(window: MainWindow) -> None:
    before = shown(window)
    window.settings.save_layouts({"a": "no base 64!", "b": "", "c": 5, "d" * 50: "AAAA", "e": "AAAA"})  # type: ignore[dict-item]
    assert set(window.layouts.own) == {"b", "e"}
    window.layouts.apply("e")
    assert shown(window) == before
    assert "another version" in window.status.sentence.text()
    window.settings.save_layouts({})


def test_the_dialog_asks_for_a_name(window: MainWindow, qtbot: QtBot) -> None:
    window.actions_by_name["save-layout"].trigger()
    dialog = window.layouts.dialog
    assert dialog is not None
    QTest.keyClicks(dialog.focusWidget(), "Mine")
    QTest.keyClick(dialog.focusWidget(), Qt.Key.Key_Return)
    assert set(window.layouts.own) == {"Mine"}
    window.layouts.delete("Mine")


def test_f11_gives_views_the_screen_and_takes_it_back(window: MainWindow, qtbot: QtBot) -> None:
    window.layouts.apply("Drag")
    before, size = shown(window), window.size()
    QTest.keyClick(window, Qt.Key.Key_F11)
    qtbot.waitUntil(window.isFullScreen)
    assert not shown(window) and not window.menuBar().isVisible() and not window.statusBar().isVisible()
    assert window.actions_by_name["present"].isChecked()
    QTest.keyClick(window, Qt.Key.Key_Space)
    assert window.document.wants_to_run, "keys go on"
    QTest.keyClick(window, Qt.Key.Key_Space)
    QTest.keyClick(window, Qt.Key.Key_F11)
    qtbot.waitUntil(lambda: not window.isFullScreen())
    assert shown(window) == before and window.menuBar().isVisible()
    assert window.findChild(QToolBar, "tools").isVisible()
    qtbot.waitUntil(lambda: window.size() == size)
    window.layouts.apply(DEFAULT)


def test_the_next_start_is_as_it_was_also_on_a_smaller_screen(tmp_path: Path, make_window: WindowMaker, qtbot: QtBot) -> None:
    other = QMainWindow()
    qtbot.addWidget(other)
    other.setGeometry(QRect(-300, 900, 5000, 4000))
    Settings(tmp_path / "window.ini").save_layout(other.saveGeometry(), QByteArray())
    window = make_window()
    assert window.screen().availableGeometry().contains(window.frameGeometry())
    window.layouts.apply("Views only")
    QTest.keyClick(window, Qt.Key.Key_F11)
    window.close()
    again = make_window()
    assert not shown(again)
    assert not again.isFullScreen() and again.menuBar().isVisible()
