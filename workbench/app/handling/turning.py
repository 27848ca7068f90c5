"""From a pointer that goes round a ring to an angle."""

from __future__ import annotations

import math

import numpy as np

from workbench.app.views.camera import Pixel
from workbench.core.arrays import Floats

ON_EDGE = 0.15
"""Cosine between a ring's axis and the line of sight below which the ring is a line on the screen."""
SNAP = math.radians(15.0)
"""Angle between two stops while Ctrl is held."""


class Turning:
    """Counts the angle while a pointer goes round; whole turns add up.

    Parameters
    ----------
    axis : (3,) float64       of the ring, of length 1
    axes : (3, 3) float64     of the camera, see `ViewCamera`
    centre, begin : pixels    of the ring, and where the pointer took it
    radius : float            of the ring, in pixels
    """

    def __init__(self, axis: Floats, axes: Floats, centre: Pixel, begin: Pixel, radius: float) -> None:
        self._centre, self._last, self._radius = centre, begin, radius
        self._facing = float(axis @ axes[2])
        # directions in the plane of the ring, as they lie on the screen (y downwards)
        self._screen = np.stack([axes[0], -axes[1]])
        self._u = _across(axis)
        self._v = np.cross(axis, self._u)
        self._along = self._screen @ np.cross(axis, axes[2])  # of the point of the ring that is nearest to the eye
        self.angle = 0.0

    def move(self, pixel: Pixel) -> float:
        """Radians since the begin, counter-clockwise about the axis."""
        if abs(self._facing) < ON_EDGE:  # a line on the screen: along it, a radius is a radian
            step = np.subtract(pixel, self._last)
            self.angle += float(step @ self._along) / self._radius
        else:
            change = self._angle_of(pixel) - self._angle_of(self._last)
            self.angle += (change + math.pi) % (2.0 * math.pi) - math.pi
        self._last = pixel
        return self.angle

    def _angle_of(self, pixel: Pixel) -> float:
        matrix = np.stack([self._screen @ self._u, self._screen @ self._v], axis=1)
        a, b = np.linalg.solve(matrix, np.subtract(pixel, self._centre))
        return math.atan2(b, a)


def snapped(angle: float) -> float:
    """The nearest stop."""
    return round(angle / SNAP) * SNAP


def _across(axis: Floats) -> Floats:
    """A direction (3,) of length 1 at a right angle to `axis`."""
    other = np.eye(3)[int(np.argmin(np.abs(axis)))]
    found = np.cross(axis, other)
    return np.asarray(found / np.linalg.norm(found))
