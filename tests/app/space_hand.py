"""A mouse over a solid: whole faces, and the rings of the gizmo."""

from __future__ import annotations

import math

import numpy as np
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest

from tests.app.conftest import Hand
from workbench.app.main_window import MainWindow


def middle_of_face(window: MainWindow, axis: int, side: int) -> QPoint:
    """Where the middle of a side of the box-shaped source is drawn in the target, before anything moved."""
    view = window.target.view
    points = view.geometry_shown.points
    edge = points[:, axis].max() if side > 0 else points[:, axis].min()
    x, y = view.project(points[points[:, axis] == edge].mean(axis=0)[None])[0]
    return QPoint(round(x), round(y))


def facing_sides(window: MainWindow) -> list[tuple[int, int]]:
    """(axis, side) of the faces of the source that the target's camera sees, the one it sees best first."""
    sight = window.target.view.camera.axes[2]
    return [(int(axis), 1 if sight[axis] > 0 else -1) for axis in np.argsort(-np.abs(sight))]


def face_of(window: MainWindow, axis: int, side: int) -> np.ndarray:
    along = window.document.mesh.vertices[:, axis]
    return np.flatnonzero(along == (along.max() if side > 0 else along.min()))


def anchor_face(window: MainWindow, number: int = 0) -> np.ndarray:
    axis, side = facing_sides(window)[number]
    QTest.mouseClick(
        window.target.view.overlay,
        Qt.MouseButton.LeftButton,
        Qt.KeyboardModifier.AltModifier,
        middle_of_face(window, axis, side),
    )
    return face_of(window, axis, side)


def turn_by_ring(window: MainWindow, axis: int, degrees: int) -> float:
    """Drag the point of a ring that is farthest in front round by an angle; returns it in radians."""
    view = window.target.view
    gizmo = view.overlay.scene.gizmo
    (ring,) = (h for h in gizmo.handles(view.camera, view.size_in_pixels) if (h.kind, h.axis) == ("ring", axis))
    count = len(ring.pixels) - 1
    places = [QPoint(*np.round(p).astype(int).tolist()) for p in ring.pixels[:-1]]
    others = [h.pixels for h in gizmo.handles(view.camera, view.size_in_pixels) if (h.kind, h.axis) != ("ring", axis)]
    clear = np.min([np.linalg.norm(ring.pixels[:-1, None] - pixels[None], axis=2).min(axis=1) for pixels in others], axis=0)
    begin = int(np.argmax(np.where(ring.is_front[:-1], clear, 0.0)))
    hand = Hand(view)
    hand.press(places[begin])
    steps = round(count * degrees / 360)
    for step in range(1, steps + 1):
        hand.move(places[(begin + step) % count])
        QTest.qWait(17)
    hand.release(places[(begin + steps) % count])
    return 2.0 * math.pi * steps / count
