"""Names that begin like the word at the cursor, in a list below it."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QPoint, Qt, Signal
from PySide6.QtWidgets import QFrame, QListWidget, QListWidgetItem, QWidget

MOST_ROWS = 8


class CompletionList(QListWidget):
    """A plain child of the window, which never takes the focus from the editor; `picked` carries the word."""

    picked = Signal(str)

    def __init__(self, editor: QWidget) -> None:
        super().__init__(editor)
        self._editor = editor
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setFrameShape(QFrame.Shape.Box)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.itemClicked.connect(lambda item: self.picked.emit(item.data(Qt.ItemDataRole.UserRole)))
        self.hide()

    def offer(self, words: Sequence[tuple[str, str]], below: QPoint, line_height: int) -> None:
        """Show (word, remark) pairs below a point of the editor; hide where there is none."""
        if not words:
            self.hide()
            return
        window = self._editor.window()
        if self.parentWidget() is not window:
            self.setParent(window)
        self.clear()
        for word, remark in words:
            item = QListWidgetItem(f"{word}   {remark}" if remark else word)
            item.setData(Qt.ItemDataRole.UserRole, word)
            self.addItem(item)
        self.setCurrentRow(0)
        rows = min(len(words), MOST_ROWS)
        height = rows * self.sizeHintForRow(0) + 2 * self.frameWidth()
        width = max(150, self.sizeHintForColumn(0) + 2 * self.frameWidth() + (20 if len(words) > rows else 4))
        place = self._editor.mapTo(window, below)
        x = max(2, min(place.x(), window.width() - width - 2))
        y = place.y() if place.y() + height < window.height() else place.y() - height - line_height
        self.setGeometry(x, y, width, height)
        self.show()
        self.raise_()

    def move_by(self, rows: int) -> None:
        self.setCurrentRow((self.currentRow() + rows) % max(self.count(), 1))

    @property
    def word(self) -> str:
        """The one that Enter would take."""
        item = self.currentItem()
        return str(item.data(Qt.ItemDataRole.UserRole)) if item is not None else ""
