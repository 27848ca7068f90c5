"""What the mouse does in a view: look about, set, drag and remove anchors."""

from __future__ import annotations

import time
from collections.abc import Callable

from PySide6.QtCore import QObject, QPointF, Qt, QTimer, Signal
from PySide6.QtGui import QMouseEvent, QWheelEvent

from workbench.app.views.mesh_view import MeshView

CLICK_SLACK = 4.0
"""Pixels that the hand may move between press and release of a click."""
DRAG_INTERVAL = 16
"""Milliseconds between two moves that are passed on: 60 a second."""


class NavigationTool(QObject):
    """Wheel zooms at the pointer, middle drag pans, left drag on the background turns a surface in space."""

    def __init__(self, view: MeshView) -> None:
        super().__init__(view)
        self.view = view
        self._last: QPointF | None = None
        self._mode = ""
        overlay = view.overlay
        overlay.pressed.connect(self.press)
        overlay.moved.connect(self.move)
        overlay.released.connect(self.release)
        overlay.double_clicked.connect(self.double_click)
        overlay.wheeled.connect(self.wheel)
        overlay.left.connect(self.leave)

    @property
    def can_rotate(self) -> bool:
        return self.view.geometry_shown is not None and not self.view.geometry_shown.is_flat

    def press(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.MiddleButton:
            self._begin("pan", event)
        elif event.button() == Qt.MouseButton.LeftButton:
            self._begin("rotate" if self.can_rotate else "pan", event)

    def _begin(self, mode: str, event: QMouseEvent) -> None:
        self._mode = mode
        self._last = event.position()

    def move(self, event: QMouseEvent) -> None:
        if self._last is None or self.view.geometry_shown is None:
            return
        step = event.position() - self._last
        self._last = event.position()
        size = self.view.size_in_pixels
        if self._mode == "pan":
            self.view.set_camera(self.view.camera.panned(step.x(), step.y(), size))
        elif self._mode == "rotate":
            self.view.set_camera(self.view.camera.rotated(step.x(), step.y(), size))

    def release(self, event: QMouseEvent) -> None:
        self._last = None
        self._mode = ""

    def double_click(self, event: QMouseEvent) -> None:
        if not self.view.is_over_mesh(_pixel(event)):
            self.view.fit()

    def wheel(self, event: QWheelEvent) -> None:
        if self.view.geometry_shown is None:
            return
        turns = event.angleDelta().y() / 120.0
        where = event.position()
        self.view.set_camera(self.view.camera.zoomed(1.2**turns, (where.x(), where.y()), self.view.size_in_pixels))

    def leave(self) -> None:
        pass


class AnchorTool(NavigationTool):
    """Anchors with the mouse, on top of looking about.

    Click: set or select. Drag in the target: move. Right click: remove. Signals carry vertices and places; what
    they do is the business of whoever listens.
    """

    hovered = Signal(int)
    anchor_wanted = Signal(int)
    anchor_selected = Signal(int)
    anchor_moved = Signal(int, object, bool, float)
    """vertex, place (d,), whether the hand still holds it, time of the event"""
    anchor_unwanted = Signal(int)

    def __init__(self, view: MeshView, *, is_target: bool, may_anchor: Callable[[], bool]) -> None:
        super().__init__(view)
        self._is_target = is_target
        self._may_anchor = may_anchor
        self._pressed_at = QPointF()
        self._pressed_vertex = -1
        self._held = -1
        self._grip = QPointF()
        self._was_moved = False
        self._pending: tuple[QPointF, float] | None = None
        self._throttle = QTimer(self)
        self._throttle.setInterval(DRAG_INTERVAL)
        self._throttle.timeout.connect(self._pass_on)

    @property
    def is_dragging(self) -> bool:
        return self._held >= 0

    def press(self, event: QMouseEvent) -> None:
        pixel = _pixel(event)
        if event.button() == Qt.MouseButton.RightButton:
            vertex = self.view.anchor_at(pixel)
            if vertex >= 0:
                self.anchor_unwanted.emit(vertex)
            return
        if event.button() != Qt.MouseButton.LeftButton or not self._may_anchor():
            super().press(event)
            return
        self._pressed_at = event.position()
        vertex = self.view.anchor_at(pixel)
        is_anchor = vertex >= 0
        if not is_anchor:
            vertex = self.view.vertex_at(pixel)
        self._pressed_vertex = vertex
        if vertex < 0:
            super().press(event)
        elif is_anchor:
            self.anchor_selected.emit(vertex)
            self._hold(vertex)
        elif self._is_target:
            # a press sets the anchor, and the same gesture may drag it
            self.anchor_wanted.emit(vertex)
            self._hold(vertex)
        else:
            # in space a drag that begins on the surface turns it; only a click sets an anchor
            super().press(event)

    def _hold(self, vertex: int) -> None:
        """Take an anchor up where it was touched: it does not jump to the pointer."""
        if self._is_target:
            self._held = vertex
            self._was_moved = False
            scene = self.view.overlay.scene
            row = int((scene.anchor_vertices == vertex).argmax())
            x, y = self.view.project(scene.anchor_points[[row]])[0]
            self._grip = self._pressed_at - QPointF(x, y)

    def move(self, event: QMouseEvent) -> None:
        if self._held >= 0:
            if not self._was_moved and _distance(event.position(), self._pressed_at) < 2.0:
                return
            self._was_moved = True
            self._pending = (event.position(), time.perf_counter())
            if not self._throttle.isActive():
                self._pass_on()
                self._throttle.start()
            return
        if self._last is not None:
            super().move(event)
            return
        self.hovered.emit(self._vertex_under(_pixel(event)))

    def _vertex_under(self, pixel: tuple[float, float]) -> int:
        vertex = self.view.anchor_at(pixel)
        return vertex if vertex >= 0 else self.view.vertex_at(pixel)

    def _pass_on(self) -> None:
        """Hand the newest place on; older ones that nobody saw are forgotten."""
        if self._pending is None:
            self._throttle.stop()
            return
        where, at = self._pending
        where -= self._grip
        self._pending = None
        self.anchor_moved.emit(self._held, self.view.position_at((where.x(), where.y())), True, at)

    def release(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.LeftButton and self._held >= 0:
            self._drop(event.position())
        elif (
            event.button() == Qt.MouseButton.LeftButton
            and self._pressed_vertex >= 0
            and _distance(event.position(), self._pressed_at) < CLICK_SLACK
            and self.view.anchor_at(_pixel(event)) < 0
        ):
            self.anchor_wanted.emit(self._pressed_vertex)
        self._pressed_vertex = -1
        super().release(event)

    def _drop(self, where: QPointF) -> None:
        vertex, self._held = self._held, -1
        self._throttle.stop()
        self._pending = None
        where -= self._grip
        if self._was_moved:
            self.anchor_moved.emit(vertex, self.view.position_at((where.x(), where.y())), False, time.perf_counter())

    def let_go(self) -> None:
        """Forget a drag under way: another mesh came."""
        self._held = -1
        self._pending = None
        self._throttle.stop()

    def leave(self) -> None:
        self.hovered.emit(-1)


def _pixel(event: QMouseEvent) -> tuple[float, float]:
    return event.position().x(), event.position().y()


def _distance(a: QPointF, b: QPointF) -> float:
    return max(abs(a.x() - b.x()), abs(a.y() - b.y()))
