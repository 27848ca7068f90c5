"""Drawing of a gizmo: arrows and rings, red, green and blue for x, y and z."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QPointF, Qt
from PySide6.QtGui import QColor, QPainter, QPen, QPolygonF

from workbench.app.appearance.theme import Theme
from workbench.app.handling.gizmo import Gizmo, Handle
from workbench.app.views.camera import Size, ViewCamera
from workbench.core.arrays import Floats

COLOURS = {False: ("#d02c2c", "#23892f", "#2b5fd9"), True: ("#ff6b6b", "#5fd068", "#7aa5ff")}
HOT = QColor("#ffb000")
HEAD, HALF_HEAD = 12.0, 4.5
FAINT = 70


def paint_gizmo(
    painter: QPainter, gizmo: Gizmo, hot: tuple[str, int] | None, camera: ViewCamera, size: Size, theme: Theme
) -> None:
    """Far halves of rings are faint; `hot` is the handle under the pointer or in the hand."""
    handles = gizmo.handles(camera, size)
    for in_front in (False, True):
        for handle in handles:
            colour = HOT if (handle.kind, handle.axis) == hot else QColor(COLOURS[theme.is_dark][handle.axis])
            _paint_handle(painter, handle, colour, in_front, theme)


def _paint_handle(painter: QPainter, handle: Handle, colour: QColor, in_front: bool, theme: Theme) -> None:
    is_front = handle.is_front[:-1] & handle.is_front[1:] if handle.kind == "ring" else handle.is_front[1:]
    runs = _runs(handle.pixels, is_front == in_front)
    if not in_front:
        colour = QColor(colour)
        colour.setAlpha(FAINT if handle.kind == "ring" else 170)
    casing = QColor(theme.view)
    casing.setAlpha(colour.alpha())
    for pen in (QPen(casing, 5.0), QPen(colour, 2.4)):
        pen.setCapStyle(Qt.PenCapStyle.FlatCap)
        painter.setPen(pen)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for run in runs:
            painter.drawPolyline(run)
    if handle.kind == "arrow" and runs:
        _paint_head(painter, handle.pixels, colour)


def _paint_head(painter: QPainter, pixels: Floats, colour: QColor) -> None:
    step = pixels[1] - pixels[0]
    along = step / max(float(np.hypot(*step)), 1e-9)
    across = np.array([-along[1], along[0]])
    tip = pixels[1] + along * 4.0
    base = tip - HEAD * along
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(colour)
    painter.drawPolygon(QPolygonF([QPointF(*p) for p in (tip, base + HALF_HEAD * across, base - HALF_HEAD * across)]))


def _runs(pixels: Floats, wanted: Floats) -> list[QPolygonF]:
    """Pieces of a line (p, 2) whose segments (p - 1,) are `wanted`."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], wanted, [False]]).astype(np.int8)))
    return [QPolygonF([QPointF(*p) for p in pixels[a : b + 1]]) for a, b in edges.reshape(-1, 2)]
