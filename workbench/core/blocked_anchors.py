"""Anchors that cannot go on do not hold the others: what the step bound all but stops waits, and the rest is pushed without it.

All anchors are pushed at once, so that one behind an obstacle, whose simplices are about to invert, would shorten the step of
every other one to nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.line_search import largest_step

if TYPE_CHECKING:
    from workbench.core.problem import Problem

BOUNDARY_PART = 0.6
"""Part of the largest step without inversion that anchors may push: what is left lets the next correction push back."""
BLOCKED = 0.02
"""Part of the way below which a push counts as stopped by the step bound."""
MOST_WAITING = 4
"""Groups that are told to wait, one after the other, before the push is taken as it is."""


def bounded_push(problem: Problem, x: Floats, direction: Floats) -> tuple[float, int]:
    """First step of a push, at most 1, and the simplex that bounds it (-1 where none does)."""
    if problem.forbids_inversions:
        bound, simplex = largest_step(x, direction, problem.elements.simplices)
        if BOUNDARY_PART * bound < 1.0:
            return BOUNDARY_PART * bound, simplex
    return 1.0, -1


def unblocked(
    problem: Problem,
    x: Floats,
    displacement: Floats,
    direction: Floats,
    groups: list[Integers],
    follow: Callable[[Floats], Floats | None],
) -> tuple[Floats, Floats]:
    """The displacement of the hard anchors, and the direction of the map for it, without the groups that are blocked.

    Parameters
    ----------
    displacement : (k, d) float64     where all of them would go
    direction : (N, d) float64        how the map would follow
    groups : list of (j,) int64       rows of the anchors that move together
    follow : callable                 how the map follows another displacement (k, d); None where that is not known

    Returns
    -------
    (k, d), (N, d) float64      as given where nothing is blocked, or where everything is
    """
    going = [rows for rows in groups if np.abs(displacement[rows]).max(initial=0.0) > problem.anchor_tolerance]
    if len(going) < 2:
        return displacement, direction
    size, simplex = bounded_push(problem, x, direction)
    places = x[problem.anchors.hard_vertices]
    rest = displacement
    for _ in range(MOST_WAITING):
        if size >= BLOCKED or len(going) < 2:
            break
        corners = x[problem.elements.simplices[simplex]]
        waiting = going.pop(int(np.argmin([_distance(places[rows], corners) for rows in going])))
        rest = rest.copy()
        rest[waiting] = 0.0
        other = follow(rest)
        if other is None or not np.isfinite(other).all():
            break
        size, simplex = bounded_push(problem, x, other)
        if size >= BLOCKED:
            return rest, other
    return displacement, direction


def _distance(points: Floats, others: Floats) -> float:
    """Smallest distance between two sets of points."""
    return float(np.linalg.norm(points[:, None] - others[None], axis=2).min())
