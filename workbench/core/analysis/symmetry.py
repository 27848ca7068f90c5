"""Symmetry under inversion (22): D(sigma_1, ..., sigma_n) = D(1/sigma_n, ..., 1/sigma_1)."""

from __future__ import annotations

import numpy as np

from workbench.core.analysis.density import ROUNDING, Density, margin, spread
from workbench.core.analysis.identity import is_proved_symmetric
from workbench.core.analysis.properties import Property, point_text
from workbench.core.arrays import Floats

SIMPLE = ((2.0, 1.0, 1.0), (2.0, 2.0, 1.0), (3.0, 2.0, 1.0), (1.0, 0.5, 0.5), (2.0, 1.0, 0.25), (4.0, 3.0, 2.0))
"""Points that make readable witnesses, tried first (n = 2: the first two entries)."""

SUSPECTS = 32
"""How many points are looked at with their rounding."""


def symmetry(density: Density) -> Property:
    """Whether D is the same for a map and its inverse: searched for a point of difference, then proved as an identity."""
    n = density.dimension
    simple = np.array([point[:n] for point in SIMPLE])
    generator = np.random.default_rng(22)
    points = np.concatenate([simple, spread(generator, 400, n, (0.3, 1.0, 3.0, 8.0))])
    values, mirrored = density(points), density(inverse(points))
    usable = np.isfinite(values) & np.isfinite(mirrored)
    gap = np.where(usable, np.abs(values - mirrored), 0.0) / np.where(usable, np.abs(values) + np.abs(mirrored) + 1e-300, 1.0)
    # Readable points first, then those that differ most.
    suspects = np.array(
        [k for k in (*range(len(simple)), *np.argsort(-gap, kind="stable")[:SUSPECTS]) if gap[k] > ROUNDING], dtype=int
    )
    pairs = np.concatenate([points[suspects], inverse(points[suspects])])
    tolerance = margin(*density.with_rounding(pairs)).reshape(2, -1).sum(axis=0)
    for k in suspects[np.abs(values - mirrored)[suspects] > tolerance]:
        witness = {
            "sigma": points[k].tolist(),
            "inverse": inverse(points[k]).tolist(),
            "value": float(values[k]),
            "value_at_inverse": float(mirrored[k]),
        }
        sentence = (
            f"D{point_text(points[k])} = {values[k]:.6g}, but D{point_text(inverse(points[k]))} = {mirrored[k]:.6g}: "
            "a map and its inverse are not measured alike."
        )
        return Property(False, "numeric", sentence, witness)
    count = int(usable.sum())
    if not count:
        return Property(None, "", "No point was found at which D is finite for a map and its inverse.")
    some = points[usable][:: max(1, count // SUSPECTS)]
    if np.ptp(values[usable]) <= 2.0 * margin(*density.with_rounding(some)).max():
        return Property(None, "", "D varies by no more than rounding: nothing can be said of its symmetry.")
    if is_proved_symmetric(density):
        return Property(True, "both", f"The same for a map and its inverse: an identity, seen at {count} points too.")
    return Property(True, "numeric", f"The same for a map and its inverse, at {count} points.")


def inverse(sigma: Floats) -> Floats:
    """Singular values (..., n) of the inverse map, descending again."""
    return 1.0 / np.asarray(sigma, dtype=np.float64)[..., ::-1]
