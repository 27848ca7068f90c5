"""The command palette: a line to type in, and below it what fits."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import QEvent, QModelIndex, QObject, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QApplication, QFrame, QLabel, QLineEdit, QVBoxLayout, QWidget

from workbench.app.palette.entry import Entry, search
from workbench.app.palette.palette_list import PaletteList

WIDTH, ROWS = 640, 14
"""Pixels across, and rows that are shown at once, at the most."""
PLACEHOLDER = "Type some letters of what you want to do"
NOTHING = "Nothing fits."


class Palette(QFrame):
    """Lies over the window near its top. `wanted` carries the entry that was chosen, after the palette is gone."""

    wanted = Signal(object)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("palette")
        self.setFrameShape(QFrame.Shape.StyledPanel)
        self.setAutoFillBackground(True)
        self._entries: Sequence[Entry] = ()
        self._recent: Sequence[str] = ()
        self._focus_before: QWidget | None = None
        self.line = QLineEdit(self)
        self.line.setPlaceholderText(PLACEHOLDER)
        self.line.setClearButtonEnabled(True)
        self.line.textChanged.connect(self._search)
        self.line.installEventFilter(self)
        self.list = PaletteList(self)
        self.list.clicked.connect(self._clicked)
        self.note = QLabel(self)
        self.note.setObjectName("citation")
        self.note.setMinimumWidth(40)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(8, 8, 8, 6)
        layout.setSpacing(6)
        for widget in (self.line, self.list, self.note):
            layout.addWidget(widget)
        self.list.selectionModel().currentChanged.connect(lambda *_: self._say())
        parent.installEventFilter(self)
        self.hide()

    # ------------------------------------------------------------------------------------------ opening

    def open(self, entries: Sequence[Entry], recent: Sequence[str]) -> None:
        """Show these entries, those of the keys `recent` first."""
        self._entries, self._recent = entries, recent
        before = QApplication.focusWidget()
        if before is not self.line:
            self._focus_before = before
        self.line.blockSignals(True)
        self.line.clear()
        self.line.blockSignals(False)
        self._search("")
        self._place()
        self.show()
        self.raise_()
        self.line.setFocus(Qt.FocusReason.PopupFocusReason)

    def renew(self, entries: Sequence[Entry]) -> None:
        """Other entries, while it is open: what is typed and what is marked stay."""
        found, row = self.list.found.found, self.list.currentIndex().row()
        marked = found[row].entry.key if 0 <= row < len(found) else ""
        self._entries = entries
        self._search(self.line.text())
        keys = [one.entry.key for one in self.list.found.found]
        if row > 0 and marked in keys:
            self.list.choose_row(keys.index(marked))

    def close_and_then(self, deed: Callable[[], None] | None = None) -> None:
        """Give the focus back, then do what was chosen."""
        before, self._focus_before = self._focus_before, None
        self.hide()
        self._entries = ()
        self.list.found.show([])
        if before is not None and before.isVisible():
            before.setFocus()
        if deed is not None:
            deed()

    def _place(self) -> None:
        parent = self.parentWidget()
        width = min(WIDTH, parent.width() - 24)
        row = self.list.sizeHintForRow(0) if self.list.found.found else 26
        wanted = self.line.sizeHint().height() + ROWS * row + self.note.sizeHint().height() + 36
        top = min(60, parent.height() // 12)
        self.setGeometry((parent.width() - width) // 2, top, width, min(wanted, parent.height() - top - 24))

    # ------------------------------------------------------------------------------------------ choosing

    def _search(self, typed: str) -> None:
        self.list.found.show(search(self._entries, typed, self._recent))
        self.list.choose_row(0)
        self.list.scrollToTop()
        self._say()

    def _say(self) -> None:
        row = self.list.currentIndex().row()
        found = self.list.found.found
        if not 0 <= row < len(found):
            self.note.setText(NOTHING)
            return
        entry = found[row].entry
        words = entry.tip.split("\n")[0] if "<" not in entry.tip else ""
        room = self.note.fontMetrics().elidedText(words, Qt.TextElideMode.ElideRight, self.width() - 40)
        self.note.setText(room or "Enter does it, Esc leaves it.")

    def _clicked(self, index: QModelIndex) -> None:
        self._run(index.row())

    def _run(self, row: int) -> None:
        found = self.list.found.found
        if 0 <= row < len(found) and found[row].entry.is_enabled:
            entry = found[row].entry
            self.close_and_then(lambda: self.wanted.emit(entry))

    # ------------------------------------------------------------------------------------------ keys

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """Keys of the line that move in the list; the window's own shortcuts wait meanwhile."""
        kind = event.type()
        if watched is self.parentWidget():
            if kind == QEvent.Type.Resize and self.isVisible():
                self._place()
        elif watched is self.line:
            if kind == QEvent.Type.ShortcutOverride:
                event.accept()
                return False
            if kind == QEvent.Type.KeyPress and isinstance(event, QKeyEvent):
                return self._key(event)
            if kind == QEvent.Type.FocusOut and self.isVisible() and QApplication.activePopupWidget() is None:
                self._focus_before = None  # it has gone elsewhere already
                self.close_and_then()
        return super().eventFilter(watched, event)

    def _key(self, event: QKeyEvent) -> bool:
        key, row, page = event.key(), self.list.currentIndex().row(), self.list.rows_in_sight
        count = len(self.list.found.found)
        moves = {Qt.Key.Key_Down: 1, Qt.Key.Key_Up: -1, Qt.Key.Key_PageDown: page, Qt.Key.Key_PageUp: -page}
        if key in moves and count:
            step = moves[Qt.Key(key)]
            self.list.choose_row((row + step) % count if abs(step) == 1 else row + step)
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._run(row)
        elif key == Qt.Key.Key_Escape or (
            key == Qt.Key.Key_P and event.modifiers() == Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier
        ):
            self.close_and_then()
        else:
            return False
        return True
