"""Handles at the centre of the selected anchors: arrows to pull along an axis, rings to turn about one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from workbench.app.views.camera import Pixel, Size, ViewCamera
from workbench.app.views.picking import segment_distances
from workbench.core.arrays import Booleans, Floats

ARROW, RADIUS, GAP = 88.0, 62.0, 14.0
"""Pixels from the centre to the tip of an arrow, to a ring, and to where an arrow begins."""
REACH = 6.5
"""Pixels from a handle at which it is meant."""
SHORTEST = 0.22
"""An arrow that is seen shorter than this part of its length is left out: one would pull along the line of sight."""
STEPS = 64


@dataclass(frozen=True, eq=False)
class Handle:
    """One handle on the screen.

    `kind` : "arrow" or "ring";  `axis` : 0, 1, 2;  `pixels` : (p, 2) the line that is drawn;
    `is_front` : (p,) what of it lies in front of the centre
    """

    kind: str
    axis: int
    pixels: Floats
    is_front: Booleans

    def words(self) -> str:
        """What dragging it does."""
        deed = "turns about" if self.kind == "ring" else "pulls along"
        return f"{deed} {'xyz'[self.axis]}"


@dataclass(frozen=True, eq=False)
class Gizmo:
    """Handles round a `centre` (3,) of the display, along the axes of the coordinates.

    `has_rings` : there is something to turn;  `is_flat` : two arrows and one ring, for maps to the plane
    """

    centre: Floats
    has_rings: bool
    is_flat: bool

    def handles(self, camera: ViewCamera, size: Size) -> list[Handle]:
        """What is seen of it, rings first."""
        (middle,), _ = camera.project(self.centre[None, :], size)
        found = []
        if self.has_rings:
            angles = np.linspace(0.0, 2.0 * np.pi, STEPS + 1)
            for axis in (2,) if self.is_flat else range(3):
                circle = np.zeros((len(angles), 3))
                circle[:, (axis + 1) % 3], circle[:, (axis + 2) % 3] = np.cos(angles), np.sin(angles)
                found.append(_handle("ring", axis, RADIUS * circle, middle, camera))
        for axis in range(2 if self.is_flat else 3):
            direction = np.eye(3)[axis]
            if np.hypot(*(camera.axes[:2] @ direction)) >= SHORTEST:
                ends = np.array([GAP, ARROW])[:, None] * direction
                found.append(_handle("arrow", axis, ends, middle, camera))
        return found

    def handle_at(self, pixel: Pixel, camera: ViewCamera, size: Size) -> Handle | None:
        """The handle under a pointer; what lies in front wins over the far half of a ring."""
        best, least = None, REACH
        for handle in self.handles(camera, size):
            away = _distance(handle.pixels, handle.is_front, np.asarray(pixel))
            if away < least:
                best, least = handle, away
        return best


def gizmo_of(places: Floats, *, is_flat: bool) -> Gizmo | None:
    """Handles for selected anchors at `places` (k, 3) of the display; None where they would help nobody."""
    if not len(places) or (is_flat and len(places) == 1):
        return None  # a single anchor in the plane is dragged as it is
    return Gizmo(places.mean(axis=0), has_rings=len(places) > 1, is_flat=is_flat)


def _handle(kind: str, axis: int, places: Floats, middle: Floats, camera: ViewCamera) -> Handle:
    """`places` (p, 3) in pixels from the centre, in the directions of the display."""
    turned = places @ camera.axes.T
    return Handle(kind, axis, middle + turned[:, :2] * [1.0, -1.0], turned[:, 2] >= -1e-9)


def _distance(line: Floats, is_front: Booleans, pixel: Floats) -> float:
    """Pixels from a polyline; its far parts count for half of their reach."""
    away = segment_distances(np.stack([line[:-1], line[1:]], axis=1), pixel)
    return float((away * np.where(is_front[:-1] | is_front[1:], 1.0, 2.0)).min())
