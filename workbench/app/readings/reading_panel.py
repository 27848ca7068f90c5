"""A small panel beside the pointer with the numbers of what is under it."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QPointF, QRect, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QFont, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QWidget

from workbench.app.appearance.theme import LIGHT, Theme
from workbench.app.readings.reading_text import ReadingText

OFFSET = 18
"""Pixels between pointer and panel."""
EDGE = 8
GAP = 16
COLUMNS = 2


class ReadingPanel(QWidget):
    """Lies over everything in its window, and lets the mouse through."""

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        font = QFont(self.font())
        font.setPointSizeF(max(font.pointSizeF() - 1.0, 7.0))
        self.setFont(font)
        self.theme: Theme = LIGHT
        self._room = parent
        self.text = ReadingText((), ())
        self.hide()

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self.update()

    def show_text(self, text: ReadingText, at: QPoint) -> None:
        """Show a reading beside a point of the window."""
        if text != self.text:
            self.text = text
            self.update()
        size = self.sizeHint()
        self.setGeometry(QRect(_place(at, size, self._room.size()), size))
        if self.isHidden():
            self.show()
            self.raise_()

    # ------------------------------------------------------------------------------------------ painting

    @property
    def _line(self) -> int:
        return self.fontMetrics().height() + 1

    def _columns(self) -> list[tuple[tuple[str, str], ...]]:
        """The rows in columns of about equal length."""
        rows = self.text.rows
        length = -(-len(rows) // COLUMNS)
        return [rows[i : i + length] for i in range(0, len(rows), length)] if rows else []

    def _widths(self) -> list[tuple[int, int]]:
        """Width of names and of numbers in each column."""
        width = self.fontMetrics().horizontalAdvance
        return [
            (max(width(a) for a, _ in rows), max(max(width(b) for _, b in rows), width("−0.000000")))
            for rows in self._columns()
        ]

    def sizeHint(self) -> QSize:
        width = self.fontMetrics().horizontalAdvance
        columns, widths = self._columns(), self._widths()
        across = sum(a + b + GAP // 2 for a, b in widths) + GAP * max(len(widths) - 1, 0)
        lines = len(self.text.heading) + max((len(rows) for rows in columns), default=0)
        heading = max((width(line) for line in self.text.heading), default=0)
        return QSize(max(across, heading) + 2 * EDGE + 2, lines * self._line + 2 * EDGE)

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        paper = QColor(self.theme.base)
        paper.setAlpha(250)
        painter.setPen(QPen(QColor(self.theme.border), 1))
        painter.setBrush(paper)
        painter.drawRoundedRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5), 4, 4)
        ascent, line = self.fontMetrics().ascent(), self._line
        y = EDGE
        text, faint = QColor(self.theme.text), QColor(self.theme.faint)
        for row, words in enumerate(self.text.heading):
            painter.setPen(text if row == 0 else faint)
            painter.drawText(QPointF(EDGE, y + ascent), words)
            y += line
        x = float(EDGE)
        bold = QFont(self.font())
        bold.setBold(True)
        for rows, (names, numbers) in zip(self._columns(), self._widths(), strict=True):
            for row, (name, number) in enumerate(rows):
                painter.setFont(bold if name == self.text.main else self.font())
                painter.setPen(text if name == self.text.main else faint)
                painter.drawText(QPointF(x, y + row * line + ascent), name)
                painter.setPen(text)
                box = QRectF(x + names, y + row * line, numbers + GAP // 2, line)
                painter.drawText(box, Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter, number)
            x += names + numbers + GAP // 2 + GAP
        painter.end()


def _place(at: QPoint, size: QSize, room: QSize) -> QPoint:
    """Where the panel goes: right of the pointer and below it, on the other side where there is no room."""
    x = at.x() + OFFSET if at.x() + OFFSET + size.width() <= room.width() else at.x() - OFFSET - size.width()
    y = at.y() + OFFSET if at.y() + OFFSET + size.height() <= room.height() else at.y() - OFFSET - size.height()
    return QPoint(max(x, 0), max(min(y, room.height() - size.height()), 0))
