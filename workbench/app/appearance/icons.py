"""Icons drawn by the program itself, in the colours of the theme."""

from __future__ import annotations

from collections.abc import Callable

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QIcon, QPainter, QPainterPath, QPen, QPixmap, QPolygonF

from workbench.app.appearance.theme import Theme

SIZE = 64


def _triangle(painter: QPainter, left: float, right: float) -> None:
    painter.drawPolygon(QPolygonF([QPointF(left, 12), QPointF(right, 32), QPointF(left, 52)]))


def _run(painter: QPainter) -> None:
    _triangle(painter, 16, 52)


def _pause(painter: QPainter) -> None:
    painter.drawRect(QRectF(15, 12, 12, 40))
    painter.drawRect(QRectF(37, 12, 12, 40))


def _step(painter: QPainter) -> None:
    _triangle(painter, 12, 40)
    painter.drawRect(QRectF(43, 12, 9, 40))


def _stop(painter: QPainter) -> None:
    painter.drawRect(QRectF(14, 14, 36, 36))


def _reset(painter: QPainter) -> None:
    pen = QPen(painter.brush().color(), 7)
    painter.setPen(pen)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawArc(QRectF(13, 13, 38, 38), 120 * 16, 285 * 16)
    painter.setBrush(pen.color())
    painter.setPen(Qt.PenStyle.NoPen)
    painter.drawPolygon(QPolygonF([QPointF(8, 24), QPointF(28, 26), QPointF(19, 7)]))


def _open(painter: QPainter) -> None:
    path = QPainterPath(QPointF(8, 16))
    for x, y in ((26, 16), (31, 22), (54, 22), (54, 52), (8, 52)):
        path.lineTo(x, y)
    path.closeSubpath()
    painter.drawPath(path)


def _save(painter: QPainter) -> None:
    painter.drawRect(QRectF(28, 8, 8, 24))
    painter.drawPolygon(QPolygonF([QPointF(17, 28), QPointF(47, 28), QPointF(32, 44)]))
    painter.drawRect(QRectF(10, 48, 44, 7))


def _fit(painter: QPainter) -> None:
    pen = QPen(painter.brush().color(), 6)
    painter.setPen(pen)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for x, y, dx, dy in ((12, 12, 1, 1), (52, 12, -1, 1), (12, 52, 1, -1), (52, 52, -1, -1)):
        painter.drawPolyline(QPolygonF([QPointF(x + 13 * dx, y), QPointF(x, y), QPointF(x, y + 13 * dy)]))
    painter.setBrush(pen.color())
    painter.setPen(Qt.PenStyle.NoPen)
    painter.drawEllipse(QPointF(32, 32), 8, 8)


def _pin(painter: QPainter) -> None:
    pen = QPen(painter.brush().color(), 5)
    painter.setPen(pen)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawEllipse(QPointF(32, 32), 19, 19)
    painter.setBrush(pen.color())
    painter.setPen(Qt.PenStyle.NoPen)
    for x, y in ((32, 13), (32, 51), (13, 32), (51, 32)):
        painter.drawEllipse(QPointF(x, y), 7, 7)


def _clear(painter: QPainter) -> None:
    painter.setPen(QPen(painter.brush().color(), 8, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
    painter.drawLine(QPointF(16, 16), QPointF(48, 48))
    painter.drawLine(QPointF(48, 16), QPointF(16, 48))


def _inspect(painter: QPainter) -> None:
    pen = QPen(painter.brush().color(), 7)
    painter.setPen(pen)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawEllipse(QRectF(11, 11, 30, 30))
    painter.drawLine(QPointF(38, 38), QPointF(53, 53))


def _chain(painter: QPainter) -> None:
    painter.setPen(QPen(painter.brush().color(), 6))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.translate(32, 32)
    painter.rotate(-40)
    for left in (-27, -3):
        painter.drawRoundedRect(QRectF(left, -10, 30, 20), 10, 10)


def _split(painter: QPainter) -> None:
    painter.setPen(QPen(painter.brush().color(), 5))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawRect(QRectF(9, 12, 46, 40))
    painter.drawLine(QPointF(32, 12), QPointF(32, 52))
    painter.drawLine(QPointF(32, 32), QPointF(55, 32))


def _mirror(painter: QPainter) -> None:
    for tip, foot in ((10, 26), (54, 38)):
        painter.drawPolygon(QPolygonF([QPointF(tip, 50), QPointF(foot, 50), QPointF(foot, 14)]))
    painter.drawRect(QRectF(30.5, 8, 3, 48))


def _falloff(painter: QPainter) -> None:
    painter.drawEllipse(QPointF(32, 32), 8, 8)
    pen = QPen(painter.brush().color(), 4)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for radius, style in ((16, Qt.PenStyle.SolidLine), (25, Qt.PenStyle.DotLine)):
        pen.setStyle(style)
        painter.setPen(pen)
        painter.drawEllipse(QPointF(32, 32), radius, radius)


def _float(painter: QPainter) -> None:
    painter.setPen(QPen(painter.brush().color(), 6))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    painter.drawRect(QRectF(9, 23, 32, 32))
    painter.drawPolyline(QPolygonF([QPointF(23, 23), QPointF(23, 9), QPointF(55, 9), QPointF(55, 41), QPointF(41, 41)]))


def _close(painter: QPainter) -> None:
    painter.setPen(QPen(painter.brush().color(), 7, Qt.PenStyle.SolidLine, Qt.PenCapStyle.RoundCap))
    painter.drawLine(QPointF(13, 13), QPointF(51, 51))
    painter.drawLine(QPointF(51, 13), QPointF(13, 51))


DRAWINGS: dict[str, Callable[[QPainter], None]] = {
    "run": _run,
    "pause": _pause,
    "step": _step,
    "stop": _stop,
    "reset": _reset,
    "open": _open,
    "save": _save,
    "fit": _fit,
    "pin": _pin,
    "clear": _clear,
    "inspect": _inspect,
    "chain": _chain,
    "split": _split,
    "mirror": _mirror,
    "falloff": _falloff,
    "float": _float,
    "close": _close,
}


def icon(name: str, theme: Theme) -> QIcon:
    """Icon `name` for a theme, also in its faint colour for what cannot be used."""
    return drawn(name, QColor(theme.text), QColor(theme.border))


def drawn(name: str, colour: QColor, disabled: QColor) -> QIcon:
    """Icon `name` in a colour, and in another one for what cannot be used."""
    result = QIcon()
    for mode, paint in ((QIcon.Mode.Normal, colour), (QIcon.Mode.Disabled, disabled)):
        picture = QPixmap(SIZE, SIZE)
        picture.fill(Qt.GlobalColor.transparent)
        painter = QPainter(picture)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(paint)
        DRAWINGS[name](painter)
        painter.end()
        result.addPixmap(picture, mode)
    return result
