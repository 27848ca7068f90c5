"""Symmetry under inversion (22): D(sigma_1, ..., sigma_n) = D(1/sigma_n, ..., 1/sigma_1)."""

from __future__ import annotations

import numpy as np

from workbench.core.analysis.density import Density, spread
from workbench.core.analysis.identity import is_proved_symmetric
from workbench.core.analysis.properties import Property, point_text
from workbench.core.arrays import Floats

SIMPLE = ((2.0, 1.0, 1.0), (2.0, 2.0, 1.0), (3.0, 2.0, 1.0), (1.0, 0.5, 0.5), (2.0, 1.0, 0.25), (4.0, 3.0, 2.0))
"""Points that make readable witnesses, tried first (n = 2: the first two entries)."""


def symmetry(density: Density) -> Property:
    """Whether D is the same for a map and its inverse: searched for a point of difference, then proved as an identity."""
    n = density.dimension
    simple = np.array([point[:n] for point in SIMPLE])
    generator = np.random.default_rng(22)
    points = np.concatenate([simple, spread(generator, 400, n, (0.3, 1.0, 3.0, 8.0))])
    values, errors = density.with_rounding(points)
    mirrored, mirrored_errors = density.with_rounding(inverse(points))
    with np.errstate(all="ignore"):
        differs = np.abs(values - mirrored) > 16.0 * (errors + mirrored_errors) + 1e-12 * (np.abs(values) + np.abs(mirrored))
    usable = np.isfinite(values) & np.isfinite(mirrored)
    found = np.flatnonzero(differs & usable)
    if len(found):
        k = int(found[0])
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
    if np.ptp(values[usable]) <= 16.0 * errors[usable].max():
        return Property(None, "", "D varies by no more than rounding: nothing can be said of its symmetry.")
    if is_proved_symmetric(density):
        return Property(True, "both", f"The same for a map and its inverse: an identity, seen at {count} points too.")
    return Property(True, "numeric", f"The same for a map and its inverse, at {count} points.")


def inverse(sigma: Floats) -> Floats:
    """Singular values of the inverse map, descending again."""
    return 1.0 / np.asarray(sigma, dtype=np.float64)[..., ::-1]
