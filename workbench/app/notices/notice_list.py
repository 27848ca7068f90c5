"""All that was told since the window was opened, as a table; what comes again is counted."""

from __future__ import annotations

from typing import Any

from PySide6.QtCore import QAbstractTableModel, QModelIndex, QObject, QPersistentModelIndex, Qt
from PySide6.QtGui import QColor

from workbench.app.appearance.theme import Theme
from workbench.app.notices.notice import LEVELS, Notice

MOST = 2000
"""Notices; the oldest make room."""
LOOKED_BACK = 6
"""Among so many of the newest a notice is looked for that tells the same: two that take turns are counted, too."""
COLUMNS = ("Time", "Level", "What", "From")
Index = QModelIndex | QPersistentModelIndex


class NoticeList(QAbstractTableModel):
    """Newest last."""

    def __init__(self, theme: Theme, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.notices: list[Notice] = []
        self._theme = theme

    def set_theme(self, theme: Theme) -> None:
        self._theme = theme
        if self.notices:
            self.dataChanged.emit(self.index(0, 0), self.index(len(self.notices) - 1, len(COLUMNS) - 1))

    def add(self, notice: Notice) -> Notice:
        """Append it, or count it where one of the newest tells the same; the one that stands for it."""
        for row in range(len(self.notices) - 1, max(len(self.notices) - LOOKED_BACK, 0) - 1, -1):
            known = self.notices[row]
            if known.is_like(notice):
                known.count, known.at, known.details = known.count + 1, notice.at, notice.details or known.details
                self.dataChanged.emit(self.index(row, 0), self.index(row, len(COLUMNS) - 1))
                return known
        if len(self.notices) >= MOST:
            self.beginRemoveRows(QModelIndex(), 0, 0)
            del self.notices[0]
            self.endRemoveRows()
        self.beginInsertRows(QModelIndex(), len(self.notices), len(self.notices))
        self.notices.append(notice)
        self.endInsertRows()
        return notice

    def clear(self) -> None:
        self.beginResetModel()
        self.notices.clear()
        self.endResetModel()

    # ------------------------------------------------------------------------------------------ Qt's own

    def rowCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008
        return 0 if parent.isValid() else len(self.notices)

    def columnCount(self, parent: Index = QModelIndex()) -> int:  # noqa: B008
        return 0 if parent.isValid() else len(COLUMNS)

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        is_title = orientation == Qt.Orientation.Horizontal and role == Qt.ItemDataRole.DisplayRole
        return COLUMNS[section] if is_title else None

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> Any:
        notice = self.notices[index.row()]
        if role == Qt.ItemDataRole.DisplayRole:
            return (notice.clock, LEVELS[notice.level], notice.counted_text, notice.source)[index.column()]
        if role == Qt.ItemDataRole.ToolTipRole and index.column() == 2:
            return notice.text
        if role == Qt.ItemDataRole.ForegroundRole and index.column() < 2:
            return QColor(level_colour(self._theme, LEVELS[notice.level]))
        return None


def level_colour(theme: Theme, name: str) -> str:
    """Colour of a level's name on the theme's base; each of them can be read there."""
    shades = {
        "detail": theme.faint,
        "note": theme.faint,
        "warning": "#ffc857" if theme.is_dark else "#8a5a00",
        "error": "#ff8a80" if theme.is_dark else "#b3261e",
    }
    return shades[name]
