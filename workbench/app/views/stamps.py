"""Discs painted once and stamped many times: hundreds of anchors cost a few milliseconds, not tens."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QImage, QPainter, QPen

from workbench.core.arrays import Booleans, Floats

MANY = 1500
"""Discs from which on all of them are drawn at once, without smooth rims."""


def stamp_discs(painter: QPainter, centres: Floats, colour: QColor, rim: QPen, radius: float) -> None:
    """Discs with a rim about centres (k, 2) in pixels, each at the nearest pixel of the screen."""
    ratio = painter.device().devicePixelRatioF()
    if len(centres) > MANY:
        _stamp_many(painter, centres, colour, rim, radius)
        return
    image = _stamp(colour.rgba(), rim.color().rgba(), rim.widthF(), radius, ratio)
    reach = 0.5 * image.width() / ratio
    for x, y in (((centres - reach) * ratio).round() / ratio).tolist():
        painter.drawImage(QPointF(x, y), image)


def _stamp_many(painter: QPainter, centres: Floats, colour: QColor, rim: QPen, radius: float) -> None:
    """The same by a picture of the whole device, whose cost does not grow with the number of discs."""
    device = painter.device()
    ratio = device.devicePixelRatioF()
    height, width = round(device.height() * ratio), round(device.width() * ratio)
    pixels = np.rint(centres * ratio).astype(np.int64)
    seen = ((pixels >= 0) & (pixels < (width, height))).all(axis=1)
    marks = np.zeros((height, width), dtype=bool)
    marks[pixels[seen, 1], pixels[seen, 0]] = True
    outer = _grown(marks, (radius + 0.5 * rim.widthF()) * ratio)
    inner = _grown(marks, (radius - 0.5 * rim.widthF()) * ratio)
    found = np.zeros((height, width), dtype=np.uint32)
    found[outer] = rim.color().rgba()
    found[inner] = colour.rgba() if colour.alpha() else 0
    image = QImage(found.data, width, height, 4 * width, QImage.Format.Format_ARGB32_Premultiplied)
    image.setDevicePixelRatio(ratio)
    painter.drawImage(QPointF(0.0, 0.0), image)


def _grown(marks: Booleans, radius: float) -> Booleans:
    """Every pixel whose middle is within a radius of the upper left corner of a marked one, row by row of the disc."""
    found = np.zeros_like(marks)
    for down in range(-int(radius + 0.5), int(radius + 0.5)):
        half = math.sqrt(max(radius**2 - (down + 0.5) ** 2, 0.0))
        wide = np.zeros_like(marks)
        for aside in range(-int(half + 0.5), int(half + 0.5)):
            wide[:, max(aside, 0) : marks.shape[1] + min(aside, 0)] |= marks[:, max(-aside, 0) : marks.shape[1] - max(aside, 0)]
        found[max(down, 0) : len(marks) + min(down, 0)] |= wide[max(-down, 0) : len(marks) - max(down, 0)]
    return found


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
