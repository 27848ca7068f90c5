"""A little picture of a few triangles, coloured by distortion, of which one place can be dragged."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QPointF, Qt, Signal
from PySide6.QtGui import QColor, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QSizePolicy, QWidget

from workbench.app.appearance.theme import ANCHOR, ANCHOR_RIM, INVERTED, LIGHT, Theme
from workbench.app.views.colours import distortion_colours
from workbench.core.arrays import Booleans, Floats, Integers

MARGIN = 16.0
RADIUS = 7.0


@dataclass(frozen=True, eq=False)
class Scene:
    """What is drawn, in units of its own.

    `points` (v, 2), `triangles` (m, 3), `shares` (m,) places on the colour scale, `inverted` (m,); `frame` (2, 2) is the
    least and the greatest corner of what shall be in sight; `grip` (2,) can be dragged along the line `track` (2, 2);
    `ghosts` are outlines (k, 3, 2) drawn faintly.
    """

    points: Floats
    triangles: Integers
    shares: Floats
    inverted: Booleans
    frame: Floats
    grip: Floats | None = None
    track: Floats | None = None
    ghosts: Floats | None = None


class SimplexPicture(QWidget):
    """Paints a `Scene`; `dragged` carries the abscissa, in the scene's units, that the hand wants."""

    dragged = Signal(float)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.theme: Theme = LIGHT
        self.scene: Scene | None = None
        self._is_held = False
        self.setMinimumSize(160, 120)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.setMouseTracking(True)

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self.update()

    def show_scene(self, scene: Scene | None) -> None:
        self.scene = scene
        self.update()

    # ------------------------------------------------------------------------------------------ places

    def _frame(self) -> tuple[float, Floats]:
        """Pixels in a unit, and the pixel of the origin."""
        assert self.scene is not None
        low, high = self.scene.frame
        extent = np.maximum(high - low, 1e-9)
        room = np.array([self.width() - 2 * MARGIN, self.height() - 2 * MARGIN])
        scale = float(max((room / extent).min(), 1e-9))
        middle = 0.5 * (low + high) * np.array([1.0, -1.0])
        return scale, np.array([self.width(), self.height()]) / 2 - scale * middle

    def to_pixels(self, points: Floats) -> Floats:
        """(..., 2) in the scene's units -> pixels, y downwards."""
        scale, origin = self._frame()
        return np.asarray(points * np.array([scale, -scale]) + origin)

    # ------------------------------------------------------------------------------------------ mouse

    def mousePressEvent(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton and self.scene is not None and self.scene.grip is not None:
            self._is_held = True
            self._drag(event.position())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        if self._is_held:
            self._drag(event.position())
        else:
            self.setCursor(Qt.CursorShape.OpenHandCursor if self._is_near(event.position()) else Qt.CursorShape.ArrowCursor)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self._is_held = False

    def _is_near(self, where: QPointF) -> bool:
        if self.scene is None or self.scene.grip is None:
            return False
        x, y = self.to_pixels(self.scene.grip)
        return (where - QPointF(x, y)).manhattanLength() < 2.5 * RADIUS

    def _drag(self, where: QPointF) -> None:
        scale, origin = self._frame()
        self.dragged.emit(float((where.x() - origin[0]) / scale))

    # ------------------------------------------------------------------------------------------ painting

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.fillRect(self.rect(), QColor(self.theme.view))
        if self.scene is not None:
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            self._paint(painter, self.scene)
        painter.end()

    def _paint(self, painter: QPainter, scene: Scene) -> None:
        faint, edge = QColor(self.theme.faint), QColor(self.theme.text)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(faint, 1, Qt.PenStyle.DashLine))
        for ghost in [] if scene.ghosts is None else scene.ghosts:
            painter.drawPolygon(_polygon(self.to_pixels(ghost)))
        pixels = self.to_pixels(scene.points)
        table = distortion_colours()
        # what is turned over is drawn last: it lies on the others
        for row in np.argsort(scene.inverted, kind="stable").tolist():
            rgb = INVERTED if scene.inverted[row] else table[_entry(scene.shares[row], len(table))]
            colour = QColor.fromRgbF(*(float(c) for c in rgb))
            colour.setAlpha(215)
            painter.setBrush(colour)
            painter.setPen(QPen(edge, 1.4))
            painter.drawPolygon(_polygon(pixels[scene.triangles[row]]))
        if scene.track is not None:
            begin, end = self.to_pixels(scene.track)
            painter.setPen(QPen(faint, 1.2, Qt.PenStyle.DotLine))
            painter.drawLine(QPointF(*begin), QPointF(*end))
        if scene.grip is not None:
            painter.setPen(QPen(ANCHOR_RIM, 1.8))
            painter.setBrush(ANCHOR)
            painter.drawEllipse(QPointF(*self.to_pixels(scene.grip)), RADIUS, RADIUS)


def _entry(share: float, count: int) -> int:
    return int((share if np.isfinite(share) else 1.0) * (count - 1))


def _polygon(pixels: Floats) -> QPolygonF:
    return QPolygonF([QPointF(*pixel) for pixel in pixels])


def framed(points: Floats) -> Floats:
    """Least and greatest corner (2, 2) of points (..., 2)."""
    flat = points.reshape(-1, 2)
    return np.stack([flat.min(axis=0), flat.max(axis=0)])
