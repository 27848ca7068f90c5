"""A colour bar as a small widget: sharp text, no cost in the 3D view."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QContextMenuEvent, QImage, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QMenu, QSizePolicy, QWidget

from workbench.app.appearance.theme import INVERTED, LIGHT, Theme
from workbench.app.colouring.colour_range import ColourRange
from workbench.app.colouring.range_menu import ask_ends, fill_range_menu
from workbench.app.docks.axis_numbers import decade_marks
from workbench.figures.colour_scale import CLIPPED_ABOVE, CLIPPED_BELOW

BAR_HEIGHT = 11
END = 7
"""Width of the fields at the ends that show the colours beyond them."""
TIP = (
    "Shared by all views that show this quantity. Yellow: inverted.\n"
    "Double click: edit the ends. Right click: hold or fit the range, scale, colours."
)


class ColourBar(QWidget):
    """Horizontal bar of a `ColourRange` with numbers below, and the swatch for inverted simplices.

    `is_own` tells whether its view has the range for itself; None where it cannot. `own_wanted` asks for it.
    """

    own_wanted = Signal(bool)

    def __init__(self, colour_range: ColourRange, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.range = colour_range
        self.theme: Theme = LIGHT
        self.is_own: bool | None = None
        self._pixels = np.empty((1, 1, 3), np.uint8)
        self._image = QImage()
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setToolTip(TIP)
        self.show_range(colour_range)

    def sizeHint(self) -> QSize:
        return QSize(200, BAR_HEIGHT + self.fontMetrics().height() + 9)

    def minimumSizeHint(self) -> QSize:
        return QSize(120, self.sizeHint().height())

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self.update()

    def show_range(self, colour_range: ColourRange) -> None:
        """Show this range, or what has become of the one that is shown."""
        self.range = colour_range
        self._pixels = np.ascontiguousarray((colour_range.colours()[None] * 255).round().astype(np.uint8))
        count = self._pixels.shape[1]
        self._image = QImage(self._pixels.data, count, 1, 3 * count, QImage.Format.Format_RGB888)
        self.update()

    # ------------------------------------------------------------------------------------------ events

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        ask_ends(self.range, self)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        menu = QMenu(self)
        menu.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        fill_range_menu(menu, self.range, self)
        if self.is_own is not None:
            menu.addSeparator()
            own = menu.addAction("A range of this view's own")
            own.setCheckable(True)
            own.setChecked(self.is_own)
            own.toggled.connect(self.own_wanted)
        menu.popup(event.globalPos())

    # ------------------------------------------------------------------------------------------ painting

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(self.theme.view))
        metrics = painter.fontMetrics()
        swatch = metrics.horizontalAdvance("inverted") + 4
        left, right = 10.0, self.width() - 14.0 - swatch
        bar = QRectF(left, 2, max(right - left, 10.0), BAR_HEIGHT)
        painter.drawImage(bar, self._image)
        if self.range.is_clipped:
            painter.fillRect(QRectF(bar.left(), bar.top(), END, BAR_HEIGHT), QColor.fromRgbF(*CLIPPED_BELOW))
            painter.fillRect(QRectF(bar.right() - END, bar.top(), END, BAR_HEIGHT), QColor.fromRgbF(*CLIPPED_ABOVE))
        border = QPen(QColor(self.theme.faint), 1)
        painter.setPen(border)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRect(bar)
        box = QRectF(self.width() - swatch - 4, 2, swatch, BAR_HEIGHT)
        painter.fillRect(box, QColor.fromRgbF(*INVERTED))
        painter.drawRect(box)
        baseline = 2 + BAR_HEIGHT + metrics.ascent() + 4
        painter.setPen(QColor(self.theme.text))
        painter.drawText(QPointF(box.left() + 2, baseline), "inverted")
        self._paint_marks(painter, bar, baseline, box.left() - 6.0)
        centre = self.range.centre
        if centre is not None and 0.0 < self.range.share_of(centre) < 1.0:
            self._paint_centre(painter, bar, bar.left() + self.range.share_of(centre) * bar.width())
        painter.end()

    def _paint_marks(self, painter: QPainter, bar: QRectF, baseline: float, end: float) -> None:
        """Numbers in the order of their importance: where the widget is narrow, marks in between give way."""
        metrics = painter.fontMetrics()
        taken: list[tuple[float, float]] = []
        for share, label in ticks(self.range):
            x = bar.left() + share * bar.width()
            width = metrics.horizontalAdvance(label)
            start = min(max(x - width / 2, 2.0), end - width)
            if any(start < other_end + 8 and other_start < start + width + 8 for other_start, other_end in taken):
                continue
            taken.append((start, start + width))
            painter.setPen(QPen(QColor(self.theme.faint), 1))
            painter.drawLine(QPointF(x, bar.bottom()), QPointF(x, bar.bottom() + 3))
            painter.setPen(QColor(self.theme.text))
            painter.drawText(QPointF(start, baseline), label)

    def _paint_centre(self, painter: QPainter, bar: QRectF, x: float) -> None:
        """A line across the bar and a notch below say where the two colours meet."""
        painter.setPen(QPen(QColor("#000000"), 1.6))
        painter.drawLine(QPointF(x, bar.top()), QPointF(x, bar.bottom()))
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(self.theme.text))
        low = bar.bottom() + 1
        painter.drawPolygon(QPolygonF([QPointF(x, low), QPointF(x - 3.5, low + 4), QPointF(x + 3.5, low + 4)]))


def ticks(colour_range: ColourRange) -> list[tuple[float, str]]:
    """Marks of a bar, the most important first: share of the bar and text.

    The ends say by ≥ and ≤ that what lies beyond is drawn alike; a centre has a mark of its own.
    """
    low, high = colour_range.low, colour_range.high
    opens_below = colour_range.quantity.least is None or colour_range.share_below > 0 or colour_range.centre is not None
    marks = [(1.0, f"≥ {high:.4g}"), (0.0, f"≤ {low:.4g}" if opens_below else f"{low:.4g}")]
    centre = colour_range.centre
    if centre is not None:
        share = colour_range.share_of(centre)
        if 0.0 < share < 1.0:
            marks.append((share, f"{centre:.4g}"))
    if colour_range.is_logarithmic and high > 8 * low:
        places = decade_marks(float(np.log10(low)), float(np.log10(high)), 5)
        return marks + [(colour_range.share_of(10.0**place), f"{10.0**place:.4g}") for place in places]
    return marks + [(share, f"{colour_range.value_at(share):.4g}") for share in (0.5, 0.25, 0.75)]
