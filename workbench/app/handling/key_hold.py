"""Anchors that follow the pointer without a button held: moved, turned or scaled about their centre, by numbers, too."""

from __future__ import annotations

import math

import numpy as np

from workbench.app.handling.gizmo import RADIUS
from workbench.app.handling.holds import Pull
from workbench.app.handling.locks import AXES, FREE, Lock
from workbench.app.handling.motion import Motion
from workbench.app.handling.rigid_motion import RigidMotion
from workbench.app.handling.stretch import Stretch
from workbench.app.handling.turning import Turning, snapped
from workbench.app.handling.typed_numbers import TypedNumbers
from workbench.app.views.camera import Pixel
from workbench.app.views.mesh_view import MeshView
from workbench.core.arrays import Floats

NEAREST = 60.0
"""Pixels from the centre that a pointer nearer to it counts as, so that scaling does not begin at a point."""
DEEDS = {"move": "Move", "turn": "Turn", "scale": "Scale"}
KEYS = "numbers · Enter, click: done · Esc: back"


class KeyHold:
    """A `Hold` that keys have begun.

    Parameters
    ----------
    deed : "move", "turn" or "scale"
    centre : (3,) float64     of the anchors, in units of the display
    begin : pixel             where the pointer was
    """

    def __init__(self, deed: str, view: MeshView, centre: Floats, begin: Pixel) -> None:
        assert view.geometry_shown is not None
        self.deed = deed
        self._view = view
        self._is_flat = view.geometry_shown.is_flat
        frame = view.geometry_shown.frame
        self._shown_centre = centre
        self._centre = np.zeros(3)
        self._centre[: len(frame.centre)] = frame.from_display(centre)
        self._begin = begin
        self._lock = FREE
        self._number: Floats | float = 0.0 if deed != "scale" else 1.0
        self._restart()

    @property
    def lock(self) -> Lock:
        return self._lock

    @lock.setter
    def lock(self, lock: Lock) -> None:
        """Another axis: what was typed stays behind, what the pointer did counts from its begin."""
        self._lock = lock
        self._restart()

    @property
    def takes_locks(self) -> bool:
        """A turn in the plane has one axis only."""
        return not (self._is_flat and self.deed == "turn")

    def instead(self, deed: str) -> KeyHold:
        """Another deed from the same begin."""
        return KeyHold(deed, self._view, self._shown_centre, self._begin)

    def type(self, character: str) -> None:
        """Take a character of a number; an empty one takes the last back, a tab goes on to the next number."""
        if character == "":
            self.typed.delete()
        elif character == "\t":
            self.typed.next()
        else:
            self.typed.type(character)

    def _restart(self) -> None:
        self.typed = TypedNumbers(len(self._names) if self.deed == "move" else 1)
        self._pull = Pull(self._view, self._begin, self._lock)
        x, y = self._view.project(self._shown_centre[None, :])[0]
        self._middle = (float(x), float(y))
        self._turning = Turning(self._axis, self._view.camera.axes, self._middle, self._begin, RADIUS)

    # ------------------------------------------------------------------------------------------ axes

    @property
    def _names(self) -> list[str]:
        """Axes for which a shift has a number each."""
        if self._lock.kind == "line":
            return [""]
        chosen = [name for name in AXES if self._lock.kind == "free" or AXES[name] != self._lock.direction]
        return [name for name in chosen if not (self._is_flat and name == "z")]

    @property
    def _axis(self) -> Floats:
        """(3,) of length 1: what a turn goes about."""
        if self._lock.kind != "free":
            return np.asarray(self._lock.direction)
        return np.array([0.0, 0.0, 1.0]) if self._is_flat else np.asarray(self._view.camera.axes[2])

    @property
    def _where(self) -> str:
        if self._lock == FREE:
            return ""
        if self.deed == "turn":
            name = next((axis for axis in AXES if AXES[axis] == self._lock.direction), "the normal")
            return f" about {name.upper() if len(name) == 1 else name}"
        return f" {self._lock.name}"

    # ------------------------------------------------------------------------------------------ motions

    def motion(self, pixel: Pixel, *, in_stops: bool) -> Motion:
        """By the pointer, or by what was typed."""
        if self.deed == "move":
            return self._shift(pixel)
        if self.deed == "turn":
            pointed = self._turning.move(pixel)
            typed = self.typed.values[0]
            angle = math.radians(typed) if typed is not None else snapped(pointed) if in_stops else pointed
            self._number = math.degrees(angle)
            return RigidMotion(turn=angle * self._axis, centre=self._centre)
        typed = self.typed.values[0]
        factor = self._factor(pixel) if typed is None else typed
        self._number = factor
        return Stretch(1.0 + (factor - 1.0) * self._stretched, self._centre)

    def _shift(self, pixel: Pixel) -> Motion:
        pointed = self._pull.motion(pixel)
        self._number = pointed.shift
        values = self.typed.values
        if self.typed.is_empty:
            return pointed
        if self._lock.kind == "line":
            shift = (values[0] or 0.0) * np.asarray(self._lock.direction)
        else:
            shift = np.zeros(3)
            for name, value in zip(self._names, values, strict=True):
                shift["xyz".index(name)] = value or 0.0
        self._number = shift
        return RigidMotion(shift=shift)

    @property
    def _stretched(self) -> Floats:
        """(3,) 1 for axes that are scaled; a normal that is no axis counts as none."""
        direction = np.asarray(self._lock.direction)
        if self._lock.kind == "line" and self._lock.direction in AXES.values():
            return direction
        return 1.0 - direction if self._lock.kind == "plane" else np.ones(3)

    def _factor(self, pixel: Pixel) -> float:
        begin, now = (math.dist(at, self._middle) for at in (self._begin, pixel))
        spare = max(0.0, NEAREST - begin)
        return (now + spare) / (begin + spare)

    # ------------------------------------------------------------------------------------------ words

    def words(self) -> str:
        """Nothing beside the pointer: all stands in the hint."""
        return ""

    def hint(self) -> str:
        """What is done, how far, and what keys do."""
        keys = "X, Y: axis" if self._is_flat else "X, Y, Z: axis · with Shift: plane"
        if self._is_flat and self.deed == "turn":
            keys = "Ctrl: stops of 15°"
        return f"{DEEDS[self.deed]}: {self._amount()}{self._where}\n{keys} · {KEYS}"

    def _amount(self) -> str:
        if not self.typed.is_empty:
            return self.typed.words(self._names if self.deed == "move" else [""], "°" if self.deed == "turn" else "")
        if self.deed == "turn":
            return f"{self._number:.4g}°"
        if self.deed == "scale":
            return f"{self._number:.4g}"
        shift = np.asarray(self._number) * np.ones(3)
        if self._lock.kind == "line":
            return f"{float(shift @ np.asarray(self._lock.direction)):.4g}"
        return ", ".join(f"{name} {shift['xyz'.index(name)]:.4g}" for name in self._names)
