"""The window of the help: contents and search to the left, a chapter to the right."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtGui import QKeySequence, QShortcut
from PySide6.QtWidgets import (
    QDialog,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QSplitter,
    QToolButton,
    QTreeWidget,
    QTreeWidgetItem,
    QVBoxLayout,
    QWidget,
)

from workbench.app.appearance.theme import Theme
from workbench.app.help.chapters import Chapter, read_chapters, readme_folder
from workbench.app.help.page import HelpPage

NUMBER = Qt.ItemDataRole.UserRole


class HelpWindow(QDialog):
    """Stays beside the main window; contents are those chapters that hold what is looked for."""

    def __init__(self, theme: Theme, parent: QWidget | None = None, folder: Path | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("help")
        self.setWindowTitle("Help")
        self.setWindowFlag(Qt.WindowType.Window)  # with buttons to enlarge it
        self.resize(1120, 760)
        folder = folder or readme_folder()
        self.chapters: tuple[Chapter, ...] = read_chapters(folder)
        self._past: list[int] = []
        self._place = -1
        self.search = QLineEdit(self)
        self.search.setPlaceholderText("Search all chapters (Ctrl+F)")
        self.search.setClearButtonEnabled(True)
        self.contents = QTreeWidget(self)
        self.contents.setHeaderHidden(True)
        self.contents.setFrameShape(QTreeWidget.Shape.NoFrame)
        self.nothing = QLabel("Nothing found.", self)
        self.nothing.setAlignment(Qt.AlignmentFlag.AlignCenter)
        self.nothing.hide()
        self.page = HelpPage(folder, theme, self)
        self.back = _button(self, "←", "Back (Alt+Left)", lambda: self._go(-1))
        self.forth = _button(self, "→", "Forward (Alt+Right)", lambda: self._go(1))
        self.next = _button(self, "Next", "Next place of the words (F3)", self._next)
        row = QHBoxLayout()
        for widget in (self.back, self.forth):
            row.addWidget(widget)
        row.addWidget(self.search, 1)
        row.addWidget(self.next)
        left = QWidget(self)
        column = QVBoxLayout(left)
        column.setContentsMargins(8, 8, 4, 4)
        column.addLayout(row)
        column.addWidget(self.contents, 1)
        column.addWidget(self.nothing, 1)
        split = QSplitter(Qt.Orientation.Horizontal, self)
        split.addWidget(left)
        split.addWidget(self.page)
        split.setSizes([300, 700])
        split.setChildrenCollapsible(False)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(split)
        self.search.textChanged.connect(self._list)
        self.search.returnPressed.connect(self._next)
        self.contents.currentItemChanged.connect(self._chosen)
        for keys, deed in (
            ("Ctrl+F", self._look),
            ("F3", self._next),
            ("Shift+F3", lambda: self.page.find_next(backwards=True)),
            ("Alt+Left", lambda: self._go(-1)),
            ("Alt+Right", lambda: self._go(1)),
        ):
            QShortcut(QKeySequence(keys), self).activated.connect(deed)
        self._list("")
        self.show_chapter(self.chapters[0].title)

    def set_theme(self, theme: Theme) -> None:
        self.page.set_theme(theme)

    def show_chapter(self, title: str) -> None:
        """Open a chapter by its title, or the first where there is none of that name."""
        numbers = [n for n, chapter in enumerate(self.chapters) if chapter.title == title] or [0]
        self.search.clear()
        self.contents.setCurrentItem(self._items[numbers[0]])

    @property
    def title(self) -> str:
        """Of the chapter that is shown."""
        return self.chapters[self._past[self._place]].title if self._past else ""

    # ------------------------------------------------------------------------------------------

    def _list(self, words: str) -> None:
        """Those chapters that hold the words, the parts below their chapters."""
        shown = self._past[self._place] if self._past else 0
        self._items: dict[int, QTreeWidgetItem] = {}
        self.contents.blockSignals(True)
        self.contents.clear()
        above: QTreeWidgetItem | None = None
        for number, chapter in enumerate(self.chapters):
            if chapter.level < 3:
                above = None
            if not chapter.holds(words):
                continue
            item = QTreeWidgetItem([chapter.title])
            item.setData(0, NUMBER, number)
            self._items[number] = item
            if chapter.level == 3 and above is not None:
                above.addChild(item)
            else:
                self.contents.addTopLevelItem(item)
                above = item if chapter.level < 3 else None
        self.contents.expandAll()
        self.contents.blockSignals(False)
        self.contents.setVisible(bool(self._items))
        self.nothing.setVisible(not self._items)
        self.next.setEnabled(bool(words.split()))
        if self._items:
            number = shown if shown in self._items else next(iter(self._items))
            self.contents.setCurrentItem(self._items[number])
            self._show(number)

    def _chosen(self, item: QTreeWidgetItem | None, _: QTreeWidgetItem | None) -> None:
        if item is not None:
            self._show(item.data(0, NUMBER))

    def _show(self, number: int) -> None:
        if not self._past or self._past[self._place] != number:
            del self._past[self._place + 1 :]
            self._past.append(number)
            self._place = len(self._past) - 1
        self.page.show_chapter(self.chapters[number], self.search.text())
        self._show_ways()

    def _go(self, by: int) -> None:
        if 0 <= self._place + by < len(self._past):
            self._place += by
            number = self._past[self._place]
            self.search.blockSignals(True)
            self.search.clear()
            self.search.blockSignals(False)
            self._list("")
            self.contents.setCurrentItem(self._items[number])
            self._show_ways()

    def _show_ways(self) -> None:
        self.back.setEnabled(self._place > 0)
        self.forth.setEnabled(self._place < len(self._past) - 1)

    def _look(self) -> None:
        self.search.setFocus()
        self.search.selectAll()

    def _next(self) -> None:
        """The next place of the words on the page; after the last, the next chapter that holds them."""
        self.page.find_next()


def _button(parent: QWidget, text: str, tip: str, deed: object) -> QToolButton:
    button = QToolButton(parent)
    button.setText(text)
    button.setToolTip(tip)
    button.clicked.connect(lambda _=False: deed())  # type: ignore[operator]
    return button
