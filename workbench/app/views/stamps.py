"""Discs painted once and stamped many times: hundreds of anchors cost a few milliseconds, not tens."""

from __future__ import annotations

from functools import lru_cache

from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPen

from workbench.core.arrays import Floats


def stamp_discs(painter: QPainter, centres: Floats, colour: QColor, rim: QPen, radius: float) -> None:
    """Discs with a rim about centres (k, 2) in pixels, each at the nearest pixel of the screen."""
    ratio = painter.device().devicePixelRatioF()
    image = _stamp(colour.rgba(), rim.color().rgba(), rim.widthF(), radius, ratio)
    reach = 0.5 * image.width() / ratio
    for x, y in (((centres - reach) * ratio).round() / ratio).tolist():
        painter.drawImage(QPointF(x, y), image)


@lru_cache(maxsize=16)
def _stamp(colour: int, rim: int, width: float, radius: float, ratio: float) -> QImage:
    side = 2 * int(radius + width + 2)
    image = QImage(round(side * ratio), round(side * ratio), QImage.Format.Format_ARGB32_Premultiplied)
    image.setDevicePixelRatio(ratio)
    image.fill(Qt.GlobalColor.transparent)
    painter = QPainter(image)
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    painter.setPen(QPen(QColor.fromRgba(rim), width))
    painter.setBrush(QColor.fromRgba(colour))
    painter.drawEllipse(QPointF(0.5 * side, 0.5 * side), radius, radius)
    painter.end()
    return image
