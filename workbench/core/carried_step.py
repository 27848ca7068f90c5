"""Anchors that go far together carry what hangs on them along: a translation, which no linear system finds as exactly.

The Hessian vanishes on translations only up to rounding. Over many diameters that rounding, blown up by the small shift that
keeps a map with few anchors from turning freely, would turn the map instead of moving it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy

from workbench.core.arrays import Integers
from workbench.core.state import State
from workbench.core.turned_steps import walked_state

if TYPE_CHECKING:
    from workbench.core.problem import Problem

FAR = 1.0
"""Diameters of the source beyond which a way is walked so."""
ALIKE = 0.5
"""Anchors go together where none of their ways differs from the mean by more than this part of it."""


def carried_step(problem: Problem, state: State) -> State | None:
    """The state after each component was moved by the mean way of its hard anchors, where that is far and theirs alike.

    Returns None where there is no such component, where soft anchors or equations tie the map to a place, or where the map
    so far out would lose its digits.
    """
    x, hard = state.positions, problem.anchors.hard_vertices
    ways = problem.anchors.hard_targets - x[hard]
    far = FAR * problem.mesh.diameter
    if problem.constraints is not None or len(problem.anchors.soft[0]) or np.linalg.norm(ways, axis=1).max(initial=0.0) <= far:
        return None
    component = _vertex_components(problem.elements.simplices, len(x))
    candidate = x.copy()
    for number in np.unique(component[hard]):
        own = ways[component[hard] == number]
        mean = own.mean(axis=0)
        length = float(np.linalg.norm(mean))
        if length > far and np.linalg.norm(own - mean, axis=1).max() <= ALIKE * length:
            candidate[component == number] += mean
    return None if np.array_equal(candidate, x) else walked_state(problem, state, candidate)


def _vertex_components(simplices: Integers, vertex_count: int) -> Integers:
    """(N,) number of the component that each vertex is in."""
    tails, heads = np.repeat(simplices[:, 0], simplices.shape[1] - 1), simplices[:, 1:].reshape(-1)
    graph = scipy.sparse.coo_matrix((np.ones(len(tails)), (tails, heads)), shape=(vertex_count, vertex_count))
    labels: Integers = scipy.sparse.csgraph.connected_components(graph, directed=False)[1]
    return labels
