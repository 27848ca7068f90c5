"""The command palette: what fits comes first, everything is listed, keys and mouse do it."""

from __future__ import annotations

import time
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from workbench.app.main_window import MainWindow
from workbench.app.palette.collecting import entries_of
from workbench.app.palette.entry import Entry, search
from workbench.app.palette.fuzzy import fit
from workbench.app.palette.palette import Palette

WORDS = st.text(alphabet="abcd AB-(", max_size=14)


def entry(title: str, *path: str, **more: object) -> Entry:
    return Entry(title, path, lambda: None, **more)  # type: ignore[arg-type]


def titles(entries: list[Entry], typed: str, recent: tuple[str, ...] = ()) -> list[str]:
    return [found.entry.title for found in search(entries, typed, recent)]


# ---------------------------------------------------------------------------------------------- what fits


@given(WORDS, WORDS)
def test_what_is_typed_fits_exactly_where_its_letters_stand_in_order(typed: str, text: str) -> None:
    rest = iter(text.lower())
    stands = all(letter in rest for letter in typed.lower())
    found = fit(typed, text)
    assert (found is not None) == stands
    if found is not None:
        assert list(found.places) == sorted(set(found.places))
        assert [text[place].lower() for place in found.places] == list(typed.lower())


def test_a_piece_that_stands_as_it_was_typed_is_what_is_meant() -> None:
    for typed, text in (("cut", "Cut the solid"), ("solid", "Show all of the solid"), ("an", "Place an anchor")):
        found = fit(typed, text)
        assert found is not None
        begin = text.lower().index(typed)
        assert found.places == tuple(range(begin, begin + len(typed)))


@pytest.mark.parametrize(
    ("typed", "better", "worse"),
    [
        ("pn", "Projected Newton", "Pin boundary"),
        ("sd", "Symmetric Dirichlet", "Show edges"),
        ("race", "Race solvers…", "Surface to plane"),
        ("open", "Open…", "Open session…"),
        ("cl", "Clear anchors", "Circles"),
    ],
)
def test_beginnings_of_words_and_short_titles_win(typed: str, better: str, worse: str) -> None:
    entries = [entry(worse), entry(better)]
    assert titles(entries, typed)[0] == better


def test_words_may_stand_in_the_path_and_in_any_order() -> None:
    entries = [
        entry("Dark", "View", "Appearance"),
        entry("Determinant", "Show", "Source"),
        entry("Determinant", "Show", "Target"),
    ]
    assert titles(entries, "view dark") == ["Dark"] == titles(entries, "dark appear")
    assert [found.entry.path[1] for found in search(entries, "target det")] == ["Target"]
    assert not search(entries, "target dark")


def test_other_words_are_found_in_one_piece_only() -> None:
    entries = [
        entry("Scalable locally injective mappings", "Choices", "Solver", also="slim"),
        entry("Pause", "Solver", also="run Run or pause the solver (Space)"),
        entry("Refine source and map…", "Edit", also="refine"),
    ]
    assert titles(entries, "slim")[0] == "Scalable locally injective mappings"
    assert titles(entries, "run")[0] == "Pause"
    assert "Pause" not in titles(entries, "rn")


def test_what_was_used_lately_comes_first_among_what_fits_alike() -> None:
    entries = [entry(name, "Solver") for name in ("Step", "Stop", "Store")]
    assert titles(entries, "st", ("Solver › Stop",))[0] == "Stop"
    assert titles(entries, "", ("Solver › Store", "Solver › Stop")) == ["Store", "Stop", "Step"]
    assert titles([*entries, entry("Projected Newton")], "pn", ("Solver › Stop",)) == ["Projected Newton"]


def test_five_hundred_entries_are_searched_between_two_keys() -> None:
    entries = [entry(f"Symmetric Dirichlet, filtered barrier {n}", "Show", f"Colour map {n % 7}") for n in range(600)]
    for typed in ("s", "sym dir", "show colour filtered", "eiiiaei"):
        begun = time.thread_time()  # of this thread alone: the machine may have other things to do
        search(entries, typed)
        assert time.thread_time() - begun < 0.15, typed


# ---------------------------------------------------------------------------------------------- in the window


@pytest.fixture
def palette(window: MainWindow) -> Palette:
    QTest.keyClick(window, Qt.Key.Key_P, Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier)
    palette = window.commands.commanding.palette
    assert palette is not None and palette.isVisible()
    assert palette.line.hasFocus()
    return palette


def shown(palette: Palette) -> list[str]:
    return [found.entry.title for found in palette.list.found.found]


def test_everything_in_menus_and_choices_is_listed(window: MainWindow) -> None:
    entries = entries_of(window)
    found = {(*entry.path, entry.title) for entry in entries}
    for expected in (
        ("File", "Open…"),
        ("View", "Appearance", "Dark"),
        ("File", "Samples", "Annulus"),
        ("Choices", "Solver", "Projected Newton"),
        ("Choices", "Start", "Rest (the source itself)"),
        ("Show", "Histogram", "Determinant"),
        ("Help", "About"),
        ("Preferences", "Appearance", "Size of text…"),
    ):
        assert expected in found
    assert titles(entries, "sample:bar-3d") == ["Solid bar"], "as the command line calls it"
    assert len({id(entry) for entry in entries}) == len(entries) == len({(entry.place, entry.title) for entry in entries})
    assert not [entry.title for entry in entries if not entry.is_enabled and not entry.reason]
    for name, action in window.actions_by_name.items():
        assert any(entry.name == name for entry in entries) == action.isVisible(), name


def test_enter_does_what_is_chosen_and_gives_the_focus_back(window: MainWindow, palette: Palette) -> None:
    before = window.document.session.solver
    QTest.keyClicks(palette.line, "gradient desc")
    assert shown(palette)[0] == "Gradient descent"
    QTest.keyClick(palette.line, Qt.Key.Key_Return)
    assert not palette.isVisible()
    assert window.document.session.solver == "gradient-descent" != before
    assert not palette.line.hasFocus()
    window.commands.commanding.ask()
    assert shown(palette)[0] == "Gradient descent", "used last, listed first"
    QTest.keyClick(palette.line, Qt.Key.Key_Escape)


def test_keys_of_the_window_are_letters_here_and_escape_changes_nothing(window: MainWindow, palette: Palette) -> None:
    window.actions_by_name["edges"].setChecked(False)
    window.document.add_anchor(0)
    window.document.select(0)
    QTest.keyClicks(palette.line, "e. f")
    QTest.keyClick(palette.line, Qt.Key.Key_Backspace)
    assert palette.line.text() == "e. "
    assert not window.actions_by_name["edges"].isChecked()
    assert not window.document.wants_to_run and len(window.document.anchors) == 1
    QTest.keyClick(palette.line, Qt.Key.Key_Escape)
    assert not palette.isVisible()


def test_what_comes_while_it_is_open_is_listed(window: MainWindow, palette: Palette, qtbot: QtBot) -> None:
    def state() -> bool | None:
        found = palette.list.found.found[0].entry
        assert found.title == "Gradient descent" and palette.line.text() == "gradient desc"
        return found.is_checked

    QTest.keyClicks(palette.line, "gradient desc")
    was = state()
    window.document.choose(solver="slim" if was else "gradient-descent")
    qtbot.waitUntil(lambda: state() is not was)
    QTest.keyClick(palette.line, Qt.Key.Key_Escape)


def test_arrows_go_round_and_the_mouse_chooses(window: MainWindow, palette: Palette) -> None:
    QTest.keyClicks(palette.line, "edges")
    count = len(shown(palette))
    QTest.keyClick(palette.line, Qt.Key.Key_Up)
    assert palette.list.currentIndex().row() == count - 1
    QTest.keyClick(palette.line, Qt.Key.Key_Down)
    assert palette.list.currentIndex().row() == 0
    was = window.actions_by_name["edges"].isChecked()
    where = palette.list.visualRect(palette.list.currentIndex()).center()
    QTest.mouseClick(palette.list.viewport(), Qt.MouseButton.LeftButton, Qt.KeyboardModifier.NoModifier, where)
    assert window.actions_by_name["edges"].isChecked() is not was
    assert not palette.isVisible()


def test_what_cannot_be_done_says_why_and_is_not_done(window: MainWindow, palette: Palette) -> None:
    QTest.keyClicks(palette.line, "cut the solid")
    found = palette.list.found.found[0].entry
    assert (found.title, found.is_enabled, found.reason) == ("Cut the solid", False, "what is open is no solid")
    QTest.keyClick(palette.line, Qt.Key.Key_Return)
    assert palette.isVisible()
    QTest.keyClick(palette.line, Qt.Key.Key_Escape)


def test_a_click_elsewhere_closes_it(window: MainWindow, palette: Palette, qtbot: QtBot) -> None:
    QTest.mouseClick(window.panel.distortion.edit.viewport(), Qt.MouseButton.LeftButton, pos=QPoint(20, 8))
    qtbot.waitUntil(lambda: not palette.isVisible())
    assert window.panel.distortion.edit.hasFocus()


def test_it_stays_inside_a_small_window(window: MainWindow, palette: Palette) -> None:
    size = window.size()
    window.resize(700, 500)
    QTest.qWait(30)
    assert window.rect().contains(palette.geometry())
    window.resize(size)
    QTest.keyClick(palette.line, Qt.Key.Key_Escape)


def test_what_can_be_used_comes_before_what_cannot() -> None:
    """Enter does the first of them; what is grey is still found, with its reason."""
    grey = Entry("More glyphs", ("View", "Glyphs"), lambda: None, is_enabled=False, reason="no glyphs are drawn")
    usable = Entry("Ellipses", ("View", "Glyphs"), lambda: None)
    assert [one.entry for one in search([grey, usable], "glyph")] == [usable, grey]
    assert next(one.entry for one in search([usable, replace(grey, is_enabled=True)], "glyph")).title == "More glyphs"
    assert [one.entry for one in search([usable, grey], "more gl")] == [grey]
