"""Normalisation (21): D takes its least value at (1, ..., 1)."""

from __future__ import annotations

import numpy as np

from workbench.core.analysis.density import ROUNDING, Density, descending, margin, spread
from workbench.core.analysis.log_convexity import is_proved_log_convex
from workbench.core.analysis.normal_form import NormalForms
from workbench.core.analysis.properties import Property, point_text
from workbench.core.arrays import Floats

REACH = np.log(1e6)
"""The search covers singular values from 1e-6 to 1e6."""
ROUNDS = 24
SURVIVORS = 24


def normalisation(density: Density) -> Property:
    """Whether D(1, ..., 1) is the minimum: a search from many starts for a point with a smaller value."""
    n = density.dimension
    ones = np.ones((1, n))
    at_ones = float(density(ones)[0])
    candidates = _candidates(n)
    values = density(candidates)
    best = _descend(density, candidates, values)
    suspects = np.concatenate([candidates[values < at_ones - ROUNDING * abs(at_ones)][:SURVIVORS], best[None]])
    found, tolerance = density(suspects), margin(*density.with_rounding(suspects)) + margin(*density.with_rounding(ones))
    lower = np.flatnonzero(found < at_ones - tolerance)
    if len(lower):
        return _violation(density, suspects[lower[0]], at_ones)
    if np.isfinite(values).all() and np.ptp(values) <= 2.0 * tolerance.max():
        return Property(None, "", "D varies by no more than rounding: nothing can be said of its minimum.", value=at_ones)
    proof = _proof(density, at_ones)
    if proof:
        return Property(True, "both", f"D(1, ..., 1) = {at_ones:.6g} is the minimum: {proof}.", value=at_ones)
    sentence = f"D(1, ..., 1) = {at_ones:.6g} is the least value found between 1e-6 and 1e6."
    return Property(True, "numeric", sentence, value=at_ones)


def _proof(density: Density, at_ones: float) -> str:
    """Why D(1, ..., 1) is the minimum although only some points were looked at; empty where no rule says so."""
    if at_ones == 0.0 and NormalForms(density.graph, density.order).nonnegative[density.root]:
        return "D is nowhere negative"
    if is_proved_log_convex(density):
        return "D is convex in log sigma, and falls from there in no direction that was tried"
    return ""


def _violation(density: Density, sigma: Floats, at_ones: float) -> Property:
    value = float(density(sigma[None])[0])
    sentence = f"D{point_text(sigma)} = {value:.6g} is less than D(1, ..., 1) = {at_ones:.6g}."
    witness = {"sigma": sigma.tolist(), "value": value, "value_at_ones": at_ones}
    return Property(False, "numeric", sentence, witness, value=at_ones)


def _candidates(n: int) -> Floats:
    """Readable points first, then similarities, then random points near and far."""
    simple = [[0.5] * n, [2.0] * n, [2.0, 1.0, 1.0][:n], [1.0, 0.5, 0.5][:n], [2.0, 1.0, 0.5][-n:], [2.0, 0.5, 0.5][:n]]
    similar = np.exp(np.linspace(-REACH, REACH, 241))[:, None] * np.ones(n)
    generator = np.random.default_rng(21)
    return np.concatenate([descending(np.array(simple)), similar, spread(generator, 300, n, (0.01, 0.1, 1.0, 3.0, REACH))])


def _descend(density: Density, points: Floats, values: Floats) -> Floats:
    """The best point after a random search round the best of `points` with shrinking steps, in log sigma."""
    generator = np.random.default_rng(12)
    order = np.argsort(np.where(np.isfinite(values), values, np.inf), kind="stable")[:SURVIVORS]
    logs, best = np.log(points[order]), values[order]
    step = 1.0
    for _ in range(ROUNDS):
        moves = step * generator.normal(size=(8, *logs.shape))
        trials = np.clip(logs + moves, -REACH, REACH)
        found = density(descending(np.exp(trials.reshape(-1, logs.shape[1])))).reshape(8, -1)
        found = np.where(np.isfinite(found), found, np.inf)
        which = np.argmin(found, axis=0)
        least = found[which, np.arange(len(best))]
        better = least < best
        logs = np.where(better[:, None], -np.sort(-trials[which, np.arange(len(best))], axis=1), logs)
        best = np.where(better, least, best)
        if not better.any():
            step *= 0.5
    best = np.where(np.isfinite(best), best, np.inf)
    result: Floats = np.exp(logs[int(np.argmin(best))])
    return result
