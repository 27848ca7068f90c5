"""A colour bar as a small widget: sharp text, no cost in the 3D view."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPaintEvent, QPen
from PySide6.QtWidgets import QSizePolicy, QWidget

from workbench.app.quantities import ColourRange
from workbench.app.theme import INVERTED, LIGHT, Theme
from workbench.app.views.colours import distortion_colours

BAR_HEIGHT = 11


class ColourBar(QWidget):
    """Horizontal bar of a `ColourRange` with numbers below, and the swatch for inverted simplices."""

    def __init__(self, colour_range: ColourRange, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._range = colour_range
        self.theme: Theme = LIGHT
        colours = (distortion_colours() * 255).round().astype(np.uint8)
        self._pixels = np.ascontiguousarray(colours[None, :, :])
        self._image = QImage(self._pixels.data, len(colours), 1, 3 * len(colours), QImage.Format.Format_RGB888)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        colour_range.changed.connect(self.update)
        self.setToolTip("Shared by all views that show this quantity. Yellow: inverted.")

    def sizeHint(self) -> QSize:
        return QSize(200, BAR_HEIGHT + self.fontMetrics().height() + 9)

    def minimumSizeHint(self) -> QSize:
        return QSize(120, self.sizeHint().height())

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(self.theme.view))
        metrics = painter.fontMetrics()
        swatch = metrics.horizontalAdvance("inverted") + 4
        left, right = 10.0, self.width() - 14.0 - swatch
        bar = QRectF(left, 2, max(right - left, 10.0), BAR_HEIGHT)
        painter.drawImage(bar, self._image)
        border = QPen(QColor(self.theme.faint), 1)
        painter.setPen(border)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRect(bar)
        box = QRectF(self.width() - swatch - 4, 2, swatch, BAR_HEIGHT)
        painter.fillRect(box, QColor.fromRgbF(*INVERTED))
        painter.drawRect(box)
        baseline = 2 + BAR_HEIGHT + metrics.ascent() + 4
        text = QColor(self.theme.text)
        painter.setPen(text)
        painter.drawText(QPointF(box.left() + 2, baseline), "inverted")
        last_end = -1.0
        for share, label in ticks(self._range.low, self._range.high):
            x = left + share * bar.width()
            width = metrics.horizontalAdvance(label)
            start = min(max(x - width / 2, 2.0), box.left() - width - 6.0)
            if start <= last_end + 6:
                continue
            painter.setPen(border)
            painter.drawLine(QPointF(x, bar.bottom()), QPointF(x, bar.bottom() + 3))
            painter.setPen(text)
            painter.drawText(QPointF(start, baseline), label)
            last_end = start + width
        painter.end()


def ticks(low: float, high: float) -> list[tuple[float, str]]:
    """Five marks from `low` to `high`: share of the bar and text; the last one says that more is drawn alike."""
    marks = []
    for part in range(5):
        share = part / 4
        marks.append((share, f"{low + share * (high - low):.4g}"))
    marks[-1] = (1.0, "≥ " + marks[-1][1])
    # the end matters most: where the widget is narrow, marks in between give way
    return [marks[0], marks[2], marks[4]] if any(len(text) > 6 for _, text in marks[:-1]) else marks
