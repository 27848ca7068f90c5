"""A drag under way: from where the pointer is to the motion of the anchors that it holds."""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np

from workbench.app.handling.gizmo import RADIUS, Gizmo, Handle
from workbench.app.handling.locks import FREE, Lock, pulled
from workbench.app.handling.motion import Motion
from workbench.app.handling.rigid_motion import RigidMotion
from workbench.app.handling.turning import Turning, snapped
from workbench.app.views.camera import Pixel
from workbench.app.views.mesh_view import MeshView
from workbench.core.arrays import Floats


class Hold(Protocol):
    """What the hand has taken: `motion` is that of the anchors since then."""

    lock: Lock

    def motion(self, pixel: Pixel, *, in_stops: bool) -> Motion: ...

    def words(self) -> str:
        """What to say beside the pointer; empty where there is nothing to say."""
        ...

    def hint(self) -> str:
        """What keys do meanwhile."""
        ...


class Pull:
    """Anchors are pulled; the pointer keeps the place at which it took them."""

    takes_locks = True

    def __init__(self, view: MeshView, begin: Pixel, lock: Lock = FREE) -> None:
        self._view = view
        self._begin = begin
        self._shift = np.zeros(3)
        self.lock = lock

    def motion(self, pixel: Pixel, *, in_stops: bool = False) -> RigidMotion:
        view = self._view
        assert view.geometry_shown is not None
        size = view.size_in_pixels
        offset = view.camera.unproject(pixel, size) - view.camera.unproject(self._begin, size)
        self._shift = pulled(offset, self.lock, view.camera.axes) / view.geometry_shown.frame.scale
        return RigidMotion(shift=self._shift)

    def words(self) -> str:
        return "" if self.lock == FREE else f"{self.lock.name}: {np.linalg.norm(self._shift):.4g}"

    def hint(self) -> str:
        geometry = self._view.geometry_shown
        if geometry is not None and geometry.is_flat:
            return "X, Y: axis · Esc: back"
        return "X, Y, Z: axis · with Shift: plane · N: normal · Esc: back"


class RingTurn:
    """Anchors are turned by a ring of the gizmo; `in_stops` turns by whole stops."""

    def __init__(self, view: MeshView, begin: Pixel, gizmo: Gizmo, axis: int) -> None:
        assert view.geometry_shown is not None
        frame = view.geometry_shown.frame
        self.lock = FREE
        self._name = "xyz"[axis]
        self._axis: Floats = np.eye(3)[axis]
        self._centre = np.zeros(3)
        self._centre[: len(frame.centre)] = frame.from_display(gizmo.centre)
        x, y = view.project(gizmo.centre[None, :])[0]
        self._turning = Turning(self._axis, view.camera.axes, (x, y), begin, RADIUS)
        self._angle = 0.0

    def motion(self, pixel: Pixel, *, in_stops: bool = False) -> RigidMotion:
        angle = self._turning.move(pixel)
        self._angle = snapped(angle) if in_stops else angle
        return RigidMotion(turn=self._angle * self._axis, centre=self._centre)

    def words(self) -> str:
        return f"about {self._name}: {math.degrees(self._angle):.0f}°"

    def hint(self) -> str:
        return "Ctrl: stops of 15° · Esc: back"


def hold_of(view: MeshView, gizmo: Gizmo, handle: Handle, begin: Pixel) -> Hold:
    """What dragging a handle does."""
    if handle.kind == "ring":
        return RingTurn(view, begin, gizmo, handle.axis)
    axis = np.eye(3)[handle.axis]
    return Pull(view, begin, Lock("line", tuple(axis.tolist()), f"along {'xyz'[handle.axis]}"))
