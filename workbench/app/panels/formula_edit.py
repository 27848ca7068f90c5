"""Typing a formula: coloured, completed, its fault marked where it is."""

from __future__ import annotations

import re
from collections.abc import Mapping

from PySide6.QtCore import QEvent, QPoint, QSize, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QFocusEvent,
    QFontDatabase,
    QKeyEvent,
    QResizeEvent,
    QTextCharFormat,
    QTextCursor,
    QTextOption,
)
from PySide6.QtWidgets import QPlainTextEdit, QSizePolicy, QTextEdit, QWidget

from workbench.app.panels.completion_list import CompletionList
from workbench.app.panels.formula_colours import FormulaColours, is_dark

FEWEST_LINES, MOST_LINES = 2, 7
_OWN_KEYS = (Qt.Key.Key_Escape, Qt.Key.Key_Return, Qt.Key.Key_Enter)
_WORD_BEFORE = re.compile(r"[A-Za-z_][A-Za-z0-9_]*$")
_TOKEN = re.compile(r"[A-Za-z0-9_.]+|.", re.DOTALL)


class FormulaEdit(QPlainTextEdit):
    """One line of text, wrapped. Enter: `accepted`, Esc: `given_up`, each change by hand: `edited`."""

    accepted = Signal()
    given_up = Signal()
    edited = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setFont(QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont))
        self.setTabChangesFocus(True)
        self.setWordWrapMode(QTextOption.WrapMode.WrapAtWordBoundaryOrAnywhere)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setVerticalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAsNeeded)
        self.document().setDocumentMargin(4)
        self.colours = FormulaColours(self.document())
        self.completions = CompletionList(self)
        self.completions.picked.connect(self.complete)
        self._words: dict[str, str] = {}
        self._is_setting = False
        self.marked: tuple[int, int] | None = None
        self.textChanged.connect(self._changed)
        self._fit_height()

    @property
    def text(self) -> str:
        return self.toPlainText().replace("\n", " ")

    def set_text(self, text: str) -> None:
        """Show a text without `edited`."""
        self.mark(None)
        if text != self.toPlainText():
            self._is_setting = True
            self.setPlainText(text)
            self._is_setting = False
        self.completions.hide()

    def set_words(self, words: Mapping[str, str]) -> None:
        """What completion offers: names and short remarks."""
        self._words = dict(words)

    def mark(self, position: int | None) -> None:
        """Underline the word, number or sign at a column (from 0); None takes the mark away."""
        self.marked = None if position is None else self._token_at(position)
        selections = []
        if self.marked is not None:
            selection = QTextEdit.ExtraSelection()
            cursor = self.textCursor()
            cursor.setPosition(self.marked[0])
            cursor.setPosition(self.marked[1], QTextCursor.MoveMode.KeepAnchor)
            style = QTextCharFormat()
            red = QColor("#ff6b6b" if is_dark(self.palette()) else "#c4271b")
            style.setUnderlineStyle(QTextCharFormat.UnderlineStyle.WaveUnderline)
            style.setUnderlineColor(red)
            red.setAlpha(60)
            style.setBackground(red)
            selection.cursor, selection.format = cursor, style  # type: ignore[attr-defined]
            selections.append(selection)
        self.setExtraSelections(selections)

    def _token_at(self, position: int) -> tuple[int, int] | None:
        text = self.toPlainText()
        if not text:
            return None
        for token in _TOKEN.finditer(text):
            if token.end() > position and not token.group().isspace():
                return token.span()
        return len(text.rstrip()) - 1, len(text)  # the fault is that something is missing at the end

    # ------------------------------------------------------------------------------------------ completion

    def complete(self, word: str) -> None:
        """Put a name in the place of what was begun."""
        cursor = self.textCursor()
        begun = self.begun
        cursor.setPosition(cursor.position() - len(begun), QTextCursor.MoveMode.KeepAnchor)
        cursor.insertText(word)
        self.setTextCursor(cursor)
        self.completions.hide()

    @property
    def begun(self) -> str:
        """The part of a name before the cursor."""
        match = _WORD_BEFORE.search(self.toPlainText()[: self.textCursor().position()])
        return match.group() if match else ""

    def offer_completions(self, *, always: bool = False) -> None:
        begun = self.begun
        words = []
        if len(begun) >= 2 or always:
            low = begun.lower()
            ranked = sorted((not w.lower().startswith(low), w.lower(), w) for w in self._words if low in w.lower())
            words = [(w, self._words[w]) for _, _, w in ranked if w != begun and w != f"{begun}("]
            if begun in self._words and not always:
                words = [pair for pair in words if pair[0].startswith(begun)]
        rectangle = self.cursorRect()
        below = self.viewport().mapTo(self, rectangle.bottomLeft()) + QPoint(0, 3)
        self.completions.offer(words, below, rectangle.height() + 6)

    # ------------------------------------------------------------------------------------------ Qt's own

    def keyPressEvent(self, event: QKeyEvent) -> None:
        key, listed = event.key(), self.completions.isVisible()
        if listed and key in (Qt.Key.Key_Up, Qt.Key.Key_Down):
            self.completions.move_by(1 if key == Qt.Key.Key_Down else -1)
        elif listed and key == Qt.Key.Key_Tab:
            self.complete(self.completions.word)
        elif listed and key == Qt.Key.Key_Escape:
            self.completions.hide()
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.completions.hide()
            self.accepted.emit()
        elif key == Qt.Key.Key_Escape:
            self.given_up.emit()
        elif key == Qt.Key.Key_Space and event.modifiers() == Qt.KeyboardModifier.ControlModifier:
            self.offer_completions(always=True)
        else:
            super().keyPressEvent(event)
            if (event.text() and event.text().isprintable()) or (listed and key == Qt.Key.Key_Backspace):
                self.offer_completions()
            elif key not in (Qt.Key.Key_Shift, Qt.Key.Key_Control, Qt.Key.Key_Alt):
                self.completions.hide()

    def event(self, event: QEvent) -> bool:
        if isinstance(event, QKeyEvent):
            if event.type() == QEvent.Type.ShortcutOverride and event.key() in _OWN_KEYS:
                event.accept()  # else a shortcut of the window would take it
                return True
            # Qt would move the focus before the key arrives
            is_tab = event.type() == QEvent.Type.KeyPress and event.key() == Qt.Key.Key_Tab
            if is_tab and self.completions.isVisible():
                self.keyPressEvent(event)
                return True
        return super().event(event)

    def focusOutEvent(self, event: QFocusEvent) -> None:
        self.completions.hide()
        super().focusOutEvent(event)

    def resizeEvent(self, event: QResizeEvent) -> None:
        super().resizeEvent(event)
        self._fit_height()

    def changeEvent(self, event: QEvent) -> None:
        super().changeEvent(event)
        if event.type() in (QEvent.Type.PaletteChange, QEvent.Type.StyleChange) and hasattr(self, "colours"):
            self.colours.set_dark(is_dark(self.palette()))

    def sizeHint(self) -> QSize:
        return QSize(200, self.height())

    def _changed(self) -> None:
        self._fit_height()
        if not self._is_setting:
            self.mark(None)
            self.edited.emit()

    def _fit_height(self) -> None:
        lines = min(max(int(self.document().size().height()), FEWEST_LINES), MOST_LINES)
        margins = 2 * (self.frameWidth() + round(self.document().documentMargin()))
        height = lines * self.fontMetrics().lineSpacing() + margins + 1
        if height != self.height():
            self.setFixedHeight(height)
