"""The plane that cuts a solid, drawn over a view: its outline, and a handle to move it by."""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QEvent, QObject, QPointF, Qt
from PySide6.QtGui import QColor, QMouseEvent, QPainter, QPaintEvent, QPen, QPolygonF
from PySide6.QtWidgets import QWidget

from workbench.app.views.mesh_view import MeshView
from workbench.app.volumes.volume_view import VolumeView
from workbench.core.arrays import Floats

REACH = 13.0
"""Pixels round the handle in which the pointer takes it."""
MARGIN = 18.0
"""Pixels from the edge of the view that it keeps."""
SHORTEST = 0.2
"""Part of its length that the way of the plane has at least on the screen: a plane seen face on is moved up and down."""
OVERHANG = 0.06
"""How far the outline reaches beyond the solid, as a part of its size."""


class PlaneHandle(QWidget):
    """A layer above a view; it paints, and takes the mouse from the view where the handle is."""

    def __init__(self, view: MeshView, volume: VolumeView, *, of_target: bool) -> None:
        super().__init__(view)
        self._view = view
        self._volume = volume
        self._of_target = of_target
        self._grip: tuple[QPointF, float] | None = None
        self._is_hovered = False
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setAttribute(Qt.WidgetAttribute.WA_NoSystemBackground)
        view.installEventFilter(self)
        view.overlay.installEventFilter(self)
        view.camera_changed.connect(self.update)
        view.drawn.connect(self._follow)
        volume.changed.connect(self.update)
        volume.opened.connect(self.update)

    # ------------------------------------------------------------------------------------------ where it is

    @property
    def is_there(self) -> bool:
        """Whether this view shows the plane."""
        look = self._volume.look
        is_mine = self._volume.is_on and look.is_cut and look.cuts_target == self._of_target
        return is_mine and self._view.geometry_shown is not None

    def _extent(self) -> tuple[Floats, Floats, Floats]:
        """Rows of an orthonormal frame (3, 3), the normal last; smallest and largest coordinates of the solid in it."""
        assert self._view.geometry_shown is not None
        normal = np.asarray(self._volume.look.normal)
        across = np.cross(normal, np.eye(3)[np.abs(normal).argmin()])
        across /= np.linalg.norm(across)
        frame = np.array([across, np.cross(normal, across), normal])
        turned = self._view.geometry_shown.vertices @ frame.T
        return frame, turned.min(axis=0), turned.max(axis=0)

    def _corners(self) -> Floats:
        """Corners (4, 3) of the outline, in units of the display."""
        frame, low, high = self._extent()
        height = low[2] + self._volume.look.place * (high[2] - low[2])
        margin = OVERHANG * float((high - low).max())
        (left, bottom), (right, top) = low[:2] - margin, high[:2] + margin
        flat = np.array([[left, bottom], [right, bottom], [right, top], [left, top]])
        return np.asarray(np.c_[flat, np.full(4, height)] @ frame)

    def _way(self) -> Floats:
        """Pixels (2,) that the handle goes while the plane goes through the whole solid."""
        frame, low, high = self._extent()
        length = float(high[2] - low[2])
        begin, end = self._view.project(np.array([np.zeros(3), length * frame[2]]))
        way = end - begin
        least = SHORTEST * length * self._view.camera.pixels_per_unit(self._view.size_in_pixels)
        return np.asarray(way if np.hypot(*way) >= least else np.array([0.0, -max(least, 1.0)]))

    def handle(self) -> QPointF:
        """Where the handle is, in pixels: in the middle of one side of the outline, but within the view."""
        corners = self._view.project(self._corners())
        middles = 0.5 * (corners + np.roll(corners, -1, axis=0))
        # the side that is farthest up lies clear of most of what is drawn
        place = middles[middles[:, 1].argmin()]
        return QPointF(*np.clip(place, MARGIN, np.array(self._view.size_in_pixels) - MARGIN))

    def _follow(self) -> None:
        if self._of_target and self.is_there:
            self.update()  # the map has moved, and its plane with it

    # ------------------------------------------------------------------------------------------ the hand

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.Resize and watched is self._view:
            self.setGeometry(self._view.rect())
            self.raise_()
        if watched is not self._view.overlay or not isinstance(event, QMouseEvent) or not self.is_there:
            return False
        kind = event.type()
        if kind == QEvent.Type.MouseButtonPress and event.button() == Qt.MouseButton.LeftButton:
            if not self._is_near(event.position()):
                return False
            self._grip = (event.position(), self._volume.look.place)
        elif kind == QEvent.Type.MouseMove and self._grip is not None:
            self._drag(event.position())
        elif kind == QEvent.Type.MouseButtonRelease and self._grip is not None:
            self._grip = None
        elif kind == QEvent.Type.MouseMove:
            self._hover(self._is_near(event.position()))
            return False
        else:
            return False
        return True

    def _is_near(self, where: QPointF) -> bool:
        offset = where - self.handle()
        return bool(np.hypot(offset.x(), offset.y()) <= REACH)

    def _hover(self, is_near: bool) -> None:
        if is_near != self._is_hovered:
            self._is_hovered = is_near
            self._view.overlay.setCursor(Qt.CursorShape.SizeAllCursor if is_near else Qt.CursorShape.ArrowCursor)
            self.update()

    def _drag(self, where: QPointF) -> None:
        assert self._grip is not None
        begin, place = self._grip
        way = self._way()
        moved = where - begin
        share = (moved.x() * way[0] + moved.y() * way[1]) / float(way @ way)
        self._volume.choose(place=float(np.clip(place + share, 0.0, 1.0)))

    # ------------------------------------------------------------------------------------------ painting

    def paintEvent(self, event: QPaintEvent) -> None:
        if not self.is_there:
            return
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        accent = QColor(self._view.theme.accent)
        line = QColor(accent)
        line.setAlpha(150)
        painter.setPen(QPen(line, 1.4, Qt.PenStyle.DashLine))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPolygon(QPolygonF([QPointF(*corner) for corner in self._view.project(self._corners())]))
        self._paint_handle(painter, accent)
        painter.end()

    def _paint_handle(self, painter: QPainter, accent: QColor) -> None:
        centre = self.handle()
        way = self._way()
        unit = QPointF(*(way / np.hypot(*way)))
        side = QPointF(-unit.y(), unit.x())
        is_held = self._is_hovered or self._grip is not None
        paper = QColor(self._view.theme.view)
        for pen, brush in ((QPen(paper, 3.0), accent), (QPen(Qt.PenStyle.NoPen), accent.lighter(125) if is_held else accent)):
            painter.setPen(pen)
            painter.setBrush(brush)
            painter.drawRoundedRect(int(centre.x()) - 4, int(centre.y()) - 4, 8, 8, 2.0, 2.0)
            for sign in (-1.0, 1.0):
                tip, base = centre + unit * (14.0 * sign), centre + unit * (7.0 * sign)
                painter.drawPolygon(QPolygonF([tip, base + side * 5.0, base - side * 5.0]))
