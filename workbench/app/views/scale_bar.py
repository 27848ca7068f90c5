"""A round length in the units of the mesh, in a corner of a view.

Views are drawn in parallel: lengths across the line of sight are right at every depth. What is slanted is shortened.
"""

from __future__ import annotations

import math

from PySide6.QtCore import QPointF, QRectF, Qt
from PySide6.QtGui import QColor, QPainter, QPen

from workbench.app.appearance.theme import Theme
from workbench.core.round_length import round_length

LONGEST = 130.0
"""Pixels of the bar at most, and a third of the view."""
MARGIN = 12.0


def paint_scale_bar(painter: QPainter, pixels_per_unit: float, area: QRectF, theme: Theme) -> None:
    """Draw the bar into the lower right corner of `area`; nothing where there is no room or no length."""
    longest = min(LONGEST, 0.33 * area.width())
    if not (math.isfinite(pixels_per_unit) and pixels_per_unit > 0) or longest < 20:
        return
    length = round_length(longest / pixels_per_unit)
    right, low = area.right() - MARGIN, area.bottom() - MARGIN
    left = right - length * pixels_per_unit
    painter.setRenderHint(QPainter.RenderHint.Antialiasing)
    for colour, width in ((theme.view, 5.0), (theme.text, 2.0)):  # a rim keeps it apart from what is below
        painter.setPen(QPen(QColor(colour), width, Qt.PenStyle.SolidLine, Qt.PenCapStyle.FlatCap))
        painter.drawPolyline([QPointF(left, low - 5), QPointF(left, low), QPointF(right, low), QPointF(right, low - 5)])
    words = f"{length:.6g}"
    box = QRectF(painter.fontMetrics().boundingRect(words)).adjusted(-3, -1, 3, 1)
    box.moveCenter(QPointF(0.5 * (left + right), low - 8 - 0.5 * box.height()))
    box.moveRight(min(box.right(), area.right() - 2))
    paper = QColor(theme.view)
    paper.setAlpha(200)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(paper)
    painter.drawRoundedRect(box, 3, 3)
    painter.setPen(QColor(theme.text))
    painter.drawText(box, Qt.AlignmentFlag.AlignCenter, words)
