"""What the mouse does to anchors: set, choose, pull, turn and let go."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from PySide6.QtCore import QPointF, Qt, QTimer, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent

from workbench.app.handling.box_selection import in_box, visible_points
from workbench.app.handling.hold_keys import HoldKeys
from workbench.app.handling.holds import Hold, Pull, hold_of
from workbench.app.handling.locks import Lock, axis_lock, normal_lock, toggled
from workbench.app.handling.normals import mean_normal
from workbench.app.navigation_tool import NavigationTool, pixel_of
from workbench.app.views.camera import Pixel
from workbench.app.views.mesh_view import MeshView

CLICK_SLACK = 4.0
"""Pixels that the hand may move between press and release of a click."""
DRAG_INTERVAL = 16
"""Milliseconds between two moves that are passed on: 60 a second."""
BOX_HINT = "Box round vertices · with Ctrl: also those behind · Esc: none"
LEFT, SHIFT, ALT, CTRL = (
    Qt.MouseButton.LeftButton,
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.AltModifier,
    Qt.KeyboardModifier.ControlModifier,
)


class AnchorTool(NavigationTool):
    """Anchors with the mouse, on top of looking about.

    Click: set or select. Drag in the target: move, with its group. Shift and drag: a box. Alt and click: a whole patch.
    Signals carry vertices and motions; what they do is the business of whoever listens.
    """

    hovered = Signal(int)
    anchor_wanted = Signal(int)
    anchor_selected = Signal(int)
    taken_up = Signal()
    """The selected anchors are held by the hand now"""
    motion_wanted = Signal(object, bool, float)
    """motion since they were taken up, whether the hand still holds them, time of the event"""
    drag_cancelled = Signal()
    group_wanted = Signal(object)
    """vertices (k,) that were chosen by a box"""
    nothing_chosen = Signal()
    box_ended = Signal()
    """A box that was announced was drawn, or given up"""
    patch_wanted = Signal(float, float)
    """pixel of what is to be anchored as a whole"""
    anchor_unwanted = Signal(int)
    menu_wanted = Signal(int, float, float)
    """anchor under the pointer or -1, pixel"""
    numbers_wanted = Signal()

    def __init__(self, view: MeshView, *, is_target: bool, may_anchor: Callable[[], bool]) -> None:
        super().__init__(view)
        self._is_target = is_target
        self._may_anchor = may_anchor
        self._pressed_at = self._where = QPointF()
        self._pressed_vertex = -1
        self._hold: Hold | None = None
        self._was_moved = False
        self._taken_from = np.zeros(3)
        self._box_from: QPointF | None = None
        self._box_armed = False
        self._pending: tuple[QPointF, bool, float] | None = None
        self._keys = HoldKeys(self)
        self._keys.axis_pressed.connect(self._lock_axis)
        self._keys.normal_pressed.connect(self._lock_normal)
        self._keys.cancelled.connect(self.cancel)
        self._throttle = QTimer(self)
        self._throttle.setInterval(DRAG_INTERVAL)
        self._throttle.timeout.connect(self._pass_on)
        view.overlay.key_pressed.connect(self._key)

    @property
    def is_dragging(self) -> bool:
        return self._hold is not None

    # ------------------------------------------------------------------------------------------ press

    def press(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.RightButton and not self.is_dragging:
            self._press_right(event)
        elif event.button() != LEFT or not self._may_anchor():
            super().press(event)
        else:
            self._press_left(event)

    def _press_right(self, event: QMouseEvent) -> None:
        x, y = pixel_of(event)
        vertex = self.view.anchor_at((x, y))
        scene = self.view.overlay.scene
        if vertex >= 0 and not scene.is_grouped(vertex):
            self.anchor_unwanted.emit(vertex)
        elif self._may_anchor():
            self.menu_wanted.emit(vertex, x, y)

    def _press_left(self, event: QMouseEvent) -> None:
        pixel = pixel_of(event)
        self._pressed_at, self._pressed_vertex = event.position(), -1
        scene = self.view.overlay.scene
        handle = scene.gizmo.handle_at(pixel, self.view.camera, self.view.size_in_pixels) if scene.gizmo is not None else None
        if handle is not None and scene.gizmo is not None:
            self._take(hold_of(self.view, scene.gizmo, handle, pixel))
            return
        if self._box_armed or event.modifiers() & SHIFT:
            self._box_from = event.position()
            self._keys.listen(True)
            scene.hint = BOX_HINT if self.can_rotate else ""
            return
        vertex = self.view.anchor_at(pixel)
        if vertex >= 0:
            self.anchor_selected.emit(vertex)
        elif event.modifiers() & ALT:
            self.patch_wanted.emit(*pixel)
            return
        else:
            self._pressed_vertex = self.view.vertex_at(pixel)
            if self._pressed_vertex < 0 or not self._is_target or self.can_rotate:
                # in space a drag that begins on the surface turns it; only a click sets an anchor
                super().press(event)
                return
            self.anchor_wanted.emit(self._pressed_vertex)  # and the same gesture may drag it
            vertex = self._pressed_vertex
        if self._is_target:
            self._take(Pull(self.view, pixel))

    def _take(self, hold: Hold) -> None:
        self._hold = hold
        self._was_moved = False
        self._keys.listen(True)
        scene = self.view.overlay.scene
        scene.hint = hold.hint()
        self._taken_from = scene.anchor_points[scene.is_selected].mean(axis=0)
        self.taken_up.emit()

    # ------------------------------------------------------------------------------------------ move

    def move(self, event: QMouseEvent) -> None:
        if self._hold is not None:
            if not self._was_moved and _distance(event.position(), self._pressed_at) < 2.0:
                return
            self._was_moved = True
            self._where = event.position()
            self._pending = (event.position(), bool(event.modifiers() & CTRL), time.perf_counter())
            if not self._throttle.isActive():
                self._pass_on()
                self._throttle.start()
        elif self._box_from is not None:
            self.view.overlay.scene.box = (self._box_from, event.position())
            self.view.overlay.update()
        elif self._last is not None:
            super().move(event)
        else:
            self._hover(pixel_of(event))

    def _hover(self, pixel: Pixel) -> None:
        scene = self.view.overlay.scene
        handle = scene.gizmo.handle_at(pixel, self.view.camera, self.view.size_in_pixels) if scene.gizmo is not None else None
        hot = (handle.kind, handle.axis) if handle is not None else None
        if hot != scene.hot_handle:
            scene.hot_handle = hot
            scene.hint = "" if handle is None else handle.words()
            self.view.overlay.update()
        self.hovered.emit(-1 if handle is not None else self._vertex_under(pixel))

    def _vertex_under(self, pixel: Pixel) -> int:
        vertex = self.view.anchor_at(pixel)
        return vertex if vertex >= 0 else self.view.vertex_at(pixel)

    def _pass_on(self) -> None:
        """Hand the newest place on; older ones that nobody saw are forgotten."""
        if self._pending is None:
            self._throttle.stop()
            return
        where, in_stops, at = self._pending
        self._pending = None
        self._move_to(where, in_stops, True, at)

    def _move_to(self, where: QPointF, in_stops: bool, is_held: bool, at: float) -> None:
        assert self._hold is not None
        motion = self._hold.motion((where.x(), where.y()), in_stops=in_stops)
        self.view.overlay.scene.hold_words = self._hold.words() if is_held else ""
        self.view.overlay.scene.hold_at = where
        self.motion_wanted.emit(motion, is_held, at)

    # ------------------------------------------------------------------------------------------ release

    def release(self, event: QMouseEvent) -> None:
        if event.button() == LEFT and self._hold is not None:
            self._drop(event)
        elif event.button() == LEFT and self._box_from is not None:
            self._close_box(event)
        elif (
            event.button() == LEFT
            and self._pressed_vertex >= 0
            and _distance(event.position(), self._pressed_at) < CLICK_SLACK
            and self.view.anchor_at(pixel_of(event)) < 0
        ):
            self.anchor_wanted.emit(self._pressed_vertex)
        self._pressed_vertex = -1
        super().release(event)

    def _drop(self, event: QMouseEvent) -> None:
        if self._was_moved:
            self._move_to(event.position(), bool(event.modifiers() & CTRL), False, time.perf_counter())
        self.let_go()

    def let_go(self) -> None:
        """Forget a drag under way: it has ended, or another mesh came."""
        self._hold = None
        self._pending = None
        self._throttle.stop()
        self._keys.listen(False)
        scene = self.view.overlay.scene
        scene.hold_words, scene.hint, scene.guide = "", "", None
        self.end_box()

    def cancel(self) -> None:
        """Take a drag under way back, or draw no box."""
        if self._hold is not None:
            self.let_go()
            self.drag_cancelled.emit()
        else:
            self.end_box()

    def leave(self) -> None:
        self.hovered.emit(-1)

    def double_click(self, event: QMouseEvent) -> None:
        if self.view.anchor_at(pixel_of(event)) >= 0 and event.button() == LEFT:
            self.numbers_wanted.emit()
        else:
            super().double_click(event)

    # ------------------------------------------------------------------------------------------ locks

    def _lock_axis(self, name: str, is_plane: bool) -> None:
        if self.can_rotate or (name != "z" and not is_plane):
            self._lock(axis_lock(name, plane=is_plane))

    def _lock_normal(self) -> None:
        geometry, scene = self.view.geometry_shown, self.view.overlay.scene
        if geometry is not None and self.can_rotate:
            normal = mean_normal(geometry.points, geometry.triangles, scene.anchor_vertices[scene.is_selected])
            if normal is not None:
                self._lock(normal_lock(normal))

    def _lock(self, wanted: Lock) -> None:
        hold = self._hold
        if not isinstance(hold, Pull):
            return
        hold.lock = toggled(hold.lock, wanted)
        scene = self.view.overlay.scene
        scene.guide = None
        if hold.lock.kind == "line":
            scene.guide = self._taken_from + np.outer([-2.0, 2.0], hold.lock.direction)
        if self._was_moved:
            self._move_to(self._where, False, True, time.perf_counter())
        self.view.overlay.update()

    # ------------------------------------------------------------------------------------------ boxes

    def arm_box(self) -> None:
        """The next drag draws a box."""
        self._box_armed = True
        self._keys.listen(True)
        self.view.overlay.setCursor(Qt.CursorShape.CrossCursor)
        self.view.overlay.scene.hint = BOX_HINT
        self.view.overlay.update()

    def _close_box(self, event: QMouseEvent) -> None:
        begin, end = self._box_from or event.position(), event.position()
        self.end_box()
        geometry = self.view.geometry_shown
        if geometry is None or _distance(begin, end) < CLICK_SLACK:
            return
        corners = np.array([[begin.x(), begin.y()], [end.x(), end.y()]])
        pixels, heights = self.view.camera.project(geometry.points, self.view.size_in_pixels)
        chosen = np.flatnonzero(in_box(pixels[: geometry.vertex_count], corners.min(axis=0), corners.max(axis=0)))
        if not geometry.is_flat and not event.modifiers() & CTRL:
            chosen = visible_points(chosen, pixels, heights, geometry.triangles)
        if len(chosen):
            self.group_wanted.emit(chosen)
        else:
            self.nothing_chosen.emit()

    def end_box(self) -> None:
        """Draw no box, or no longer."""
        was_armed, self._box_armed, self._box_from = self._box_armed, False, None
        self.view.overlay.scene.box = None
        self.view.overlay.scene.hint = ""
        self.view.overlay.unsetCursor()
        self.view.overlay.update()
        self._keys.listen(False)
        if was_armed:
            self.box_ended.emit()

    # ------------------------------------------------------------------------------------------ keys

    def _key(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.numbers_wanted.emit()
            event.accept()


def _distance(a: QPointF, b: QPointF) -> float:
    return max(abs(a.x() - b.x()), abs(a.y() - b.y()))
