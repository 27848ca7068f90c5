"""What holds a pointer that pulls an anchor in space: the plane of the view, an axis, a plane, or a normal."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from workbench.core.arrays import Floats

ALONG_SIGHT = 0.02
"""Squared sine of the angle with the line of sight below which a line is seen as a point: it is pulled up and down then."""
ON_EDGE = 0.08
"""Cosine of the angle with the line of sight below which a plane is seen as a line, and cannot be pointed into."""
AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


@dataclass(frozen=True)
class Lock:
    """`kind` : "free", "line" or "plane";  `direction` : of the line, or normal to the plane, of length 1"""

    kind: str = "free"
    direction: tuple[float, ...] = (0.0, 0.0, 1.0)
    name: str = ""


FREE = Lock()


def toggled(lock: Lock, wanted: Lock) -> Lock:
    """The lock after its key was pressed: once more frees it."""
    return FREE if lock == wanted else wanted


def axis_lock(name: str, *, plane: bool = False) -> Lock:
    """Along the axis x, y or z, or in the plane across it."""
    if not plane:
        return Lock("line", AXES[name], f"along {name}")
    return Lock("plane", AXES[name], "in the plane " + "".join(other for other in AXES if other != name))


def normal_lock(normal: Floats) -> Lock:
    """Along a normal (3,) of any length but 0."""
    unit = np.asarray(normal, dtype=np.float64) / np.linalg.norm(normal)
    return Lock("line", tuple(unit.tolist()), "along the normal")


def pulled(offset: Floats, lock: Lock, axes: Floats) -> Floats:
    """Where a pull goes that would be `offset` in the plane of the view.

    Parameters
    ----------
    offset : (3,) float64     in the plane of the view
    axes : (3, 3) float64     rows to the right, upwards, towards the eye, see `ViewCamera`

    Returns
    -------
    (3,) float64     the point of the line that is nearest to the ray under the pointer, or where that ray meets the plane
    """
    sight, direction = axes[2], np.asarray(lock.direction)
    if lock.kind == "line":
        across = 1.0 - float(direction @ sight) ** 2
        if across < ALONG_SIGHT:  # the line is a point here: up is forth
            return np.asarray(direction * float(offset @ axes[1]) * np.sign(direction @ sight or 1.0))
        return np.asarray(direction * (float(offset @ direction) / across))
    if lock.kind == "plane":
        facing = float(direction @ sight)
        if abs(facing) < ON_EDGE:
            return np.asarray(offset - direction * float(offset @ direction))
        return np.asarray(offset - sight * (float(offset @ direction) / facing))
    return offset
