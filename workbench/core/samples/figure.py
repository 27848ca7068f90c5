"""A gingerbread man: a figure in the plane that is fun to drag."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.samples.planar_region import mesh_region, trace_outline

# ends and radius of each rounded limb
_CAPSULES = (
    ((0.00, 1.42), (0.00, 1.42), 0.50),  # head
    ((0.00, 0.52), (0.00, 0.02), 0.44),  # trunk
    ((0.20, 0.58), (1.06, 0.74), 0.225),  # arms, the hands a little thicker
    ((1.10, 0.75), (1.14, 0.76), 0.255),
    ((-0.20, 0.58), (-1.06, 0.74), 0.225),
    ((-1.10, 0.75), (-1.14, 0.76), 0.255),
    ((0.20, -0.10), (0.55, -1.08), 0.255),  # legs, the feet a little thicker
    ((0.56, -1.12), (0.62, -1.14), 0.285),
    ((-0.20, -0.10), (-0.55, -1.08), 0.255),
    ((-0.56, -1.12), (-0.62, -1.14), 0.285),
)
_BLEND = 0.20
_STARTS = np.array([start for start, _, _ in _CAPSULES])
_AXES = np.array([end for _, end, _ in _CAPSULES]) - _STARTS
_LENGTHS = np.maximum(np.linalg.norm(_AXES, axis=1), 1e-12)
_RADII = np.array([radius for _, _, radius in _CAPSULES])

ANCHOR_PLACES = ((1.25, 0.79), (-1.25, 0.79), (0.62, -1.28), (-0.62, -1.28), (0.0, 1.62))
"""Hands, feet, head."""


def gingerbread(triangles: int) -> tuple[Floats, Integers]:
    """Vertices (n, 2) and about `triangles` triangles of the figure."""
    outline = trace_outline(figure_distance, (0.0, 1.92), 0.05)
    return mesh_region(figure_distance, outline, triangles)


def figure_distance(points: Floats) -> Floats:
    """Smooth union of the limbs at `points` (k, 2), or (k, 3) about the plane z = 0: about the signed distance."""
    flat = points[:, None, :2] - _STARTS
    along = np.clip(np.einsum("kci,ci->kc", flat, _AXES) / _LENGTHS**2, 0.0, 1.0)
    offset = np.repeat(points[:, None], len(_CAPSULES), axis=1)
    offset[:, :, :2] = flat - along[..., None] * _AXES
    distance = np.sqrt(np.einsum("kci,kci->kc", offset, offset)) - _RADII
    value = distance[:, 0]
    for limb in range(1, distance.shape[1]):
        value = smooth_minimum(value, distance[:, limb], _BLEND)
    return value


def smooth_minimum(first: Floats, second: Floats, blend: float) -> Floats:
    """Minimum whose crease is rounded over a width of `blend` (cubic)."""
    overlap = np.maximum(blend - np.abs(first - second), 0.0) / blend
    return np.minimum(first, second) - overlap**3 * blend / 6.0
