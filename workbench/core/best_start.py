"""The best of several starts: each at the scale that suits the distortion, the one of least energy wins."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.errors import WorkbenchError
from workbench.core.jacobians import determinants
from workbench.core.problem import Problem

REACH = 1e3
"""A start may be scaled by this factor, up or down, from where its mean singular value is 1."""
SAMPLES = 25
"""Scales that are tried before the search narrows down."""
PRECISION = 1e-3
"""Relative, of the scale: the minimum is flat."""
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)


@dataclass(frozen=True, eq=False)
class Candidate:
    """One start: `positions` (N, d) as scaled, the `scale` that was applied, `energy` (inf where not allowed), `inverted`."""

    id: str
    positions: Floats = field(repr=False)
    scale: float
    energy: float
    inverted: int


def best_start(problem: Problem, starts: Mapping[str, Floats]) -> tuple[Candidate, ...]:
    """The starts at their best scale, the best first: fewest inverted simplices, then the least energy.

    Parameters
    ----------
    problem : Problem            with anchors, starts stay where they are: their scale is that of the targets
    starts : id -> (N, d)        at least one; of equal ones, the first in the mapping wins

    Raises `WorkbenchError` where there is none.
    """
    if not starts:
        raise WorkbenchError("None of the initializers makes a start for this mesh; name one of your own.")
    candidates = [_candidate(problem, id, np.ascontiguousarray(start, dtype=np.float64)) for id, start in starts.items()]
    return tuple(sorted(candidates, key=lambda c: (c.inverted, c.energy)))


def _candidate(problem: Problem, id: str, start: Floats) -> Candidate:
    scale = best_scale(problem, start) if not len(problem.anchors.vertices) else 1.0
    positions = start * scale
    energy = problem.evaluate(positions, 1).energy
    return Candidate(id, positions, scale, energy if math.isfinite(energy) else math.inf, problem.inverted(positions))


def best_scale(problem: Problem, positions: Floats) -> float:
    """Factor on `positions` (N, d) at which the energy is least; 1 where no factor within reach gains anything.

    The energy of a scaled map is sampled between 1 / `REACH` and `REACH` about the scale at which the mean of the logarithms of
    the singular values is 0, then narrowed down by golden sections. A minimum at an end of that range is none: the energy of
    a distortion without one, such as (25), is least for the smallest map of all. Cost: about 40 evaluations of the energy.
    """

    def energy(logarithm: float) -> float:
        value, _ = problem.density.value(positions * math.exp(logarithm))
        return value if math.isfinite(value) else math.inf

    centre = _balance(problem, positions)
    if not math.isfinite(centre):
        return 1.0
    samples = centre + np.linspace(-math.log(REACH), math.log(REACH), SAMPLES)
    values = [energy(s) for s in samples]
    best = int(np.argmin(values))
    if not math.isfinite(values[best]) or best in (0, SAMPLES - 1):
        return 1.0
    low, high = float(samples[best - 1]), float(samples[best + 1])
    left, right = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
    at_left, at_right = energy(left), energy(right)
    while high - low > PRECISION:
        if at_left <= at_right:
            high, right, at_right = right, left, at_left
            left = high - GOLDEN * (high - low)
            at_left = energy(left)
        else:
            low, left, at_left = left, right, at_right
            right = low + GOLDEN * (high - low)
            at_right = energy(right)
    found = 0.5 * (low + high)
    gain = energy(0.0) - energy(found)
    return math.exp(found) if not gain <= 1e-6 * abs(energy(found)) else 1.0


def _balance(problem: Problem, positions: Floats) -> float:
    """Logarithm of the factor that brings the weighted mean of log |det J| to 0."""
    elements = problem.elements
    sizes = np.abs(determinants(elements, positions))
    usable = sizes > 0.0
    if not usable.any():
        return math.inf
    weights = elements.rest_measures[usable]
    return float(-(weights @ np.log(sizes[usable])) / weights.sum() / elements.dimension)
