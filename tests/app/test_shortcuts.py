"""Keys and words of actions: no key twice, no letter twice in a menu, everything said; and the sheet that tells of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import Qt
from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QApplication, QMenu, QToolBar
from pytestqt.qtbot import QtBot

from workbench.app.actions import TEXTS
from workbench.app.main_window import MainWindow
from workbench.app.mnemonics import letter_of, with_letters
from workbench.app.palette.collecting import plain
from workbench.app.race.race_window import ACTIONS, HOLD_KEY, IN_WORDS, UNSEEN
from workbench.app.shortcuts.gestures import GESTURES, VIEW_KEYS
from workbench.app.shortcuts.sheet import actions_in, as_html, as_text, filtered, keys_of, sheet_of
from workbench.app.shortcuts.sheet_window import SheetWindow


def twice(keys: list[str]) -> list[str]:
    return [key for key, count in Counter(keys).items() if count > 1]


def menus(window: MainWindow) -> Iterator[QMenu]:
    """All of the menu bar, filled as they are when they are opened."""
    waiting = [action.menu() for action in window.menuBar().actions()]
    while waiting:
        menu = waiting.pop()
        assert isinstance(menu, QMenu)
        menu.aboutToShow.emit()
        yield menu
        waiting += [action.menu() for action in menu.actions() if action.menu() is not None]


def mnemonics(actions: list[QAction]) -> list[str]:
    keys = [QKeySequence.mnemonic(action.text()).toString() for action in actions]
    return [key for key in keys if key]


@pytest.fixture
def sheet_window(window: MainWindow) -> Iterator[SheetWindow]:
    QTest.keyClick(window, Qt.Key.Key_F1, Qt.KeyboardModifier.ControlModifier)
    found = window.findChild(SheetWindow)
    assert found is not None and found.isVisible()
    yield found
    found.close()


# ---------------------------------------------------------------------------------------------- laws


def test_no_key_stands_for_two_things_in_the_window(window: MainWindow) -> None:
    for menu in menus(window):
        menu.actions()
    actions = [
        action for action in window.findChildren(QAction) if action.shortcutContext() != Qt.ShortcutContext.WidgetShortcut
    ]
    keys = [key for action in actions for key in keys_of(action)]
    assert len(keys) > 40
    assert not twice(keys)
    assert not twice([keys for text in TEXTS.values() for keys in text.keys])


def test_keys_of_a_drag_are_no_shortcuts(window: MainWindow) -> None:
    """What B and L of an area mean is the same as what they mean without one; these would be pressed by mistake."""
    taken = {key for action in window.findChildren(QAction) for key in keys_of(action)}
    assert not taken & VIEW_KEYS


def test_no_key_stands_for_two_things_in_a_race() -> None:
    keys = [keys for _, _, keys, *_ in (*ACTIONS, *IN_WORDS, *UNSEEN) if keys]
    assert not twice([*keys, QKeySequence(HOLD_KEY).toString()])


def test_no_letter_stands_twice_in_a_menu(window: MainWindow) -> None:
    found = {"the menu bar": twice(mnemonics(window.menuBar().actions()))}
    for menu in menus(window):
        found[plain(menu.title())] = twice(mnemonics(menu.actions()))
    assert not {name: letters for name, letters in found.items() if letters}


@given(st.lists(st.text(alphabet="ab& \t1", max_size=8), max_size=12))
def test_letters_are_given_once_and_words_stay(texts: list[str]) -> None:
    found = with_letters(texts)
    letters = [letter_of(text) for text in found if letter_of(text)]
    assert len(set(letters)) == len(letters)
    for before, after in zip(texts, found, strict=True):
        assert before.replace("&", "") == after.replace("&", "")
        if not letter_of(before):
            assert before == after


def test_who_wishes_first_has_the_letter() -> None:
    assert with_letters(["&Move", "&Mirror", "&More", "Mine"]) == ["&Move", "M&irror", "M&ore", "Mine"]
    assert with_letters(["&Cut", "Show &all", "&Close it"]) == ["&Cut", "Show &all", "Close &it"]
    assert with_letters(["&A", "&A"]) == ["&A", "A"]


def test_everything_is_said(window: MainWindow) -> None:
    for name, text in TEXTS.items():
        assert text.text and text.tip, name
        assert not text.tip.endswith("."), name
    for name, action in window.actions_by_name.items():
        assert plain(action.text()) and action.toolTip() and action.statusTip(), name


def test_every_action_can_be_reached_from_a_menu(window: MainWindow) -> None:
    listed = {action for menu in menus(window) for action in menu.actions()}
    assert not [name for name, action in window.actions_by_name.items() if action not in listed]


def test_every_button_of_the_tool_bar_has_a_picture(window: MainWindow) -> None:
    bar = window.findChild(QToolBar, "tools")
    assert not [action.text() for action in bar.actions() if not action.isSeparator() and action.icon().isNull()]


# ---------------------------------------------------------------------------------------------- the sheet


def test_the_sheet_has_every_key_of_the_window(window: MainWindow) -> None:
    sheet = sheet_of(window)
    told = {key for rows in sheet.values() for keys, _ in rows for key in keys.split(", ")}
    for menu in menus(window):
        for action in actions_in(menu):
            assert set(keys_of(action)) <= told, action.text()
    assert set(GESTURES) < set(sheet)
    assert all(words for rows in sheet.values() for _, words in rows)


def test_words_find_keys_and_keys_find_words() -> None:
    sheet = {"File": [("Ctrl+O", "Open a mesh"), ("Ctrl+S", "Save <it> & go")], "Views": [("F", "Fit")]}
    assert filtered(sheet, "ctrl+s") == {"File": sheet["File"][1:]}
    assert filtered(sheet, "views") == {"Views": sheet["Views"]}
    assert filtered(sheet, "file mesh") == {"File": sheet["File"][:1]}
    assert filtered(sheet, "") == sheet and filtered(sheet, "nothing") == {}
    assert "&lt;it&gt; &amp; go" in as_html(sheet)
    assert as_text(sheet).splitlines()[1] == "Ctrl+O\tOpen a mesh"


def test_what_is_shown_is_copied_and_printed(sheet_window: SheetWindow, tmp_path: Path, qtbot: QtBot) -> None:
    QTest.keyClicks(sheet_window.line, "falloff")
    text = sheet_window.page.toPlainText()
    assert "falloff" in text.lower() and "Ctrl+O" not in text
    sheet_window.copy()
    copied = QApplication.clipboard().text()
    assert "falloff" in copied.lower() and "Ctrl+O" not in copied
    sheet_window.save(str(tmp_path / "keys.pdf"))
    assert (tmp_path / "keys.pdf").read_bytes().startswith(b"%PDF")
    sheet_window.save(str(tmp_path / "no such folder" / "keys.pdf"))
    assert "could not be written" in sheet_window.note.text()


def test_the_sheet_is_the_same_whatever_was_done(window: MainWindow) -> None:
    before = sheet_of(window)
    window.document.add_anchor(30)
    assert "anchor" in window.actions_by_name["undo"].text()
    assert sheet_of(window) == before
