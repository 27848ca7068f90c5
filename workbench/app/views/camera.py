"""A parallel camera as a value: project, pan, zoom, rotate, fit."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from workbench.core.arrays import Floats, Integers

DISTANCE = 50.0
"""Distance of the eye from the focal point, in units of the display (meshes are drawn with diameter 1)."""

FACING = 0.3
"""Length of the summed normals, of the area, from which on a surface has a front."""

FLAT = 0.55
"""A solid is flat when its thickness is at most this part of its breadth."""

Points = NDArray[np.floating[Any]]
"""(n, 3), single or double precision"""
Pixel = tuple[float, float]
Size = tuple[int, int]


def _identity() -> Floats:
    return np.eye(3)


@dataclass(frozen=True, eq=False)
class ViewCamera:
    """Parallel projection onto a widget.

    Parameters
    ----------
    focal : (3,) float64       point drawn in the middle of the widget
    axes : (3, 3) float64      rows: to the right, upwards, towards the eye; a rotation
    half_height : float        half of the visible height, in units of the display
    """

    focal: Floats = field(default_factory=lambda: np.zeros(3))
    axes: Floats = field(default_factory=_identity)
    half_height: float = 0.6

    def pixels_per_unit(self, size: Size) -> float:
        return size[1] / (2.0 * self.half_height)

    def project(self, points: Points, size: Size) -> tuple[Floats, Floats]:
        """Where points are drawn.

        Parameters
        ----------
        points : (n, 3) float
        size : (width, height) of the widget in pixels

        Returns
        -------
        (n, 2) float64    pixels, y downwards
        (n,) float64      height towards the eye: of two points at one pixel the larger one is in front
        """
        turned = (np.asarray(points, dtype=np.float64) - self.focal) @ self.axes.T
        scale = self.pixels_per_unit(size)
        pixels = np.empty((len(turned), 2))
        pixels[:, 0] = 0.5 * size[0] + scale * turned[:, 0]
        pixels[:, 1] = 0.5 * size[1] - scale * turned[:, 1]
        return pixels, turned[:, 2]

    def unproject(self, pixel: Pixel, size: Size) -> Floats:
        """Point (3,) under a pixel, on the plane through the focal point that faces the eye."""
        scale = self.pixels_per_unit(size)
        right = (pixel[0] - 0.5 * size[0]) / scale
        up = (0.5 * size[1] - pixel[1]) / scale
        return np.asarray(self.focal + right * self.axes[0] + up * self.axes[1])

    def zoomed(self, factor: float, at: Pixel, size: Size) -> ViewCamera:
        """Enlarged by `factor`; the point under the pixel `at` stays there."""
        held = self.unproject(at, size)
        half_height = float(np.clip(self.half_height / factor, 1e-7, 1e4))
        closer = replace(self, half_height=half_height)
        return replace(closer, focal=self.focal + held - closer.unproject(at, size))

    def panned(self, dx: float, dy: float, size: Size) -> ViewCamera:
        """Moved so that the drawing follows a pointer that went (dx, dy) pixels."""
        scale = self.pixels_per_unit(size)
        return replace(self, focal=self.focal + (-dx * self.axes[0] + dy * self.axes[1]) / scale)

    def rotated(self, dx: float, dy: float, size: Size) -> ViewCamera:
        """Turned about the focal point: the whole height of the widget is half a turn."""
        angle = np.pi / max(size[1], 1)
        cos_x, sin_x = np.cos(dx * angle), np.sin(dx * angle)
        cos_y, sin_y = np.cos(dy * angle), np.sin(dy * angle)
        about_up = np.array([[cos_x, 0.0, sin_x], [0.0, 1.0, 0.0], [-sin_x, 0.0, cos_x]])
        about_right = np.array([[1.0, 0.0, 0.0], [0.0, cos_y, -sin_y], [0.0, sin_y, cos_y]])
        turned = about_right @ about_up @ self.axes
        # many small turns drift away from a rotation; the nearest one is put in their place
        u, _, v = np.linalg.svd(turned)
        return replace(self, axes=np.ascontiguousarray(u @ v))

    def fitted(self, points: Points, size: Size, margin: float = 1.12) -> ViewCamera:
        """The same direction of sight with all `points` (n, 3) in the widget."""
        if not len(points):
            return self
        turned = np.asarray(points, dtype=np.float64) @ self.axes.T
        low, high = turned.min(axis=0), turned.max(axis=0)
        if not np.isfinite(low).all() or not np.isfinite(high).all():
            return self
        width, height = high[0] - low[0], high[1] - low[1]
        aspect = size[0] / max(size[1], 1)
        half_height = 0.5 * margin * max(height, width / max(aspect, 1e-6), 1e-7)
        return replace(self, focal=0.5 * (low + high) @ self.axes, half_height=float(half_height))

    def apply_to(self, camera: Any) -> None:
        """Write this view into a VTK camera."""
        camera.SetParallelProjection(True)
        camera.SetFocalPoint(*self.focal)
        camera.SetPosition(*(self.focal + DISTANCE * self.axes[2]))
        camera.SetViewUp(*self.axes[1])
        camera.SetParallelScale(self.half_height)
        camera.SetClippingRange(0.1, 2.0 * DISTANCE)


def slanted_axes() -> Floats:
    """Axes for a first look at a surface in space: from above the front right corner, z upwards."""
    return _axes(np.array([0.45, -0.8, 0.4]), np.array([0.0, 0.0, 1.0]))


def axes_for_solid(points: Points) -> Floats:
    """Axes for a first look at a solid: from a corner, or, at one that is flat, a little from the side of its broad face."""
    extent = np.ptp(np.asarray(points, dtype=np.float64), axis=0)
    thinnest, next_thinnest = np.argsort(extent, kind="stable")[:2]
    if extent[thinnest] > FLAT * extent[next_thinnest]:
        return slanted_axes()
    towards, upwards = np.eye(3)[thinnest], np.eye(3)[1 if thinnest == 2 else 2]
    return _a_little_aside(_axes(towards, upwards))


def axes_that_face(points: Points, triangles: Integers) -> Floats:
    """Axes for a first look at an open surface: a little from the side of its mean normal, y upwards where that can be.

    A surface that turns to all sides alike has no mean normal to speak of, and is looked at from a corner.
    """
    corners = np.asarray(points, dtype=np.float64)[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    mean, total = normals.sum(axis=0), np.linalg.norm(normals, axis=1).sum()
    length = float(np.linalg.norm(mean))
    if not length > FACING * total:
        return slanted_axes()
    upwards = np.array([0.0, 1.0, 0.0] if abs(mean[1]) < 0.9 * length else [0.0, 0.0, 1.0])
    return _a_little_aside(_axes(mean, upwards))


def _a_little_aside(straight: Floats) -> Floats:
    """Axes that look from the upper right of those that look straight on."""
    return _axes(np.array([0.4, 0.25, 1.0]) @ straight, straight[1])


def _axes(towards: Floats, upwards: Floats) -> Floats:
    """Axes that look from `towards` with `upwards` as far up as it goes."""
    towards = towards / np.linalg.norm(towards)
    right = np.cross(upwards, towards)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(towards, right), towards])
