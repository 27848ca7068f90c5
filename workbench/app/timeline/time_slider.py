"""The slider of the time line: energy, inversions and notes over time, the moments A and B, and the moment that is shown."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QEvent, QPointF, QRectF, QSize, Qt, Signal
from PySide6.QtGui import QColor, QHelpEvent, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QToolTip, QWidget

from workbench.app.appearance.theme import INVERTED, LIGHT, Theme
from workbench.core.arrays import Floats
from workbench.session.moments import Moment, MomentRecord

MARGIN = 12
"""Pixels left and right of the axis."""
LANE = 13
"""Height of the lane of notes at the lower edge."""
REACH = 6.0
"""Pixels from a note within which the pointer means it."""
KEYS = {Qt.Key.Key_Left: -1, Qt.Key.Key_Right: 1}


class TimeSlider(QWidget):
    """Draws a record and says where the user wants to go; it changes nothing itself.

    `place_wanted` carries an index of the record, `live_wanted` the wish for the newest map, `play_wanted`, `mark_wanted`
    ("A" or "B") and `flip_wanted` are keys.
    """

    place_wanted = Signal(int)
    live_wanted = Signal()
    play_wanted = Signal()
    flip_wanted = Signal()
    mark_wanted = Signal(str)

    def __init__(self, record: MomentRecord, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._record = record
        self.theme: Theme = LIGHT
        self.index = -1
        self.is_live = True
        self.marked: dict[str, Moment] = {}
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMinimumSize(160, 44)
        self.setMouseTracking(True)
        self.setToolTip(
            "Drag to look back; the solver goes on meanwhile.\n"
            "Left and Right: one map, with Shift ten; Home, End: first and newest; Space plays; A, B mark, X flips"
        )

    def sizeHint(self) -> QSize:
        return QSize(400, 54)

    def show_place(self, index: int, is_live: bool) -> None:
        """Where the handle stands."""
        self.index, self.is_live = index, is_live
        self.update()

    # ------------------------------------------------------------------------------------------ places

    def _x(self, time: float) -> float:
        width = self.width() - 2 * MARGIN
        return MARGIN + width * (time / self._record.end if self._record.end > 0 else 1.0)

    def index_at(self, x: float) -> int:
        """The moment under a pixel; -1 where there is none."""
        if not len(self._record):
            return -1
        share = (x - MARGIN) / max(self.width() - 2 * MARGIN, 1)
        return self._record.at(min(max(share, 0.0), 1.0) * self._record.end)

    def note_at(self, x: float) -> str:
        """What is noted near a pixel, newest first; empty where nothing is."""
        near = [m for m in self._record if m.notes and abs(self._x(m.time) - x) <= REACH]
        return "\n".join("; ".join(m.notes) for m in near[::-1][:6])

    # ------------------------------------------------------------------------------------------ mouse and keys

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self._go_to(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if event.buttons() & Qt.MouseButton.LeftButton:
            self._go_to(event)

    def _go_to(self, event: QMouseEvent) -> None:
        if event.buttons() & Qt.MouseButton.LeftButton:
            self._want(self.index_at(event.position().x()))

    def _want(self, index: int) -> None:
        if index >= len(self._record) - 1:
            self.live_wanted.emit()
        elif index >= 0:
            self.place_wanted.emit(index)

    def event(self, event: QEvent) -> bool:
        # keys that the window has for other things are this widget's while it is focused
        if event.type() == QEvent.Type.ShortcutOverride and isinstance(event, QKeyEvent) and self._deed_of(event) is not None:
            event.accept()
            return True
        if event.type() == QEvent.Type.ToolTip and isinstance(event, QHelpEvent):
            note = self.note_at(event.pos().x())
            if note:
                QToolTip.showText(event.globalPos(), note, self)
                return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:
        deed = self._deed_of(event)
        if deed is None:
            event.ignore()
        else:
            deed()

    def _deed_of(self, event: QKeyEvent):  # type: ignore[no-untyped-def]
        key, modifiers = Qt.Key(event.key()), event.modifiers() & ~Qt.KeyboardModifier.KeypadModifier
        if key in KEYS and modifiers in (Qt.KeyboardModifier.NoModifier, Qt.KeyboardModifier.ShiftModifier):
            count = KEYS[key] * (10 if modifiers else 1)
            # the newest map may have come since the mark was last moved to it
            here = len(self._record) - 1 if self.is_live else self.index
            return lambda: self._want(max(here + count, 0))
        if modifiers:
            return None
        return {
            Qt.Key.Key_Home: lambda: self._want(0),
            Qt.Key.Key_End: self.live_wanted.emit,
            Qt.Key.Key_L: self.live_wanted.emit,
            Qt.Key.Key_Space: self.play_wanted.emit,
            Qt.Key.Key_X: self.flip_wanted.emit,
            Qt.Key.Key_A: lambda: self.mark_wanted.emit("A"),
            Qt.Key.Key_B: lambda: self.mark_wanted.emit("B"),
        }.get(key)

    # ------------------------------------------------------------------------------------------ painting

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        theme, record = self.theme, self._record
        area = QRectF(MARGIN, 12, self.width() - 2 * MARGIN, self.height() - 12 - LANE)
        painter.fillRect(area, QColor(theme.base))
        if len(record) > 1:
            self._paint_curves(painter, area)
            self._paint_notes(painter, area)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QColor(theme.border))
        painter.drawRect(area)
        for name, moment in self.marked.items():
            self._paint_flag(painter, area, name, moment)
        if 0 <= self.index < len(record):
            x = self._x(record[self.index].time)
            colour = QColor(theme.faint if self.is_live else theme.accent)
            painter.setPen(QPen(colour, 2.0))
            painter.drawLine(QPointF(x, area.top() - 3), QPointF(x, area.bottom() + 3))
            painter.setBrush(colour)
            painter.setPen(QPen(QColor(theme.window), 1.0))
            painter.drawEllipse(QPointF(x, area.bottom()), 5.0, 5.0)
        if self.hasFocus():
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(QPen(QColor(theme.accent), 1.0, Qt.PenStyle.DotLine))
            painter.drawRect(QRectF(self.rect()).adjusted(1.5, 1.5, -1.5, -1.5))
        painter.end()

    def _paint_curves(self, painter: QPainter, area: QRectF) -> None:
        """Energy as a curve, each start from its own height; where triangles are inverted the ground is yellow."""
        times, energies, inverted = curves(self._record, int(area.width()))
        xs = area.left() + area.width() * times / max(self._record.end, 1e-300)
        yellow = QColor.fromRgbF(*INVERTED)
        for x, following in zip(xs[:-1][inverted[:-1]], xs[1:][inverted[:-1]], strict=True):
            painter.fillRect(QRectF(x, area.bottom() - 4, max(following - x, 1.0), 4), yellow)
        good = np.isfinite(energies)
        if good.sum() < 2:
            return
        low, high = energies[good].min(), energies[good].max()
        ys = area.bottom() - 3 - (area.height() - 6) * (energies[good] - low) / max(high - low, 1e-12)
        painter.setPen(QPen(QColor(self.theme.curves[0]), 1.2))
        painter.drawPolyline(QPolygonF([QPointF(x, y) for x, y in zip(xs[good].tolist(), ys.tolist(), strict=True)]))

    def _paint_notes(self, painter: QPainter, area: QRectF) -> None:
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(self.theme.curves[1]))
        for moment in self._record:
            if moment.notes:
                x, y = self._x(moment.time), area.bottom() + 4
                painter.drawPolygon(QPolygonF([QPointF(x, y), QPointF(x - 4, y + 7), QPointF(x + 4, y + 7)]))

    def _paint_flag(self, painter: QPainter, area: QRectF, name: str, moment: Moment) -> None:
        x = self._x(moment.time)
        painter.setPen(QPen(QColor(self.theme.text), 1.2, Qt.PenStyle.DashLine))
        painter.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()))
        painter.setPen(QColor(self.theme.text))
        font = painter.font()
        font.setBold(True)
        font.setPixelSize(11)
        painter.setFont(font)
        painter.drawText(QRectF(x - 8, 0, 16, 12), Qt.AlignmentFlag.AlignCenter, name)


def curves(record: MomentRecord, most: int) -> tuple[Floats, Floats, Floats]:
    """Times, logarithms of energies and whether something is inverted, (k,) each, of at most about `most` moments."""
    step = max(1, len(record) // max(most, 1))
    chosen = [*record[::step], record[-1]]
    with np.errstate(all="ignore"):
        energies = np.array([moment.energy for moment in chosen], dtype=float)
        scaled = np.log(energies) if (energies > 0).all() else energies
    return np.array([moment.time for moment in chosen]), scaled, np.array([m.inverted_count > 0 for m in chosen])
