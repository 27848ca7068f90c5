"""Underlined letters of menus: each stands for one entry only."""

from __future__ import annotations

import re
from collections.abc import Iterable

from PySide6.QtGui import QAction
from PySide6.QtWidgets import QMenu, QMenuBar

_MARK = re.compile(r"&(?!&)(?<!&&)")


def letter_of(text: str) -> str:
    """The letter that is underlined, small; empty where there is none."""
    found = _MARK.search(text)
    return text[found.end() : found.end() + 1].casefold() if found else ""


def with_letters(texts: Iterable[str]) -> list[str]:
    """`texts` with the letters that are wished for; of two that wish for the same one the later has another, or none.

    Beginnings of words come first. What wishes for none has none.
    """
    texts = list(texts)
    taken: set[str] = set()
    late = []
    for place, text in enumerate(texts):
        letter = letter_of(text)
        if letter and letter in taken:
            late.append(place)
        taken.add(letter)
    for place in late:
        texts[place] = _with_another(texts[place], taken)
        taken.add(letter_of(texts[place]))
    return texts


def _with_another(text: str, taken: set[str]) -> str:
    plain = _MARK.sub("", text)
    words = plain.partition("\t")[0]
    begins = [found.start() for found in re.finditer(r"\b\w", words)]
    for place in (*begins, *range(len(words))):
        if words[place].isalnum() and words[place].casefold() not in taken:
            return f"{plain[:place]}&{plain[place:]}"
    return plain


def settle(actions: Iterable[QAction]) -> None:
    """Give each of these entries a letter of its own, where it wished for one."""
    shown = [action for action in actions if not action.isSeparator()]
    for action, text in zip(shown, with_letters(action.text() for action in shown), strict=True):
        if text != action.text():
            action.setText(text)


def settle_menus(bar: QMenuBar) -> None:
    """Do so in a menu bar and in every menu of it, now and whenever one is opened, after what fills it."""
    settle(bar.actions())
    for action in bar.actions():
        menu = action.menu()
        if isinstance(menu, QMenu):
            _settle_menu(menu)


def _settle_menu(menu: QMenu) -> None:
    if not menu.property("letters"):
        menu.setProperty("letters", True)
        menu.aboutToShow.connect(lambda: _settle_menu(menu))
    settle(menu.actions())
    for action in menu.actions():
        inner = action.menu()
        if isinstance(inner, QMenu):
            _settle_menu(inner)
