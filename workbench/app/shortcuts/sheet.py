"""The sheet of all keys and gestures, made from the actions themselves."""

from __future__ import annotations

import html
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from PySide6.QtGui import QAction, QKeySequence
from PySide6.QtWidgets import QMenu

from workbench.app.actions import TITLE
from workbench.app.palette.collecting import plain
from workbench.app.shortcuts.gestures import GESTURES, RACE_GESTURES

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

Sheet = dict[str, list[tuple[str, str]]]
"""Keys and what they do, by sections."""
ANYWHERE = "Anywhere"


def sheet_of(window: MainWindow) -> Sheet:
    """Every key of the window in the order of the menus, then gestures, then the window of a race."""
    sheet: Sheet = {}
    seen: set[QAction] = set()
    for top in window.menuBar().actions():
        menu = top.menu()
        if isinstance(menu, QMenu):
            _add(sheet, plain(top.text()), list(actions_in(menu)), seen)
    _add(sheet, ANYWHERE, [action for action in window.findChildren(QAction) if action.associatedObjects()], seen)
    sheet |= {section: list(rows) for section, rows in GESTURES.items()}
    sheet["In a race"] = [*_race_rows(), *RACE_GESTURES]
    return sheet


def actions_in(menu: QMenu) -> Iterator[QAction]:
    """Of a menu and those inside it, separators left out."""
    for action in menu.actions():
        inner = action.menu()
        if isinstance(inner, QMenu):
            yield from actions_in(inner)
        elif not action.isSeparator():
            yield action


def keys_of(action: QAction) -> list[str]:
    """All shortcuts as a person writes them."""
    return [key.toString(QKeySequence.SequenceFormat.NativeText) for key in action.shortcuts()]


def _add(sheet: Sheet, section: str, actions: Sequence[QAction], seen: set[QAction]) -> None:
    rows = []
    for action in actions:
        if action.shortcuts() and action not in seen:
            seen.add(action)
            rows.append((", ".join(keys_of(action)), words_of(action)))
    if rows:
        sheet[section] = rows


def words_of(action: QAction) -> str:
    """The text of an action, and its tip where that says more; keys in brackets at its end are said already."""
    text, tip = plain(action.property(TITLE) or action.text()).rstrip("…"), action.statusTip() or action.toolTip()
    for key in action.shortcuts():
        tip = tip.replace(f" ({key.toString()})", "")
    return (
        text
        if not tip or plain(tip).rstrip("….") == text
        else f"{text}: {tip[0].lower() if tip[1:2].islower() else tip[0]}{tip[1:]}"
    )


def _race_rows() -> Iterator[tuple[str, str]]:
    from workbench.app.race.race_window import ACTIONS, IN_WORDS, UNSEEN

    for _, text, keys, *_, tip in (*ACTIONS, *IN_WORDS):
        if keys:
            yield keys, f"{text.rstrip('…')}: {tip.removesuffix(f' ({keys})')}"
    for _, text, keys in UNSEEN:
        yield keys, text


def filtered(sheet: Mapping[str, Sequence[tuple[str, str]]], typed: str) -> Sheet:
    """Rows in which every word that was typed stands; a word may also be that of the section."""
    words = typed.casefold().split()
    found: Sheet = {}
    for section, rows in sheet.items():
        kept = [row for row in rows if all(word in f"{section} {row[0]} {row[1]}".casefold() for word in words)]
        if kept:
            found[section] = kept
    return found


def as_html(sheet: Mapping[str, Sequence[tuple[str, str]]]) -> str:
    """Tables with headings, for a page or the screen."""
    parts = []
    for section, rows in sheet.items():
        lines = "".join(
            f"<tr><td width='190'><b>{html.escape(keys)}</b></td><td>{html.escape(words)}</td></tr>" for keys, words in rows
        )
        parts.append(f'<h3>{html.escape(section)}</h3><table cellpadding="3">{lines}</table>')
    return "".join(parts)


def as_text(sheet: Mapping[str, Sequence[tuple[str, str]]]) -> str:
    """Lines with tabs, as for a spreadsheet."""
    lines = []
    for section, rows in sheet.items():
        lines += [section, *(f"{keys}\t{words}" for keys, words in rows), ""]
    return "\n".join(lines)
