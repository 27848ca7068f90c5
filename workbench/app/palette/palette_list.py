"""The list of the palette: titles with the letters that were typed, menus that lead to them, keys."""

from __future__ import annotations

from PySide6.QtCore import QAbstractListModel, QModelIndex, QObject, QPersistentModelIndex, QRect, QSize, Qt
from PySide6.QtGui import QColor, QFont, QFontMetrics, QPainter, QPalette
from PySide6.QtWidgets import QListView, QStyle, QStyledItemDelegate, QStyleOptionViewItem, QWidget

from workbench.app.palette.entry import Found

FOUND = int(Qt.ItemDataRole.UserRole)
MARGIN = 10
Index = QModelIndex | QPersistentModelIndex


class FoundModel(QAbstractListModel):
    """What was found, the best first."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.found: list[Found] = []

    def show(self, found: list[Found]) -> None:
        self.beginResetModel()
        self.found = found
        self.endResetModel()

    def rowCount(self, parent: Index | None = None) -> int:
        return len(self.found)

    def data(self, index: Index, role: int = Qt.ItemDataRole.DisplayRole) -> object:
        if not 0 <= index.row() < len(self.found):
            return None
        entry = self.found[index.row()].entry
        if role == FOUND:
            return self.found[index.row()]
        if role == Qt.ItemDataRole.DisplayRole:
            return entry.title
        if role == Qt.ItemDataRole.ToolTipRole:
            return entry.tip or None
        return None


class FoundDelegate(QStyledItemDelegate):
    """Draws a row: the title with what fits in bold, where it stands in grey, its keys at the right."""

    def sizeHint(self, option: QStyleOptionViewItem, index: Index) -> QSize:
        return QSize(100, round(1.75 * option.fontMetrics.height()))

    def paint(self, painter: QPainter, option: QStyleOptionViewItem, index: Index) -> None:
        found = index.data(FOUND)
        if found is None:
            return
        entry, palette = found.entry, option.palette
        is_chosen = bool(option.state & QStyle.StateFlag.State_Selected)
        group = QPalette.ColorGroup.Active if entry.is_enabled else QPalette.ColorGroup.Disabled
        ink = palette.color(
            group, QPalette.ColorRole.HighlightedText if is_chosen and entry.is_enabled else QPalette.ColorRole.Text
        )
        faint = QColor(ink) if is_chosen and entry.is_enabled else palette.color(QPalette.ColorRole.PlaceholderText)
        if is_chosen:
            ground = palette.color(QPalette.ColorRole.Highlight)
            if not entry.is_enabled:  # it can be looked at, not run
                ground.setAlpha(60)
            painter.fillRect(option.rect, ground)
        painter.save()
        painter.setFont(option.font)
        row = option.rect.adjusted(MARGIN, 0, -MARGIN, 0)
        metrics = QFontMetrics(option.font)
        right = row.right()
        if entry.keys:
            width = metrics.horizontalAdvance(entry.keys)
            painter.setPen(ink)
            painter.drawText(
                QRect(right - width, row.top(), width + 1, row.height()), Qt.AlignmentFlag.AlignVCenter, entry.keys
            )
            right -= width + 2 * MARGIN
        mark = "✓ " if entry.is_checked else ""
        left = self._draw_title(
            painter, mark, found, option.font, QRect(row.left(), row.top(), right - row.left(), row.height()), ink
        )
        words = entry.place if entry.is_enabled else f"{entry.reason or 'not possible now'}  ·  {entry.place}"
        room = right - left - MARGIN
        if room > 30:
            painter.setPen(faint)
            text = metrics.elidedText(words, Qt.TextElideMode.ElideRight, room)
            painter.drawText(QRect(left + MARGIN, row.top(), room, row.height()), Qt.AlignmentFlag.AlignVCenter, text)
        painter.restore()

    def _draw_title(self, painter: QPainter, mark: str, found: Found, font: QFont, room: QRect, ink: QColor) -> int:
        """Draw the title from the left of `room`; returns where it ends."""
        bold = QFont(font)
        bold.setBold(True)
        painter.setPen(ink)
        left, places = room.left(), set(found.places)
        for run, is_bold in _runs(mark, found.entry.title, places):
            used = bold if is_bold else font
            metrics = QFontMetrics(used)
            text = metrics.elidedText(run, Qt.TextElideMode.ElideRight, room.right() - left)
            painter.setFont(used)
            width = metrics.horizontalAdvance(text)
            painter.drawText(QRect(left, room.top(), width + 1, room.height()), Qt.AlignmentFlag.AlignVCenter, text)
            left += width
            if text != run:
                break
        painter.setFont(font)
        return left


def _runs(mark: str, title: str, places: set[int]) -> list[tuple[str, bool]]:
    """Pieces of a title that are alike."""
    runs: list[tuple[str, bool]] = [(mark, False)] if mark else []
    begin = 0
    for at in range(1, len(title) + 1):
        if at == len(title) or (at in places) != (begin in places):
            runs.append((title[begin:at], begin in places))
            begin = at
    return runs


class PaletteList(QListView):
    """Never has the focus: keys come from the line above it."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.found = FoundModel(self)
        self.setModel(self.found)
        self.setItemDelegate(FoundDelegate(self))
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setFrameShape(QListView.Shape.NoFrame)
        self.setUniformItemSizes(True)
        self.setMouseTracking(True)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setVerticalScrollMode(QListView.ScrollMode.ScrollPerItem)

    def choose_row(self, row: int) -> None:
        """Mark a row, and bring it into sight."""
        count = len(self.found.found)
        if count:
            self.setCurrentIndex(self.found.index(max(0, min(row, count - 1))))

    @property
    def rows_in_sight(self) -> int:
        return max(1, self.viewport().height() // max(1, self.sizeHintForRow(0)))
