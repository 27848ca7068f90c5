"""What the mouse does to anchors: set, choose, pull, turn and let go."""

from __future__ import annotations

import time
from collections.abc import Callable

import numpy as np
from PySide6.QtCore import QPointF, Qt, QTimer, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QWheelEvent

from workbench.app.handling.area_drawing import AreaDrawing
from workbench.app.handling.hold_keys import HoldKeys
from workbench.app.handling.holds import Hold, Pull, hold_of
from workbench.app.handling.key_hold import KeyHold
from workbench.app.handling.locks import Lock, axis_lock, normal_lock, toggled
from workbench.app.handling.navigation_tool import NavigationTool, pixel_of
from workbench.app.handling.normals import mean_normal
from workbench.app.views.camera import Pixel
from workbench.app.views.mesh_view import MeshView

CLICK_SLACK = 4.0
"""Pixels that the hand may move between press and release of a click."""
DRAG_INTERVAL = 16
"""Milliseconds between two moves that are passed on: 60 a second."""
LEFT, RIGHT, SHIFT, ALT, CTRL = (
    Qt.MouseButton.LeftButton,
    Qt.MouseButton.RightButton,
    Qt.KeyboardModifier.ShiftModifier,
    Qt.KeyboardModifier.AltModifier,
    Qt.KeyboardModifier.ControlModifier,
)


class AnchorTool(NavigationTool):
    """Anchors with the mouse, on top of looking about.

    Click: set or select; with Shift add to the selection, with Ctrl take out of it. Drag in the target: move all that is
    selected. Shift and drag: a box. Alt and click: a whole patch. `hold` moves without a button. Signals carry vertices and
    motions; what they do is the business of whoever listens.
    """

    hovered = Signal(int)
    anchor_wanted = Signal(int)
    anchor_selected = Signal(int)
    taken_up = Signal()
    """The selected anchors are held by the hand now"""
    motion_wanted = Signal(object, bool, float)
    """motion since they were taken up, whether the hand still holds them, time of the event"""
    drag_cancelled = Signal()
    anchor_toggled = Signal(int, bool)
    """one more anchor is selected, or one less"""
    picked = Signal(int)
    """vertex that was clicked while vertices are picked, -1 for none"""
    wheel_turned = Signal(float)
    """steps of the wheel while anchors are held, where `wheel_is_taken`"""
    patch_wanted = Signal(float, float)
    """pixel of what is to be anchored as a whole"""
    anchor_unwanted = Signal(int)
    menu_wanted = Signal(int, float, float)
    """anchor under the pointer or -1, pixel"""
    numbers_wanted = Signal()

    def __init__(self, view: MeshView, *, is_target: bool, may_anchor: Callable[[], bool]) -> None:
        super().__init__(view)
        self.is_target = is_target
        self._may_anchor = may_anchor
        self._pressed_at = self._where = self._pointer = QPointF()
        self._pressed_vertex = self._clicked_anchor = -1
        self._hold: Hold | None = None
        self._was_moved = False
        self._taken_from = np.zeros(3)
        self.area = AreaDrawing(view)
        self.is_picking = self.wheel_is_taken = False
        self.note = ""
        self.may_hold: Callable[[str], bool] = lambda deed: True
        """Whether "move", "turn" or "scale" has a meaning for the selected anchors; who is asked says why not."""
        self._pending: tuple[QPointF, bool, float] | None = None
        self._keys = HoldKeys(self, view.overlay)
        self._keys.axis_pressed.connect(self._lock_axis)
        self._keys.normal_pressed.connect(self._lock_normal)
        self._keys.cancelled.connect(self.cancel)
        self._keys.typed.connect(self._type)
        self._keys.confirmed.connect(self._confirm)
        self._keys.deed_pressed.connect(self._change_deed)
        self._throttle = QTimer(self)
        self._throttle.setInterval(DRAG_INTERVAL)
        self._throttle.timeout.connect(self._pass_on)
        view.overlay.key_pressed.connect(self._key)

    @property
    def is_dragging(self) -> bool:
        return self._hold is not None

    # ------------------------------------------------------------------------------------------ press

    def press(self, event: QMouseEvent) -> None:
        if isinstance(self._hold, KeyHold):
            if event.button() == LEFT:
                self._confirm()
            elif event.button() == RIGHT:
                self.cancel()
            else:
                super().press(event)
        elif event.button() == RIGHT and not self.is_dragging:
            self._press_right(event)
        elif event.button() != LEFT or not self._may_anchor():
            super().press(event)
        elif self.is_picking:
            self.picked.emit(self.view.vertex_at(pixel_of(event)))
        else:
            self._press_left(event)

    def _press_right(self, event: QMouseEvent) -> None:
        x, y = pixel_of(event)
        vertex = self.view.anchor_at((x, y))
        scene = self.view.overlay.scene
        if self.is_picking:
            self.picked.emit(-1)
        elif vertex >= 0 and not scene.is_grouped(vertex) and not (vertex in scene.selected and len(scene.selected) > 1):
            self.anchor_unwanted.emit(vertex)
        elif self._may_anchor():
            self.menu_wanted.emit(vertex, x, y)

    def _press_left(self, event: QMouseEvent) -> None:
        pixel = pixel_of(event)
        self._pressed_at, self._pressed_vertex = event.position(), -1
        scene = self.view.overlay.scene
        handle = scene.gizmo.handle_at(pixel, self.view.camera, self.view.size_in_pixels) if scene.gizmo is not None else None
        if handle is not None and scene.gizmo is not None and not self.area.is_armed:
            self._take(hold_of(self.view, scene.gizmo, handle, pixel))
            return
        if self.area.takes(event):
            self.hovered.emit(-1)
            self.area.press(event)
            return
        vertex = self.view.anchor_at(pixel)
        if vertex >= 0 and event.modifiers() & CTRL:
            self.anchor_toggled.emit(vertex, False)
            return
        if vertex >= 0:
            if vertex not in scene.selected:  # one of several takes the others along; a mere click selects it alone
                self.anchor_selected.emit(vertex)
        elif event.modifiers() & ALT:
            self.patch_wanted.emit(*pixel)
            return
        else:
            self._pressed_vertex = self.view.vertex_at(pixel)
            if self._pressed_vertex < 0 or not self.is_target or self.can_rotate:
                # in space a drag that begins on the surface turns it; only a click sets an anchor
                super().press(event)
                return
            self.anchor_wanted.emit(self._pressed_vertex)  # and the same gesture may drag it
            vertex = self._pressed_vertex
        self._clicked_anchor = vertex
        if self.is_target:
            self._take(Pull(self.view, pixel))

    def _take(self, hold: Hold) -> None:
        self._hold = hold
        self._was_moved = False
        self._keys.is_free = isinstance(hold, KeyHold)
        self._keys.listen(True)
        scene = self.view.overlay.scene
        scene.hint = self._hint(hold)
        self._taken_from = scene.anchor_points[scene.is_selected].mean(axis=0)
        self.taken_up.emit()

    def _hint(self, hold: Hold) -> str:
        words = hold.hint() + ("\nWheel: how far others follow" if self.wheel_is_taken else "")
        return f"{words}\n{self.note}" if self.note else words

    # ------------------------------------------------------------------------------------------ move

    def move(self, event: QMouseEvent) -> None:
        self._pointer = event.position()
        if self._hold is not None:
            is_free = isinstance(self._hold, KeyHold)
            if not is_free and not self._was_moved and _distance(event.position(), self._pressed_at) < 2.0:
                return
            self._was_moved = True
            self._where = event.position()
            self._pending = (event.position(), bool(event.modifiers() & CTRL), time.perf_counter())
            if not self._throttle.isActive():
                self._pass_on()
                self._throttle.start()
        elif self.area.is_drawing:
            self.area.move(event)
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
        scene = self.view.overlay.scene
        scene.hold_words, scene.hold_at = self._hold.words() if is_held else "", where
        scene.hint = self._hint(self._hold)
        self.motion_wanted.emit(motion, is_held, at)

    # ------------------------------------------------------------------------------------------ release

    def release(self, event: QMouseEvent) -> None:
        if isinstance(self._hold, KeyHold):
            super().release(event)
        elif event.button() == LEFT and self._hold is not None:
            self._drop(event)
            super().release(event)
        elif event.button() == LEFT and self.area.is_drawing:
            self._close_area(event)
            super().release(event)
        else:
            self._click(event)
            super().release(event)

    def _click(self, event: QMouseEvent) -> None:
        vertex, self._pressed_vertex = self._pressed_vertex, -1
        is_click = event.button() == LEFT and vertex >= 0 and _distance(event.position(), self._pressed_at) < CLICK_SLACK
        if is_click and self.view.anchor_at(pixel_of(event)) < 0:
            self.anchor_wanted.emit(vertex)

    def _drop(self, event: QMouseEvent) -> None:
        if self._was_moved:
            self._move_to(event.position(), bool(event.modifiers() & CTRL), False, time.perf_counter())
        elif self._clicked_anchor >= 0:
            self.anchor_selected.emit(self._clicked_anchor)
        self.let_go()

    def _close_area(self, event: QMouseEvent) -> None:
        """A press with Shift that draws nothing is a click that adds an anchor to the selection."""
        vertex = self.view.anchor_at(pixel_of(event))
        if not self.area.is_armed and vertex >= 0 and _distance(event.position(), self._pressed_at) < CLICK_SLACK:
            self.area.end()
            self.anchor_toggled.emit(vertex, True)
        else:
            self.area.release(event)

    def let_go(self) -> None:
        """Forget a drag under way: it has ended, or another mesh came."""
        self._hold = None
        self._pending = None
        self._clicked_anchor = self._pressed_vertex = -1
        self.note = ""
        self._throttle.stop()
        self._keys.listen(False)
        scene = self.view.overlay.scene
        scene.hold_words, scene.hint, scene.guide = "", "", None
        self.area.end()

    def cancel(self) -> None:
        """Take a drag under way back, or draw no area."""
        if self._hold is not None:
            self.let_go()
            self.drag_cancelled.emit()
        else:
            self.area.end()

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
        if not isinstance(hold, Pull | KeyHold) or not hold.takes_locks:
            return
        hold.lock = toggled(hold.lock, wanted)
        scene = self.view.overlay.scene
        scene.guide = None
        if hold.lock.kind == "line":
            scene.guide = self._taken_from + np.outer([-2.0, 2.0], hold.lock.direction)
        self.move_again()

    def move_again(self) -> None:
        """What the pointer or the keys say means something else now."""
        if self._hold is not None and (self._was_moved or isinstance(self._hold, KeyHold)):
            self._was_moved = True
            self._move_to(self._where, False, True, time.perf_counter())
        self.view.overlay.update()

    # ------------------------------------------------------------------------------------------ without a button

    def hold(self, deed: str) -> bool:
        """The selected anchors follow the pointer until a click or Enter: "move", "turn" or "scale". Whether there are any."""
        scene, overlay = self.view.overlay.scene, self.view.overlay
        if self.is_dragging or not len(scene.selected) or not self._may_anchor() or self.view.geometry_shown is None:
            return False
        self.area.end()
        pointer = self._pressed_at = self._where = self._pointer
        centre = scene.anchor_points[scene.is_selected].mean(axis=0)
        overlay.setFocus()
        self._take(KeyHold(deed, self.view, centre, (pointer.x(), pointer.y())))
        overlay.update()
        return True

    def _change_deed(self, deed: str) -> None:
        """Another deed from the same begin; what the first one did is taken back."""
        hold = self._hold
        if isinstance(hold, KeyHold) and hold.deed != deed and self.may_hold(deed):
            self._hold = hold.instead(deed)
            self.view.overlay.scene.guide = None
            self.move_again()

    def _type(self, character: str) -> None:
        if isinstance(self._hold, KeyHold):
            self._hold.type(character)
            self.move_again()

    def _confirm(self) -> None:
        if self._hold is not None:
            if self._was_moved:
                self._move_to(self._where, False, False, time.perf_counter())
            self.let_go()

    def wheel(self, event: QWheelEvent) -> None:
        if self.is_dragging and self.wheel_is_taken:
            self.wheel_turned.emit(event.angleDelta().y() / 120.0)
        else:
            super().wheel(event)

    # ------------------------------------------------------------------------------------------ keys

    def _key(self, event: QKeyEvent) -> None:
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self.numbers_wanted.emit()
            event.accept()


def _distance(a: QPointF, b: QPointF) -> float:
    return max(abs(a.x() - b.x()), abs(a.y() - b.y()))
