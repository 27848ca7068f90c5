"""A hemisphere with fingers: a disc whose flattening is hard."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.samples.figure import smooth_minimum
from workbench.core.samples.implicit_surface import mesh_upper_surface

# angle about z, height of the direction, length, radius of each finger
_FINGERS = (
    (10, 0.62, 1.95, 0.24),
    (95, 0.50, 1.75, 0.26),
    (170, 0.72, 2.05, 0.22),
    (250, 0.45, 1.80, 0.25),
    (315, 0.95, 1.70, 0.23),
)
_SURFACE = 20.3
"""Area at spacing going to 0, for the spacing that gives a wanted number of triangles."""


def fingers(triangles: int) -> tuple[Floats, Integers]:
    """Vertices (n, 3) and about `triangles` triangles."""
    spacing = float(np.sqrt(2.0 * _SURFACE / triangles))
    return mesh_upper_surface(fingers_distance, np.array([-2.4, -2.4, 0.0]), np.array([2.4, 2.4, 2.6]), spacing)


def fingers_distance(points: Floats) -> Floats:
    """Smooth union of a ball and the fingers, mirrored at z = 0, at points (k, 3): (k,), negative inside."""
    mirrored = np.column_stack([points[:, :2], np.sqrt(points[:, 2] ** 2 + 1e-12)])
    value = np.linalg.norm(points, axis=1) - 1.0
    for degrees, height, length, radius in _FINGERS:
        angle = np.deg2rad(degrees)
        flat = np.sqrt(1.0 - height**2)
        axis = np.array([flat * np.cos(angle), flat * np.sin(angle), height])
        along = np.clip(mirrored @ axis, 0.4, length)
        value = smooth_minimum(value, np.linalg.norm(mirrored - along[:, None] * axis, axis=1) - radius, 0.3)
    return value
