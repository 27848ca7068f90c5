"""A salamander: a closed surface that lies inside the solid bar, to be carried by its maps (Fig. 8)."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.samples.figure import smooth_minimum
from workbench.core.samples.implicit_surface import mesh_upper_surface

# ends, radii at both ends, of each limb, in the frame of the bar: x along it, z up, y = 0 in its middle
_CONES = (
    ((3.30, 0.00, 0.02), (3.52, 0.00, 0.00), 0.26, 0.20),  # head
    ((2.85, 0.00, 0.02), (3.30, 0.00, 0.02), 0.24, 0.20),  # neck
    ((1.75, 0.00, 0.00), (2.85, 0.00, 0.02), 0.24, 0.27),  # trunk
    ((0.30, 0.00, -0.05), (1.75, 0.00, 0.00), 0.05, 0.22),  # tail
    ((2.72, 0.10, -0.05), (2.92, 0.34, -0.20), 0.11, 0.085),  # legs, mirrored at y = 0
    ((2.92, 0.34, -0.20), (3.08, 0.36, -0.30), 0.085, 0.09),
    ((1.92, 0.10, -0.05), (1.74, 0.34, -0.20), 0.11, 0.085),
    ((1.74, 0.34, -0.20), (1.90, 0.36, -0.30), 0.085, 0.09),
)
_BLEND = 0.12
_MIDDLE = np.array([0.0, 0.5, 0.5])
"""Where the frame above begins in the bar of length 4 with its corner at 0."""
_AREA = 7.4
"""Half of the triangles at spacing 1, by count: more than the area, since the net is oblique to the grid."""


def salamander(triangles: int) -> tuple[Floats, Integers]:
    """Vertices (n, 3) and about `triangles` triangles of the closed surface."""
    spacing = float(np.sqrt(2.0 * _AREA / triangles))
    half, simplices = mesh_upper_surface(
        lambda points: salamander_distance(points[:, [0, 2, 1]]),  # the mesher mirrors at z = 0, the animal at y = 0
        np.array([0.1, -0.5, 0.0]), np.array([3.9, 0.5, 0.5]), spacing,
    )  # fmt: skip
    half = half[:, [0, 2, 1]]
    return _with_mirror_image(half, simplices[:, ::-1])


def salamander_distance(points: Floats) -> Floats:
    """Smooth union of the limbs at `points` (k, 3): about the signed distance, negative inside."""
    mirrored = np.column_stack([points[:, 0], np.sqrt(points[:, 1] ** 2 + 1e-12), points[:, 2]])
    value = np.full(len(points), np.inf)
    for start, end, thick, thin in _CONES:
        axis = np.subtract(end, start)
        offset = mirrored - start
        along = np.clip(offset @ axis / (axis @ axis), 0.0, 1.0)
        distance = np.linalg.norm(offset - along[:, None] * axis, axis=1) - (thick + along * (thin - thick))
        value = smooth_minimum(value, distance, _BLEND) if np.isfinite(value).all() else distance
    return value


def _with_mirror_image(half: Floats, simplices: Integers) -> tuple[Floats, Integers]:
    """A half on one side of y = 0 and its image, sewn together along the vertices on that plane; then put into the bar."""
    on_plane = half[:, 1] == 0.0
    image = np.where(on_plane, np.arange(len(half)), len(half) + np.cumsum(~on_plane) - 1)
    vertices = np.vstack([half, half[~on_plane] * [1.0, -1.0, 1.0]])
    return vertices + _MIDDLE, np.vstack([simplices, image[simplices][:, ::-1]])
