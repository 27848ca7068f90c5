"""How two maps of one source differ, simplex by simplex."""

from __future__ import annotations

import numpy as np

from workbench.app.quantities.quantities import Quantity
from workbench.core.arrays import Floats, Integers


def aligned(positions: Floats, onto: Floats) -> Floats:
    """A map (n, d), turned and shifted so that it lies on another as well as it can.

    Where no anchors hold a map, its place and its direction mean nothing. The turn is that of Kabsch 1976: from the singular
    vectors of the covariance, without a reflection.
    """
    middle, other = positions.mean(axis=0), onto.mean(axis=0)
    u, _, v = np.linalg.svd((positions - middle).T @ (onto - other))
    signs = np.ones(len(middle))
    signs[-1] = np.sign(np.linalg.det(u @ v)) or 1.0
    return np.asarray((positions - middle) @ ((u * signs) @ v) + other)


def displacements(positions: Floats, reference: Floats, simplices: Integers) -> Floats:
    """How far the corners of each simplex (m, d+1) lie from where the reference has them, on the average: (m,)."""
    distances = np.linalg.norm(positions - reference, axis=1)
    return np.asarray(distances[simplices].mean(axis=1))


def displacement_from(name: str) -> Quantity:
    """How far a map lies from the one called `name`, as colours."""
    what = "part of the diameter of the source"
    return Quantity("displacement", f"Displacement from {name}", "", what, 0.0, least_span=1e-9)


def difference_to(name: str, quantity: Quantity) -> Quantity:
    """By how much a quantity differs from what it is on the map called `name`, with other colours for more and for less."""
    label = f"{quantity.title}, difference to {name}"
    return Quantity("difference", label, "", quantity.formula, None, least_span=1e-9, centre=0.0)
