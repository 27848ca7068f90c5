"""Paths to the boundary of the cone of singular values, and whether D grows without bound along them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from workbench.core.analysis.density import Density, descending
from workbench.core.arrays import Floats

DEPTHS = np.array([2.0, 4.0, 8.0, 16.0, 32.0, 64.0])
"""log t at which a path sigma_i = c_i t^(a_i) is looked at; doubled each time, so that a logarithm doubles too."""
SLOPES = (0.0, 0.25, 1 / 3, 0.5, 2 / 3, 0.75, 1.0, 4 / 3, 1.5, 2.0, 3.0, 4.0, 8.0)
"""How fast the free singular values go, against the one that vanishes or grows."""

Side = Literal["bottom", "top"]
NEAR = 0.4
"""Bound of the other extreme singular value in the valleys: sigma_1 >= 0.4 at the bottom, sigma_n <= 1/0.4 at the top."""
STARTS, COPIES, ROUNDS = 16, 8, 30


@dataclass(frozen=True, eq=False)
class Paths:
    """sigma_i = factors_i * t^(exponents_i) as t -> inf; both (k, n), the readable ones first."""

    exponents: Floats
    factors: Floats

    def points(self, log_t: float) -> Floats:
        """(k, n) singular values at one t."""
        result: Floats = self.factors * np.exp(self.exponents * log_t)
        return result

    def distinct(self) -> list[tuple[list[float], list[float]]]:
        """(exponents, factors) of the paths with the first factors, for what depends on the exponents alone."""
        count = int((self.factors == self.factors[0]).all(axis=1).sum())
        return list(zip(self.exponents[:count].tolist(), self.factors[:count].tolist(), strict=True))


def bottom_paths(n: int) -> Paths:
    """sigma_n -> 0 while sigma_1 stays or grows (23)."""
    return _paths([(first, *rest) for first, *rest in _between(n)])


def top_paths(n: int) -> Paths:
    """sigma_1 -> inf while sigma_n stays or vanishes (24): the bottom paths turned round."""
    return _paths([tuple(-e for e in reversed(path)) for path in _between(n)])


def _between(n: int) -> list[tuple[float, ...]]:
    """Exponents (a_1 >= ... >= a_n) with a_n = -1 and a_1 >= 0."""
    paths: list[tuple[float, ...]] = []
    for first in SLOPES:
        if n == 2:
            paths.append((first, -1.0))
            continue
        middles = {-1.0, first, 0.0, *(s for s in SLOPES if s < first), *(-s for s in SLOPES if s < 1), 0.5 * (first - 1.0)}
        paths += [(first, middle, -1.0) for middle in sorted(middles, key=lambda m: (abs(m), m))]
    return paths


def _paths(exponents: list[tuple[float, ...]]) -> Paths:
    a = np.array(exponents)
    n = a.shape[1]
    # Equal factors meet the ties, others do not.
    choices = [np.ones(n), np.linspace(1.7, 0.6, n), np.full(n, 3.0), np.full(n, 0.4)]
    return Paths(np.concatenate([a] * len(choices)), np.concatenate([np.tile(c, (len(a), 1)) for c in choices]))


def grows(values: Floats) -> Floats:
    """Whether each row of values at `DEPTHS` tends to infinity, as far as numbers tell: 1.0 yes, 0.0 no, NaN untold.

    Parameters
    ----------
    values : (k, depths) float64     infinite once it overflows; NaN where the arithmetic gives up
    """
    verdict = np.full(len(values), np.nan)
    for k, row in enumerate(values):
        usable = row if not np.isnan(row).any() else row[: int(np.argmax(np.isnan(row)))]
        if len(usable) and usable[-1] == np.inf:
            verdict[k] = 1.0
        elif len(usable) >= 4:
            rise = np.diff(usable)
            scale = max(float(np.abs(usable).max()), 1.0)
            # Depth doubles: even a logarithm of a logarithm keeps its increments, what converges loses them.
            verdict[k] = float(rise[-1] > 1e-12 * scale and rise[-1] >= 0.7 * rise[-2] and usable[-1] >= usable.max())
    return verdict


def values_along(density: Density, paths: Paths) -> Floats:
    """(k, depths) values of D."""
    return np.column_stack([density(paths.points(depth)) for depth in DEPTHS])


def bounded_valley(density: Density, paths: Paths, side: Side) -> Floats | None:
    """Points with the least D found at each depth, where those values stay bounded: (depths, n), else None.

    sigma_n (or sigma_1) is held at exp(-+depth) and D is minimised over the others, which also follows valleys that no power
    of t does.
    """
    generator = np.random.default_rng(23)
    n = density.dimension
    column, sign = (n - 1, -1.0) if side == "bottom" else (0, 1.0)
    points, least = [], []
    logs = np.empty((0, n))
    for depth in DEPTHS:
        starts = np.concatenate([np.log(paths.points(depth)), 2.0 * logs, logs])
        logs, best = _descended(density, generator, starts, column, sign * depth, sign)
        points.append(np.exp(logs[0]))
        least.append(best)
        if not np.isfinite(best):
            break
    usable = [value for value in least if np.isfinite(value)]
    if len(usable) < 4:
        return None
    rise = np.diff(usable)
    scale = max(abs(value) for value in usable) + 1e-300
    is_flat = rise[-1] <= 1e-12 * scale or rise[-1] <= 0.2 * rise[-2]
    return np.array(points[: len(usable)]) if is_flat else None


def _descended(
    density: Density, generator: np.random.Generator, logs: Floats, column: int, level: float, sign: float
) -> tuple[Floats, float]:
    """(log sigma of the best points, best first; the least value), by random moves with shrinking steps."""
    logs = _kept(logs, column, level, sign)
    values = _finite(density, logs)
    order = np.argsort(values, kind="stable")[:STARTS]
    logs, values = logs[order], values[order]
    step = 2.0
    for _ in range(ROUNDS):
        trials = np.repeat(logs, COPIES, axis=0)
        trials = _kept(trials + step * generator.normal(size=trials.shape), column, level, sign)
        found = _finite(density, trials).reshape(len(logs), COPIES)
        which = found.argmin(axis=1)
        better = found.min(axis=1) < values
        chosen = trials.reshape(len(logs), COPIES, -1)[np.arange(len(logs)), which]
        logs = np.where(better[:, None], chosen, logs)
        values = np.minimum(values, found.min(axis=1))
        if better.mean() < 0.25:
            step *= 0.5
    order = np.argsort(values, kind="stable")
    return logs[order], float(values[order[0]])


def _kept(logs: Floats, column: int, level: float, sign: float) -> Floats:
    """Logarithms with the one at `column` held at `level`, the others inside their bounds, descending."""
    held = logs.copy()
    held[:, column] = level
    held = np.maximum(held, level) if sign < 0.0 else np.minimum(held, level)
    held = descending(held)
    other = 0 if column else -1
    bound = np.log(NEAR)
    held[:, other] = np.maximum(held[:, other], bound) if sign < 0.0 else np.minimum(held[:, other], -bound)
    return held


def _finite(density: Density, logs: Floats) -> Floats:
    with np.errstate(over="ignore"):
        values = density(np.exp(logs))
    return np.where(np.isnan(values), np.inf, values)
