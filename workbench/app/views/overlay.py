"""The layer above a view: anchors, the vertex under the pointer, the simplex that limits the step."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QPointF, QRect, QRectF, Qt, Signal
from PySide6.QtGui import (
    QColor,
    QContextMenuEvent,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPolygonF,
    QWheelEvent,
)
from PySide6.QtWidgets import QWidget

from workbench.app.appearance.theme import LIGHT, LIMITING, Theme
from workbench.app.handling.gizmo import Gizmo
from workbench.app.handling.normals import faces_away
from workbench.app.views.anchor_paint import paint_anchors
from workbench.app.views.camera import Points
from workbench.app.views.gizmo_paint import paint_gizmo
from workbench.app.views.scale_bar import paint_scale_bar
from workbench.app.views.sketch import Sketch, paint_outline, paint_sketch
from workbench.core.arrays import Booleans, Integers

if TYPE_CHECKING:
    from PySide6.QtCore import QEvent

    from workbench.app.views.mesh_view import MeshView


def _no_points() -> Points:
    return np.empty((0, 3))


@dataclass
class OverlayScene:
    """What the layer shows, in units of the display; a view's owner fills it in.

    `anchor_vertices` (k,), `anchor_points` (k, 3) where the discs stand, `vertex_points` (k, 3) where their
    vertices are now: a line joins the two where the map lags behind. `selected` and `grouped` are vertices of anchors that
    are selected, and that move with others; `soft` and `off` (k,) tell which are soft, and hold nothing. `hot_handle` is
    the kind and axis of the handle of the `gizmo` that is meant; `guide` (2, 3) the line along which anchors are pulled,
    `hold_words` what to say about that at the pixel `hold_at`; `outline` what is drawn round anchors, in pixels; `hint`
    lines at the lower edge, what keys and buttons would do now; `sketches` what tools draw, by name.
    """

    anchor_vertices: Integers = field(default_factory=lambda: np.empty(0, np.int64))
    anchor_points: Points = field(default_factory=_no_points)
    vertex_points: Points = field(default_factory=_no_points)
    selected: Integers = field(default_factory=lambda: np.empty(0, np.int64))
    grouped: frozenset[int] = frozenset()
    soft: Booleans = field(default_factory=lambda: np.empty(0, bool))
    off: Booleans = field(default_factory=lambda: np.empty(0, bool))
    gizmo: Gizmo | None = None
    hot_handle: tuple[str, int] | None = None
    guide: Points | None = None
    hold_words: str = ""
    hold_at: QPointF = field(default_factory=QPointF)
    outline: QPolygonF | None = None
    hint: str = ""
    sketches: dict[str, Sketch] = field(default_factory=dict)
    hovered: int = -1
    hovered_point: Points | None = None
    limiting: Points | None = None
    limiting_label: str = ""

    @property
    def is_selected(self) -> Booleans:
        """(k,) which of the anchors are."""
        return np.isin(self.anchor_vertices, self.selected)

    def told(self, which: Booleans) -> Booleans:
        """(k,) `which` of the anchors; none where that was told of other ones, or never."""
        return which if len(which) == len(self.anchor_vertices) else np.zeros(len(self.anchor_vertices), bool)

    def is_grouped(self, vertex: int) -> bool:
        return vertex in self.grouped


class Overlay(QWidget):
    """Transparent widget over the 3D view; takes every event of the mouse, so that VTK's own style never sees one."""

    pressed = Signal(object)
    moved = Signal(object)
    released = Signal(object)
    double_clicked = Signal(object)
    wheeled = Signal(object)
    left = Signal()
    key_pressed = Signal(object)

    def __init__(self, view: MeshView) -> None:
        super().__init__(view)
        self._view = view
        self.scene = OverlayScene()
        self.theme: Theme = LIGHT
        self.message = ""
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setAttribute(Qt.WidgetAttribute.WA_NoSystemBackground)

    # ------------------------------------------------------------------------------------------ events

    def mousePressEvent(self, event: QMouseEvent) -> None:
        self.pressed.emit(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:
        self.moved.emit(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:
        self.released.emit(event)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:
        self.double_clicked.emit(event)

    def wheelEvent(self, event: QWheelEvent) -> None:
        self.wheeled.emit(event)
        event.accept()

    def leaveEvent(self, event: QEvent) -> None:
        self.left.emit()

    def keyPressEvent(self, event: QKeyEvent) -> None:
        event.ignore()  # unless somebody takes it
        self.key_pressed.emit(event)

    def contextMenuEvent(self, event: QContextMenuEvent) -> None:
        event.accept()  # the right button is for anchors; the window's dock menu would cover them

    # ------------------------------------------------------------------------------------------ painting

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        if self.message:
            self._paint_message(painter)
        self._paint_limiting(painter)
        self._paint_guide(painter)
        for sketch in self.scene.sketches.values():
            paint_sketch(painter, sketch, self._view, self.theme)
        self._paint_anchors(painter)
        if self.scene.gizmo is not None:
            view = self._view
            paint_gizmo(painter, self.scene.gizmo, self.scene.hot_handle, view.camera, view.size_in_pixels, self.theme)
        self._paint_hovered(painter)
        if self.scene.outline is not None:
            paint_outline(painter, self.scene.outline, self.theme)
        if self._view.drawing.scale_bar and self._view.geometry_shown is not None:
            paint_scale_bar(painter, self._view.pixels_per_unit, QRectF(self.rect()), self.theme)
        self._label(painter, self.scene.hold_at + QPointF(16, -10), self.scene.hold_words)
        self._label(painter, QPointF(8, self.height() - 6), self.scene.hint)
        painter.end()

    def _paint_message(self, painter: QPainter) -> None:
        painter.setPen(QColor(self.theme.faint))
        area = QRectF(self.rect()).adjusted(24, 24, -24, -24)
        painter.drawText(area, Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap, self.message)

    def _paint_limiting(self, painter: QPainter) -> None:
        scene = self.scene
        if scene.limiting is None:
            return
        corners = self._view.project(scene.limiting)
        painter.setPen(QPen(LIMITING, 2.5))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        points = [QPointF(*p) for p in corners]
        for one, other in combinations(points, 2):  # of a tetrahedron all six edges are seen
            painter.drawLine(one, other)
        # a simplex about to invert is often too thin to be seen: a ring says where it is
        middle = corners.mean(axis=0)
        painter.drawEllipse(QPointF(*middle), 13.0, 13.0)
        self._label(painter, QPointF(middle[0] + 16, middle[1] + 36), scene.limiting_label)

    def _paint_anchors(self, painter: QPainter) -> None:
        scene = self.scene
        if not len(scene.anchor_vertices):
            return
        paint_anchors(
            painter,
            self._view.project(scene.anchor_points),
            self._view.project(scene.vertex_points),
            is_selected=scene.is_selected,
            is_soft=scene.told(scene.soft),
            is_off=scene.told(scene.off),
            is_behind=self._behind(scene.anchor_vertices),
            theme=self.theme,
        )

    def _behind(self, vertices: Integers) -> Booleans:
        """(k,) which of these are at the back of a solid, or inside; surfaces have no back."""
        geometry = self._view.geometry_shown
        if geometry is None or geometry.simplices.shape[1] == 3:
            return np.zeros(len(vertices), dtype=bool)
        return faces_away(geometry.points, geometry.triangles, vertices, self._view.camera.axes[2])

    def _paint_guide(self, painter: QPainter) -> None:
        if self.scene.guide is not None:
            begin, end = self._view.project(self.scene.guide)
            painter.setPen(QPen(QColor(self.theme.accent), 1.2, Qt.PenStyle.DashDotLine))
            painter.drawLine(QPointF(*begin), QPointF(*end))

    def _paint_hovered(self, painter: QPainter) -> None:
        scene = self.scene
        if scene.hovered < 0 or scene.hovered_point is None:
            return
        (point,) = self._view.project(scene.hovered_point[None, :])
        if not self.rect().adjusted(-10, -10, 10, 10).contains(round(point[0]), round(point[1])):
            return  # the view has turned elsewhere since: in its corner the label would be of nothing there
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(QColor(self.theme.view), 4.0))
        painter.drawEllipse(QPointF(*point), 10.0, 10.0)
        painter.setPen(QPen(QColor(self.theme.accent), 2.0))
        painter.drawEllipse(QPointF(*point), 10.0, 10.0)
        self._label(painter, QPointF(point[0] + 14, point[1] - 12), f"vertex {scene.hovered}")

    def _label(self, painter: QPainter, at: QPointF, text: str) -> None:
        if not text:
            return
        metrics = painter.fontMetrics()
        lines = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter | Qt.TextFlag.TextWordWrap
        room = QRect(0, 0, max(self.width() - 16, 80), 10_000)
        box = QRectF(metrics.boundingRect(room, lines, text)).adjusted(-6, -3, 6, 3)
        box.moveTopLeft(at + QPointF(0, -box.height()))
        # near an edge of the view the label turns back inside
        box.moveLeft(min(max(box.left(), 2.0), self.width() - box.width() - 2.0))
        box.moveTop(min(max(box.top(), 2.0), self.height() - box.height() - 2.0))
        painter.setPen(Qt.PenStyle.NoPen)
        paper = QColor(self.theme.base)
        paper.setAlpha(225)
        painter.setBrush(paper)
        painter.drawRoundedRect(box, 4, 4)
        painter.setPen(QColor(self.theme.text))
        painter.drawText(box.adjusted(6, 0, -4, 0), lines, text)
