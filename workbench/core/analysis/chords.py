"""The search for a chord that shows a density not to be convex."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from workbench.core.analysis.density import Density, descending
from workbench.core.arrays import Floats

READABLE = {
    2: (((1, 1), (-1, -1)), ((2, 1), (-2, -1)), ((2, 1), (6, 2)), ((1, 1), (3, 1)), ((1, 0.5), (1, 2)), ((1, 1), (-1, 1))),
    3: (
        ((1, 1, 1), (-1, -1, 1)), ((2, 1, 1), (-2, -1, 1)), ((2, 1, 1), (6, 2, 2)), ((1, 1, 1), (3, 1, 1)),
        ((1, 1, 0.5), (1, 1, 2)), ((1, 1, 1), (-1, -1, -1)), ((1, 1, 1), (-1, 1, 1)),
    ),
}  # fmt: skip
"""Chords that people can check by hand, tried first."""
WEIGHTS = (0.25, 0.5, 0.75)


@dataclass(frozen=True, eq=False)
class Chord:
    """Two matrices diag(q), one between them at `weight`, and the values of D there."""

    points: Floats
    weight: float
    values: Floats

    @property
    def height(self) -> float:
        """Height of the chord at the middle point."""
        return float((1.0 - self.weight) * self.values[0] + self.weight * self.values[2])

    def witness(self) -> dict[str, Any]:
        """What anybody can check: points and values in the order start, middle, end."""
        return {
            "points": self.points.tolist(),
            "matrices": [np.diag(q).tolist() for q in self.points],
            "values": [float(v) for v in self.values],
            "weight": self.weight,
            "chord": self.height,
        }


def violating_chord(density: Density) -> tuple[Chord | None, int]:
    """(a chord in GL(n) with D above it by more than rounding or None, how many were tried).

    Readable chords come first, then random ones that keep det > 0 at the three points, then any.
    """
    n = density.dimension
    tried = 0
    for starts, ends, weights in _families(n):
        middles = (1.0 - weights)[:, None] * starts + weights[:, None] * ends
        usable = (np.abs(middles) > 1e-6).all(axis=1)
        starts, ends, middles, weights = starts[usable], ends[usable], middles[usable], weights[usable]
        tried += len(starts)
        excess, margin = _excess(density, starts, middles, ends, weights)
        found = np.flatnonzero(excess > margin)
        if len(found):
            # The first among the readable ones; else the plainest violation.
            k = int(found[0]) if len(starts) < 100 else int(found[np.argmax((excess / np.maximum(margin, 1e-300))[found])])
            points = np.array([starts[k], middles[k], ends[k]])
            return Chord(points, float(weights[k]), density.signed(points)), tried
    return None, tried


def _excess(density: Density, starts: Floats, middles: Floats, ends: Floats, weights: Floats) -> tuple[Floats, Floats]:
    """How far D at the middle lies above the chord, and what rounding may account for; -inf where a value is not finite."""
    (a, ea), (m, em), (b, eb) = (density.with_rounding(descending(np.abs(q))) for q in (starts, middles, ends))
    with np.errstate(all="ignore"):
        excess = m - (1.0 - weights) * a - weights * b
        margin = 16.0 * (ea + em + eb) + 1e-12 * (np.abs(a) + np.abs(m) + np.abs(b))
    finite = np.isfinite(excess) & np.isfinite(margin)
    return np.where(finite, excess, -np.inf), np.where(finite, margin, np.inf)


def _families(n: int) -> list[tuple[Floats, Floats, Floats]]:
    generator = np.random.default_rng(83)
    readable = np.array([pair for pair in READABLE[n] for _ in WEIGHTS], dtype=np.float64)
    families = [(readable[:, 0], readable[:, 1], np.tile(WEIGHTS, len(READABLE[n])))]
    for even in (True, False):
        parts = []
        for reach in (0.3, 1.0, 3.0):
            for length in (0.1, 1.0, None):
                starts = np.exp(generator.uniform(-reach, reach, size=(300, n)))
                if length is None:
                    signs = generator.choice([-1.0, 1.0], size=(300, n))
                    if even:
                        signs[:, -1] = np.prod(signs[:, :-1], axis=1)
                    ends = signs * np.exp(generator.uniform(-reach, reach, size=(300, n)))
                else:
                    ends = starts * (1.0 + length * generator.normal(size=(300, n)))
                parts.append((starts, ends, generator.choice([0.5, 0.25, 0.75, 0.1, 0.9], size=300)))
        starts, ends, weights = (np.concatenate([part[i] for part in parts]) for i in range(3))
        if even:
            middles = (1.0 - weights)[:, None] * starts + weights[:, None] * ends
            keep = (np.prod(ends, axis=1) > 0) & (np.prod(middles, axis=1) > 0)
            starts, ends, weights = starts[keep], ends[keep], weights[keep]
        families.append((starts, ends, weights))
    return families
