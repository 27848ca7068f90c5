"""How two maps of one source differ, triangle by triangle."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Floats, Integers


def aligned(positions: Floats, onto: Floats) -> Floats:
    """A map (n, 2) of the plane, turned and shifted so that it lies on another as well as it can.

    Where no anchors hold a map, its place and its direction mean nothing.
    """
    z, w = _complex(positions), _complex(onto)
    middle, other = z.mean(), w.mean()
    overlap = np.vdot(z - middle, w - other)
    turn = overlap / abs(overlap) if abs(overlap) > 0 else 1.0
    moved = (z - middle) * turn + other
    return np.stack([moved.real, moved.imag], axis=1)


def displacements(positions: Floats, reference: Floats, triangles: Integers) -> Floats:
    """How far the corners of each triangle (m, 3) lie from where the reference has them, on the average: (m,)."""
    distances = np.hypot(*(positions - reference).T)
    return np.asarray(distances[triangles].mean(axis=1))


def _complex(points: Floats) -> np.ndarray:
    return points[:, 0] + 1j * points[:, 1]
