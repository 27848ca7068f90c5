"""Limited-memory quasi-Newton directions: the last pairs of steps and gradient differences."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.descent import Derivatives

LEAST_CURVATURE = 1e-12
"""Pairs whose s.y is below this part of |s| |y| are left out: they would make the metric indefinite."""


def inner(a: Floats, b: Floats) -> float:
    """Sum of the products of all entries of two (N, d) arrays, in a fixed order."""
    return float(np.einsum("ij,ij->", a, b))


@dataclass(frozen=True, eq=False)
class Pair:
    """A step s and the difference y of the gradients at its ends, both (N, d); `scale`: a first guess s.y / y.K^-1 y."""

    step: Floats
    difference: Floats
    product: float
    scale: float = 1.0


@dataclass(frozen=True, eq=False)
class QuasiNewtonMemory(Derivatives):
    """The derivatives at the newest map and the last pairs, the oldest first."""

    pairs: tuple[Pair, ...] = ()


def make_pair(step: Floats, difference: Floats, initial: Callable[[Floats], Floats] | None = None) -> Pair | None:
    """The pair of a step, None where its curvature is not positive.

    `initial` (N, d) -> (N, d) is K^-1 of the first guess; with it the pair holds the scale that fits K^-1 to this step.
    """
    product = inner(step, difference)
    if not product > LEAST_CURVATURE * np.sqrt(inner(step, step) * inner(difference, difference)):
        return None
    scale = 1.0
    if initial is not None:
        size = inner(difference, initial(difference))
        scale = product / size if size > 0.0 else 1.0
    return Pair(step, difference, product, scale)


def quasi_newton_direction(gradient: Floats, pairs: tuple[Pair, ...], initial: Callable[[Floats], Floats]) -> Floats:
    """-H gradient, (n, d) as the gradient, by the two loops over the pairs; `initial` is the H that they begin with.

    Source: Nocedal & Wright 2006, algorithm 7.4.
    """
    left = gradient.copy()
    parts = []
    for pair in reversed(pairs):
        part = inner(pair.step, left) / pair.product
        parts.append(part)
        left -= part * pair.difference
    direction = initial(left)
    for pair, part in zip(pairs, reversed(parts), strict=True):
        direction += (part - inner(pair.difference, direction) / pair.product) * pair.step
    return -direction
