"""The panel with all that was told: levels, search, details, copy and save."""

from __future__ import annotations

import logging
from pathlib import Path

from PySide6.QtCore import QEvent, QModelIndex, QObject, QSortFilterProxyModel, Qt, Signal
from PySide6.QtWidgets import (
    QAbstractItemView,
    QApplication,
    QComboBox,
    QDockWidget,
    QHBoxLayout,
    QHeaderView,
    QLabel,
    QLineEdit,
    QPlainTextEdit,
    QSplitter,
    QTableView,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from workbench.app.docks.dock_title import DockTitle
from workbench.app.files.file_choice import last_folder
from workbench.app.files.new_file import ask_new_file
from workbench.app.notices.notice import Notice
from workbench.app.notices.notice_list import NoticeList
from workbench.core.errors import WorkbenchError
from workbench.io.atomic import write_text

CHOICES = (
    ("Everything", logging.DEBUG),
    ("Notes and worse", logging.INFO),
    ("Warnings and errors", logging.WARNING),
    ("Errors", logging.ERROR),
)

ROOM_FOR_ALL = 75
"""Letters that the table is to be wide for its last column to be seen."""


class _Filter(QSortFilterProxyModel):
    """Notices of a level and worse that hold the words that are looked for."""

    least = logging.INFO
    words = ""

    def choose(self, least: int, words: str) -> None:
        self.least, self.words = least, words.casefold()
        self.invalidate()

    def filterAcceptsRow(self, row: int, parent: object) -> bool:
        notices = self.sourceModel().notices  # type: ignore[attr-defined]
        notice: Notice = notices[row]
        return notice.level >= self.least and self.words in f"{notice.source} {notice.text} {notice.details}".casefold()


class LogDock(QDockWidget):
    """Shows a `NoticeList`; it follows the newest while its end is seen."""

    failed = Signal(str)
    saved = Signal(str)

    def __init__(self, notices: NoticeList, file: Path | None, parent: QWidget | None = None) -> None:
        super().__init__("Log", parent)
        self.setObjectName("log")
        self.setTitleBarWidget(DockTitle(self, QLabel("Log", self)))
        self._notices = notices
        body = QWidget(self)
        self.level = QComboBox(body)
        for text, level in CHOICES:
            self.level.addItem(text, level)
        self.level.setCurrentIndex(1)
        self.level.setToolTip("Which notices are listed; all of them are kept")
        self.search = QLineEdit(body)
        self.search.setPlaceholderText("Search")
        self.search.setClearButtonEnabled(True)
        self.search.setMaximumWidth(220)
        bar = QHBoxLayout()
        bar.setContentsMargins(8, 3, 8, 3)
        bar.addWidget(self.level)
        bar.addWidget(self.search)
        bar.addStretch(1)
        for text, tip, deed in (
            ("Copy all", "Copy what is listed, with its details", self.copy_all),
            ("Save…", "Save what is listed to a file", self._ask_save),
            ("Clear", "Empty the list; the file stays", notices.clear),
        ):
            button = QToolButton(body)
            button.setText(text)
            button.setToolTip(tip)
            button.clicked.connect(lambda _=False, d=deed: d())
            bar.addWidget(button)
        self._shown = _Filter(self)
        self._shown.setSourceModel(notices)
        self.table = QTableView(body)
        self.table.setModel(self._shown)
        self._set_table()
        self.details = QPlainTextEdit(body)
        self.details.setReadOnly(True)
        self.details.setPlaceholderText("Details of the notice that is chosen")
        self.details.hide()  # the list has the room until one is chosen
        notices.modelReset.connect(self.details.hide)
        split = QSplitter(Qt.Orientation.Horizontal, body)
        split.addWidget(self.table)
        split.addWidget(self.details)
        split.setStretchFactor(0, 3)
        split.setStretchFactor(1, 1)
        layout = QVBoxLayout(body)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        layout.addLayout(bar)
        layout.addWidget(split, 1)
        if file is not None:
            place = QLabel(f"Also kept in {file}", body)
            place.setObjectName("citation")
            place.setContentsMargins(8, 2, 8, 3)
            place.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
            layout.addWidget(place)
        self.setWidget(body)
        self.level.currentIndexChanged.connect(lambda _: self._choose())
        self.search.textChanged.connect(lambda _: self._choose())
        self.table.selectionModel().currentChanged.connect(self._show_details)
        self.table.installEventFilter(self)
        self._shown.rowsAboutToBeInserted.connect(self._look_at_end)
        self._shown.rowsInserted.connect(self._follow)
        self._is_at_end = True

    def _set_table(self) -> None:
        table = self.table
        table.setShowGrid(False)
        table.setFrameShape(QTableView.Shape.NoFrame)
        table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        table.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        table.verticalHeader().hide()
        table.verticalHeader().setDefaultSectionSize(table.fontMetrics().height() + 6)
        table.setWordWrap(False)
        header = table.horizontalHeader()
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        header.setSectionResizeMode(QHeaderView.ResizeMode.Interactive)
        header.setSectionResizeMode(2, QHeaderView.ResizeMode.Stretch)
        wide = table.fontMetrics().horizontalAdvance
        for column, text in ((0, "00:00:00"), (1, "warning"), (3, "workbench.window")):
            table.setColumnWidth(column, wide(text) + 24)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if watched is self.table and event.type() == QEvent.Type.Resize:  # what was told comes before who told it
            self.table.setColumnHidden(3, self.table.width() < self.fontMetrics().averageCharWidth() * ROOM_FOR_ALL)
        return super().eventFilter(watched, event)

    @property
    def text(self) -> str:
        """What is listed, a line a notice."""
        rows = (self._shown.mapToSource(self._shown.index(row, 0)).row() for row in range(self._shown.rowCount()))
        return "".join(self._notices.notices[row].line + "\n" for row in rows)

    def copy_all(self) -> None:
        QApplication.clipboard().setText(self.text)

    def save(self, path: str) -> None:
        """Write what is listed; `saved` or `failed` tells how it went."""
        try:
            write_text(path, self.text)
        except WorkbenchError as error:
            self.failed.emit(error.sentence)
        else:
            self.saved.emit(path)

    def bring_up(self) -> None:
        """Bring it up."""
        self.show()
        self.raise_()

    def _ask_save(self) -> None:
        place = str(Path(last_folder(self)) / "workbench-log.txt")
        ask_new_file(self, "Save the log", place, "Text (*.txt)", "txt", self.save, overwrites=True)

    def _choose(self) -> None:
        self._shown.choose(self.level.currentData(), self.search.text())
        self.table.scrollToBottom()

    def _show_details(self, index: QModelIndex) -> None:
        row = self._shown.mapToSource(index).row() if index.isValid() else -1
        notice = self._notices.notices[row] if row >= 0 else None
        self.details.setVisible(notice is not None)
        self.details.setPlainText("" if notice is None else notice.text + ("\n\n" + notice.details if notice.details else ""))

    def _look_at_end(self) -> None:
        bar = self.table.verticalScrollBar()
        self._is_at_end = bar.value() >= bar.maximum() - 1

    def _follow(self) -> None:
        if self._is_at_end:
            self.table.scrollToBottom()
