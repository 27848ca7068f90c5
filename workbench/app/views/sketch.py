"""Lines that a tool draws above a view: a path, a circle of reach, a line of symmetry."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QPainter, QPen, QPolygonF

from workbench.app.appearance.theme import ANCHOR_SELECTED, Theme
from workbench.core.arrays import Floats

if TYPE_CHECKING:
    from workbench.app.views.mesh_view import MeshView


@dataclass(frozen=True, eq=False)
class Sketch:
    """Segments (k, 2, 3) in units of the display, and dots (p, 3) on them.

    `kind` : "path" what would be chosen, "shell" a whole surface that would be, "reach" how far something goes, "mirror" a
    line of symmetry
    """

    segments: Floats
    kind: str
    dots: Floats | None = None


def circle(centre: Floats, radius: float, across: Floats) -> Floats:
    """Segments (64, 2, 3) of a circle about `centre` (3,) in the plane of two directions `across` (2, 3) of length 1."""
    angles = np.linspace(0.0, 2.0 * np.pi, 65)
    points = centre + radius * (np.cos(angles)[:, None] * across[0] + np.sin(angles)[:, None] * across[1])
    return np.stack([points[:-1], points[1:]], axis=1)


def paint_sketch(painter: QPainter, sketch: Sketch, view: MeshView, theme: Theme) -> None:
    """Draw one, hidden or not."""
    accent = QColor(theme.accent)
    pens = {
        "path": (QPen(QColor(theme.view), 5.5), QPen(ANCHOR_SELECTED, 3.0)),
        "shell": (QPen(ANCHOR_SELECTED, 1.0),),
        "reach": (QPen(accent, 1.6),),
        "mirror": (QPen(accent, 1.6, Qt.PenStyle.DashDotLine),),
    }
    ends = view.project(sketch.segments.reshape(-1, 3)).reshape(-1, 4)
    painter.setBrush(Qt.BrushStyle.NoBrush)
    for pen in pens[sketch.kind]:
        pen.setCapStyle(Qt.PenCapStyle.RoundCap)
        painter.setPen(pen)
        for a, b, c, d in ends.tolist():
            painter.drawLine(QPointF(a, b), QPointF(c, d))
    if sketch.dots is not None:
        painter.setPen(Qt.PenStyle.NoPen)
        colour, radius = QColor(ANCHOR_SELECTED), 4.0
        if sketch.kind == "reach":  # anchors lie over these: a rim is seen of them
            colour.setAlpha(170)
            radius = 9.0
        painter.setBrush(colour)
        for x, y in view.project(sketch.dots).tolist():
            painter.drawEllipse(QPointF(x, y), radius, radius)


def paint_outline(painter: QPainter, outline: QPolygonF, theme: Theme) -> None:
    """A box or a lasso that is being drawn, in pixels; filled where it counts as inside."""
    colour = QColor(theme.accent)
    painter.setPen(QPen(colour, 1.4, Qt.PenStyle.DashLine))
    colour.setAlpha(40)
    painter.setBrush(colour)
    painter.drawPolygon(outline, Qt.FillRule.OddEvenFill)
