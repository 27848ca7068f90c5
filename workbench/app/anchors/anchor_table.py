"""The table of anchors as a widget: keys of its own, selection of rows, and how cells look."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QEvent, QItemSelection, QItemSelectionModel, QItemSelectionRange, Qt, Signal
from PySide6.QtGui import QAction, QContextMenuEvent, QKeyEvent, QKeySequence, QMouseEvent, QPalette
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHeaderView,
    QMenu,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QTableView,
    QWidget,
)

from workbench.app.anchors.anchor_table_model import AnchorTableModel, Index
from workbench.core.arrays import Integers

ROW_HEIGHT = 20
MARGIN = 10
"""Pixels of a column beside its text."""
ARROW = 14
"""Pixels for the mark of the column that was sorted by."""
Keys = QKeySequence.StandardKey
Triggers = QAbstractItemView.EditTrigger
OWN = tuple(getattr(Qt.Key, f"Key_{name}") for name in ("Home", "End", "Return", "Enter", "Escape", "Backspace", "Space"))


class AnchorTable(QTableView):
    """Rows are selected as a whole; what is typed goes to all selected rows. Keys that mean something here stay here."""

    chosen = Signal()
    """The user has selected other rows."""
    copy_wanted = Signal()
    paste_wanted = Signal()
    delete_wanted = Signal()

    def __init__(self, model: AnchorTableModel, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._model = model
        self._is_told = False
        self._left: Integers | None = None
        self.setModel(model)
        self.setItemDelegate(_PaleWhereOff(model, self))
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.setSelectionMode(QAbstractItemView.SelectionMode.ExtendedSelection)
        self.setEditTriggers(Triggers.DoubleClicked | Triggers.EditKeyPressed | Triggers.AnyKeyPressed)
        self.setFrameShape(QTableView.Shape.NoFrame)
        self.setShowGrid(False)
        self.setAlternatingRowColors(True)
        self.setWordWrap(False)
        self.setHorizontalScrollMode(QAbstractItemView.ScrollMode.ScrollPerPixel)
        rows, heads = self.verticalHeader(), self.horizontalHeader()
        rows.setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        rows.setDefaultSectionSize(ROW_HEIGHT)
        rows.hide()
        heads.setMinimumSectionSize(24)
        heads.setHighlightSections(False)
        heads.setDefaultAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        heads.setSortIndicator(-1, Qt.SortOrder.AscendingOrder)
        heads.setSortIndicatorClearable(True)
        self.setSortingEnabled(True)
        for header in (rows, heads):  # they would ask every cell of a column whether it can be selected, each time
            header.setSelectionModel(QItemSelectionModel(model, header))
        self.selectionModel().selectionChanged.connect(self._selection_changed)

    def fit_columns(self) -> None:
        """Give each column the room that its head and its longest ordinary number need."""
        metrics = self.fontMetrics()
        for place, column in enumerate(self._model.columns):
            head = metrics.horizontalAdvance(column.title) + ARROW
            self.setColumnWidth(place, max(head, metrics.horizontalAdvance(column.widest)) + MARGIN)

    # ------------------------------------------------------------------------------------------ selection

    @property
    def chosen_rows(self) -> Integers:
        """(k,) rows that are selected, ascending."""
        ranges = self.selectionModel().selection().toList()
        rows = [np.arange(r.top(), r.bottom() + 1) for r in ranges if r.isValid()]
        return np.unique(np.concatenate(rows)) if rows else np.empty(0, np.int64)

    def choose_rows(self, rows: Integers, *, scroll: bool = True) -> None:
        """Select these rows (k,), ascending, without telling anybody."""
        if np.array_equal(rows, self.chosen_rows):
            return
        found, last = QItemSelection(), len(self._model.columns) - 1
        breaks = np.flatnonzero(np.diff(rows) > 1) + 1
        for run in np.split(rows, breaks) if len(rows) else ():
            found.append(_range(self._model, int(run[0]), int(run[-1]), last))
        self._is_told = True
        self.selectionModel().select(found, QItemSelectionModel.SelectionFlag.ClearAndSelect)
        self._is_told = False
        if len(rows) and scroll:
            column = max(self.currentIndex().column(), 0)
            self.selectionModel().setCurrentIndex(
                self._model.index(int(rows[0]), column), QItemSelectionModel.SelectionFlag.NoUpdate
            )
            self.scrollTo(self._model.index(int(rows[0]), column))

    def _selection_changed(self) -> None:
        if not self._is_told:
            self.chosen.emit()

    # ------------------------------------------------------------------------------------------ mouse

    def _is_plain_on_several(self, index: Index, event: QEvent | None) -> bool:
        """Whether a mouse without keys is on one of several selected rows."""
        if not isinstance(event, QMouseEvent) or event.modifiers() != Qt.KeyboardModifier.NoModifier or not index.isValid():
            return False
        rows = self.chosen_rows
        return len(rows) > 1 and index.row() in rows

    def selectionCommand(self, index: Index, event: QEvent | None = None) -> QItemSelectionModel.SelectionFlag:
        if self._is_plain_on_several(index, event) and self._model.columns[index.column()].key == "on":
            return QItemSelectionModel.SelectionFlag.NoUpdate  # the tick is set for all of them
        return super().selectionCommand(index, event)

    def mousePressEvent(self, event: QMouseEvent) -> None:
        is_first = self._is_plain_on_several(self.indexAt(event.position().toPoint()), event)
        self._left = self.chosen_rows if is_first else None
        super().mousePressEvent(event)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        """The first of two clicks has left one row selected: what is edited is the cell of all that were."""
        if self._left is not None and self.indexAt(event.position().toPoint()).row() in self._left:
            self.choose_rows(self._left, scroll=False)
            self.chosen.emit()
        self._left = None
        super().mouseDoubleClickEvent(event)

    # ------------------------------------------------------------------------------------------ keys

    def event(self, event: QEvent) -> bool:
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent) and self._takes(event):
            event.accept()  # or a shortcut of the window would have it
            return True
        return super().event(event)

    def _takes(self, event: QKeyEvent) -> bool:
        if any(event.matches(keys) for keys in (Keys.Copy, Keys.Paste, Keys.SelectAll, Keys.Delete)):
            return True
        if event.modifiers() & (Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier):
            return False
        # numbers are typed into cells; letters do in the window what they always do, such as G, R, S and L
        return event.key() in OWN or event.text() in tuple("0123456789+-.,")

    def keyPressEvent(self, event: QKeyEvent) -> None:
        if self.state() == QAbstractItemView.State.EditingState:
            super().keyPressEvent(event)  # what the editor of a cell has left over
        elif event.matches(Keys.Copy):
            self.copy_wanted.emit()
        elif event.matches(Keys.Paste):
            self.paste_wanted.emit()
        elif event.matches(Keys.Delete) or event.key() == Qt.Key.Key_Backspace:
            self.delete_wanted.emit()
        elif event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.edit(self.currentIndex())
        elif event.key() == Qt.Key.Key_Escape:
            self.clearSelection()
        else:
            super().keyPressEvent(event)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        for text, keys, deed in (
            ("&Copy rows", "Ctrl+C", self.copy_wanted),
            ("&Paste rows", "Ctrl+V", self.paste_wanted),
            ("&Delete rows", "Del", self.delete_wanted),
        ):
            action = QAction(f"{text}\t{keys}", menu)
            action.triggered.connect(lambda _=False, d=deed: d.emit())
            action.setEnabled(deed is self.paste_wanted or bool(len(self.chosen_rows)))
            menu.addAction(action)
        menu.popup(event.globalPos())


class _PaleWhereOff(QStyledItemDelegate):
    """Numbers of anchors that are off, and those that cannot be edited, are pale."""

    def __init__(self, model: AnchorTableModel, parent: QWidget) -> None:
        super().__init__(parent)
        self._model = model

    def initStyleOption(self, option: QStyleOptionViewItem, index: Index) -> None:
        super().initStyleOption(option, index)
        if not self._model.columns[index.column()].is_editable or self._model.is_off(index.row()):
            palette = option.palette
            palette.setColor(QPalette.ColorRole.Text, palette.color(QPalette.ColorRole.PlaceholderText))
            option.palette = palette


def _range(model: AnchorTableModel, first: int, last: int, last_column: int) -> QItemSelectionRange:
    """Rows from `first` to `last`, whole."""
    return QItemSelectionRange(model.index(first, 0), model.index(last, last_column))
