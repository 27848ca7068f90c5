"""A box or a lasso that is drawn over a view, and which vertices or anchors lie in it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from PySide6.QtCore import QObject, QPointF, Qt, Signal
from PySide6.QtGui import QKeyEvent, QMouseEvent, QPolygonF

from workbench.app.handling.key_trap import KeyTrap
from workbench.app.handling.lasso import box_outline, in_outline
from workbench.app.handling.visible_points import visible_points
from workbench.app.views.mesh_view import MeshView
from workbench.core.arrays import Floats, Integers

SLACK = 4.0
"""Pixels that an outline extends over at least."""
STEP = 2.0
"""Pixels between two points of a lasso."""
SHIFT, CTRL = Qt.KeyboardModifier.ShiftModifier, Qt.KeyboardModifier.ControlModifier
SHAPES = {Qt.Key.Key_B: "box", Qt.Key.Key_L: "lasso"}


@dataclass
class AreaMode:
    """What is drawn, and what for.

    `shape` : "box" or "lasso";  `deed` : "anchor" vertices, or "select" anchors;  `through` : also what is hidden
    """

    shape: str = "box"
    deed: str = "anchor"
    through: bool = False


class AreaKeys(KeyTrap):
    """B and L change the shape, T what is hidden, Esc ends."""

    pressed = Signal(object)

    def wants(self, event: QKeyEvent) -> bool:
        return event.key() in (*SHAPES, Qt.Key.Key_T, Qt.Key.Key_Escape) and not event.modifiers() & CTRL

    def take(self, event: QKeyEvent) -> None:
        if not event.isAutoRepeat():
            self.pressed.emit(Qt.Key(event.key()))


class AreaDrawing(QObject):
    """Draws in one view; views that belong together share their `mode`.

    Armed by a key or a menu the next drag draws; Shift adds what is inside to what was selected, Ctrl takes it away. A drag
    with Shift draws a box unarmed, too: then Ctrl takes what is hidden as well.
    """

    chosen = Signal(object, str, str)
    """Vertices (k,); the deed; whether they replace what was selected, or "add" to it, or are for "remove", in words"""
    nothing_chosen = Signal()
    ended = Signal()
    """One that was armed was drawn, or given up"""
    mode_changed = Signal()

    def __init__(self, view: MeshView) -> None:
        super().__init__(view)
        self._view = view
        self.mode = AreaMode()
        self.is_armed = False
        self._points: list[QPointF] = []
        self._keys = AreaKeys(self)
        self._keys.pressed.connect(self._key)

    @property
    def is_drawing(self) -> bool:
        return bool(self._points)

    def arm(self) -> None:
        """The next drag draws."""
        self.is_armed = True
        self._keys.listen(True)
        self._view.overlay.setCursor(Qt.CursorShape.CrossCursor)
        self.show_hint()

    def takes(self, event: QMouseEvent) -> bool:
        """Whether a press of the left button begins to draw."""
        return self.is_armed or bool(event.modifiers() & SHIFT)

    # ------------------------------------------------------------------------------------------ drawing

    def press(self, event: QMouseEvent) -> None:
        self._points = [event.position()]
        self._keys.listen(True)
        self.show_hint()

    def move(self, event: QMouseEvent) -> None:
        where, last = event.position(), self._points[-1]
        if self._shape == "box":
            self._points[1:] = [where]
        elif (where - last).manhattanLength() >= STEP:
            self._points.append(where)
        self._view.overlay.scene.outline = QPolygonF([QPointF(x, y) for x, y in self._outline().tolist()])
        self.show_hint(event.modifiers())

    def release(self, event: QMouseEvent) -> None:
        if self._shape == "box" or (event.position() - self._points[-1]).manhattanLength() >= STEP:
            self._points[1 if self._shape == "box" else len(self._points) :] = [event.position()]
        outline, modifiers, was_armed = self._outline(), event.modifiers(), self.is_armed
        mode = self.mode if was_armed else AreaMode(through=bool(modifiers & CTRL))
        self.end()
        if np.ptp(outline, axis=0).max() < SLACK or self._view.geometry_shown is None:
            return
        found = self._inside(outline, mode)
        how = ("remove" if modifiers & CTRL else "add" if modifiers & SHIFT else "replace") if was_armed else "replace"
        if len(found):
            self.chosen.emit(found, mode.deed, how)
        else:
            self.nothing_chosen.emit()

    def end(self) -> None:
        """Draw nothing, or no longer."""
        was_armed, self.is_armed, self._points = self.is_armed, False, []
        scene = self._view.overlay.scene
        scene.outline, scene.hint = None, ""
        self._keys.listen(False)
        self._view.overlay.unsetCursor()
        self._view.overlay.update()
        if was_armed:
            self.ended.emit()

    @property
    def _shape(self) -> str:
        return self.mode.shape if self.is_armed else "box"

    def _outline(self) -> Floats:
        points = np.array([[p.x(), p.y()] for p in self._points])
        return box_outline(points[0], points[-1]) if self._shape == "box" else points

    def _inside(self, outline: Floats, mode: AreaMode) -> Integers:
        """Vertices (k,) inside that are meant: those of anchors by their discs where anchors are selected."""
        view, geometry, scene = self._view, self._view.geometry_shown, self._view.overlay.scene
        assert geometry is not None
        pixels, heights = view.camera.project(geometry.points, view.size_in_pixels)
        if mode.deed == "select":
            found = scene.anchor_vertices[in_outline(view.project(scene.anchor_points), outline)]
        else:
            found = np.flatnonzero(in_outline(pixels[: geometry.vertex_count], outline))
        if mode.through or geometry.is_flat:
            return found
        is_drawn = np.zeros(len(pixels), dtype=bool)
        is_drawn[geometry.triangles] = True  # what lies inside a solid is not seen
        return visible_points(found[is_drawn[found]], pixels, heights, geometry.triangles)

    # ------------------------------------------------------------------------------------------ keys and words

    def _key(self, key: Qt.Key) -> None:
        if key == Qt.Key.Key_Escape:
            self.end()
            return
        if not self.is_armed:
            return
        if key == Qt.Key.Key_T:
            self.mode.through = not self.mode.through
        elif self.mode.shape != SHAPES[key]:
            self.mode.shape = SHAPES[key]
            del self._points[1:]
        self.mode_changed.emit()

    def show_hint(self, modifiers: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> None:
        """Say in the view what is drawn and which keys change it."""
        scene = self._view.overlay.scene
        is_flat = self._view.geometry_shown is None or self._view.geometry_shown.is_flat
        if self.is_armed:
            other = "L: lasso" if self.mode.shape == "box" else "B: box"
            words = self.words(modifiers) if is_flat else f"{self.words(modifiers)}, {self._depth()}"
            scene.hint = f"{words}\n{other} · Shift: add · Ctrl: take away · Esc: leave"
        else:
            scene.hint = "" if is_flat else "Box round vertices · with Ctrl: also those behind · Esc: none"
        self._view.overlay.update()

    def words(self, modifiers: Qt.KeyboardModifier = Qt.KeyboardModifier.NoModifier) -> str:
        """What the next drag does."""
        what = f"in the {self.mode.shape}"
        if self.mode.deed == "anchor":
            return f"Let go of anchors {what}" if modifiers & CTRL else f"Anchor vertices {what}"
        verb = "Take away" if modifiers & CTRL else "Add" if modifiers & SHIFT else "Select"
        return f"{verb} anchors {what}"

    def _depth(self) -> str:
        return "hidden ones, too (T: only what is seen)" if self.mode.through else "only what is seen (T: hidden ones, too)"
