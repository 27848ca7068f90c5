"""Gradient descent of the vertices of one colour, each with a line search of its own."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Booleans, Floats, Integers
from workbench.core.solver import ROUNDING
from workbench.core.vertex_blocks import VertexBlock

if TYPE_CHECKING:
    from workbench.core.problem import Problem

SUFFICIENT = 1e-4
"""Part of the promised decrease that a vertex's step must reach (Armijo)."""
TRIALS = 10
"""Halvings of a vertex's step in one sweep; where they do not do, the next sweep goes on from the last one."""


def descend_block(
    problem: Problem,
    block: VertexBlock,
    positions: Floats,
    lengths: Floats,
    movable: Booleans,
    growth: float,
    safety: float,
    interrupt: Callable[[], bool],
) -> float | None:
    """Move each vertex of a block once along its own gradient while all others stand still.

    Parameters
    ----------
    positions : (N, d) float64     changed; no simplex is inverted by a step where inversions are forbidden
    lengths : (N,) float64         changed: the last step of each vertex, 0 where there was none
    movable : (N,) bool
    growth : float                 factor on the last step for the next first trial
    safety : float                 part of the step to the first inversion that may be taken

    Returns
    -------
    float      the decrease that the gradients promised for all first trials together; None where interrupted

    Source: Hormann & Greiner 2000; Fu, Liu, Guo 2015. Cost: O(simplices of the block) a trial.
    """
    vertices, density, count_part = block.vertices, problem.density, problem.workspace.count_part
    count_part("gradient", len(block.simplices))
    count_part("energy", len(block.simplices))
    gradient = block.gradients(density, positions) + _soft_gradients(problem, vertices, positions)
    gradient[~movable[vertices]] = 0.0
    squares = (gradient**2).sum(axis=1)
    strict = problem.forbids_inversions and problem.inverted(positions) == 0
    before = block.energies(density, positions, strict) + _soft_energies(problem, vertices, positions)
    # Nothing is known of lengths yet: no vertex moves further than a tenth of the source's diameter.
    steps = np.where(squares > 0.0, 0.1 * problem.mesh.diameter / np.sqrt(np.where(squares > 0.0, squares, 1.0)), 0.0)
    steps = np.where(lengths[vertices] > 0.0, growth * lengths[vertices], steps)
    if problem.forbids_inversions:
        steps *= np.minimum(1.0, safety * block.largest_steps(positions, -steps[:, None] * gradient))
    active = np.isfinite(squares) & np.isfinite(before) & (steps * squares > ROUNDING * np.abs(before))
    promise = float((steps * squares)[active].sum())
    looked_at = len(vertices)
    for _ in range(TRIALS):
        if not active.any():
            break
        if interrupt():
            return None
        problem.workspace.counts["trials"] += 1
        moving = vertices[active]
        candidate = positions.copy()
        candidate[moving] -= steps[active, None] * gradient[active]
        if 2 * len(moving) < looked_at:  # copying the rest costs as much as computing it
            block, looked_at = block.narrowed(active), len(moving)
        count_part("energy", len(block.simplices))
        after = block.energies(density, candidate, strict) + _soft_energies(problem, vertices, candidate)
        accepted = active & (after <= before - SUFFICIENT * steps * squares)
        positions[vertices[accepted]] = candidate[vertices[accepted]]
        lengths[moving] = steps[active]
        active &= ~accepted
        steps = np.where(active, 0.5 * steps, steps)
    return promise


def _soft_parts(problem: Problem, vertices: Integers) -> tuple[Integers, Floats, Floats]:
    """Places in `vertices` (ascending) of the soft anchors among them, their targets and weights."""
    soft, targets, weights = problem.anchors.soft
    place = np.minimum(np.searchsorted(vertices, soft), len(vertices) - 1)
    mine = vertices[place] == soft
    return place[mine], targets[mine], weights[mine]


def _soft_energies(problem: Problem, vertices: Integers, x: Floats) -> Floats:
    """(b,) penalties of the soft anchors among `vertices`."""
    place, targets, weights = _soft_parts(problem, vertices)
    result = np.zeros(len(vertices))
    result[place] = weights * ((x[vertices[place]] - targets) ** 2).sum(axis=1)
    return result


def _soft_gradients(problem: Problem, vertices: Integers, x: Floats) -> Floats:
    """(b, d) gradients of these penalties."""
    place, targets, weights = _soft_parts(problem, vertices)
    result = np.zeros((len(vertices), x.shape[1]))
    result[place] = 2.0 * weights[:, None] * (x[vertices[place]] - targets)
    return result
