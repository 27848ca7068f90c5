"""The search for a chord that shows a density not to be convex."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from workbench.core.analysis.density import ROUNDING, Density, descending, margin
from workbench.core.arrays import Floats

READABLE = {
    2: (((2, 1), (6, 2)), ((1, 1), (3, 1)), ((1, 0.5), (1, 2)), ((1, 1), (-1, -1)), ((2, 1), (-2, -1)), ((1, 1), (-1, 1))),
    3: (
        ((2, 1, 1), (6, 2, 2)), ((1, 1, 1), (3, 1, 1)), ((1, 1, 0.5), (1, 1, 2)),
        ((1, 1, 1), (-1, -1, 1)), ((2, 1, 1), (-2, -1, 1)), ((1, 1, 1), (-1, -1, -1)), ((1, 1, 1), (-1, 1, 1)),
    ),
}  # fmt: skip
"""Chords that people can check by hand, tried first; of these, those first that stay in GL(n) all the way."""
WEIGHTS = (0.25, 0.5, 0.75)
COUNT, BEST, COPIES = 300, 40, 10
STEPS = (0.5, 0.2, 0.1, 0.05, 0.02)
"""Random chords of a kind; how many of the best are improved, by how many copies, moved how far."""
LARGE = 300
"""Nodes from which on a formula gets fewer chords, so that no text makes this slow."""

Chords = tuple[Floats, Floats, Floats]
"""Starts (k, n), ends (k, n), weights of the ends (k,)."""


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

    Readable chords come first, then random ones that keep det > 0 at the three points, then any, then the best ones improved.
    """
    n = density.dimension
    generator = np.random.default_rng(83)
    share = 1 if len(density.order) < LARGE else 4
    readable = np.array([pair for pair in READABLE[n] for _ in WEIGHTS], dtype=np.float64)
    found, tried, _ = _first(density, readable[:, 0], readable[:, 1], np.tile(WEIGHTS, len(READABLE[n])))
    starts, ends, weights = _random_chords(generator, n, COUNT // share)
    middles = _middles(starts, ends, weights)
    upright = (np.prod(starts, axis=1) > 0) & (np.prod(middles, axis=1) > 0) & (np.prod(ends, axis=1) > 0)
    for chosen in (upright, ~upright):
        if found is None:
            found, count, excess = _first(density, starts[chosen], ends[chosen], weights[chosen], plainest=True)
            tried += count
            best = np.argsort(-excess, kind="stable")[: BEST // share]
            for step in STEPS:
                if found is None:
                    near = starts[chosen][best], ends[chosen][best], weights[chosen][best]
                    found, count, _ = _first(density, *_moved(generator, near, step), plainest=True)
                    tried += count
    return found, tried


def _first(
    density: Density, starts: Floats, ends: Floats, weights: Floats, plainest: bool = False
) -> tuple[Chord | None, int, Floats]:
    """(the first or the plainest violating chord or None, how many there are, how near each is to a violation)."""
    middles = _middles(starts, ends, weights)
    a, m, b = (density.signed(q) for q in (starts, middles, ends))
    with np.errstate(all="ignore"):
        excess = m - (1.0 - weights) * a - weights * b
        nearness = np.nan_to_num(excess / (np.abs(a) + np.abs(m) + np.abs(b)), nan=-np.inf, posinf=-np.inf, neginf=-np.inf)
    singular = np.minimum(np.abs(middles), np.minimum(np.abs(starts), np.abs(ends))).min(axis=1, initial=np.inf) == 0.0
    nearness[singular] = -np.inf
    suspects = np.argsort(-nearness, kind="stable")[:BEST]
    suspects = np.sort(suspects[nearness[suspects] > ROUNDING])
    ends_and_middles = np.concatenate([q[suspects] for q in (starts, middles, ends)])
    rounding = margin(*density.with_rounding(descending(np.abs(ends_and_middles)))).reshape(3, -1).sum(axis=0)
    violates = np.zeros(len(starts), dtype=bool)
    violates[suspects] = excess[suspects] > rounding
    which = np.flatnonzero(violates)
    if not len(which):
        return None, len(starts), nearness
    k = int(which[np.argmax(nearness[which])]) if plainest else int(which[0])
    points = np.array([starts[k], middles[k], ends[k]])
    return Chord(points, float(weights[k]), density.signed(points)), len(starts), nearness


def _middles(starts: Floats, ends: Floats, weights: Floats) -> Floats:
    return (1.0 - weights)[:, None] * starts + weights[:, None] * ends


def _moved(generator: np.random.Generator, chords: Chords, step: float) -> Chords:
    """Each chord with some copies whose ends are moved a little."""
    starts, ends, weights = (np.repeat(part, COPIES, axis=0) for part in chords)
    starts = starts * np.exp(step * generator.normal(size=starts.shape))
    return starts, ends * np.exp(step * generator.normal(size=ends.shape)), weights


def _random_chords(generator: np.random.Generator, n: int, count: int) -> Chords:
    """Chords near and far, short and long, through zero, and across equal and vanishing singular values."""
    starts, ends = [], []
    for reach in (0.1, 1.0, 3.0):
        q = np.exp(generator.uniform(-reach, reach, size=(5, count, n)))
        flips = generator.choice([-1.0, 1.0], size=(count, n))
        starts += [q[0], q[0], q[1], q[2], q[3]]
        ends += [
            q[0] * (1.0 + 0.1 * generator.normal(size=(count, n))),
            q[0] * (1.0 + generator.normal(size=(count, n))),
            flips * np.exp(generator.uniform(-reach, reach, size=(count, n))),
            np.roll(q[2], 1, axis=1),  # across a tie: the same singular values in another order
            np.where(generator.random((count, n)) < 0.5, q[3], -q[3]),
        ]
        # Short chords across a vanishing singular value, and across two that are nearly equal.
        i, j = np.array([generator.permutation(n)[:2] for _ in range(count)]).T
        every, gap = np.arange(count), 10.0 ** generator.uniform(-5.0, 0.0, size=count)
        small, signs = q[4].copy(), np.ones((count, n))
        small[every, i] *= gap
        signs[every, i] = -1.0
        starts.append(small)
        ends.append(small * signs)
        close = q[4].copy()
        close[every, i] = close[every, j] * (1.0 + gap)
        swapped = close.copy()
        swapped[every, i], swapped[every, j] = close[every, j], close[every, i]
        starts.append(close)
        ends.append(swapped)
    total = count * len(starts)
    weights = generator.choice([0.5, 0.25, 0.75, 0.1, 0.9], size=total)
    scale = np.where(generator.random(total) < 0.5, 1.0, np.exp(generator.uniform(-7.0, 7.0, size=total)))[:, None]
    return scale * np.concatenate(starts), scale * np.concatenate(ends), weights
