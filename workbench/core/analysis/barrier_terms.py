"""A formula without its barrier: what is left of it where a simplex is inverted (Fig. 12)."""

from __future__ import annotations

import numpy as np

from workbench.core.analysis.density import Density
from workbench.core.expression import Graph, Op
from workbench.core.tape import compile_tape

VANISHING = 1e-200
"""A singular value so small that every barrier shows."""


def without_barrier(density: Density) -> Density:
    """The formula without the parts that have a pole at a vanishing singular value.

    A sum or a max loses the terms with a pole (sum(sigma^2 + 1/sigma^2) leaves sum(sigma^2)), a fraction its denominator
    (max(sigma)/min(sigma) leaves max(sigma)); a formula of which nothing is left becomes 0.
    """
    graph = density.graph
    n = density.dimension
    points = np.ones((n, n))
    np.fill_diagonal(points, VANISHING)
    values = compile_tape(graph, density.order).evaluate(points)
    finite = {node: bool((np.abs(values[:, k]) < 1e100).all()) for k, node in enumerate(density.order)}
    left: dict[int, int | None] = {}
    for node in density.order:
        left[node] = node if finite[node] else _left(graph, node, left)
    root = left[density.root]
    return Density(graph, graph.zero if root is None else root)


def _left(graph: Graph, node: int, left: dict[int, int | None]) -> int | None:
    """What is left of a node with a pole; None where nothing is."""
    op, _, arguments = graph.nodes[node]
    parts = [left[a] for a in arguments]
    kept = [part for part in parts if part is not None]
    if op in (Op.ADD, Op.SUBTRACT, Op.MAXIMUM, Op.MINIMUM):
        if not kept:
            return None
        if len(kept) == 2:
            join = {Op.ADD: graph.add, Op.SUBTRACT: graph.subtract, Op.MAXIMUM: graph.maximum, Op.MINIMUM: graph.minimum}
            return join[op](kept[0], kept[1])
        lost_first = parts[0] is None
        return graph.subtract(graph.zero, kept[0]) if op is Op.SUBTRACT and lost_first else kept[0]
    if op is Op.DIVIDE:
        kept = kept[:1] if parts[0] is not None else []
    if op in (Op.DIVIDE, Op.MULTIPLY):
        varying = [part for part in kept if graph.constant_value(part) is None]
        if len(varying) == 2:
            return graph.multiply(varying[0], varying[1])
        scale = [part for part in kept if graph.constant_value(part) is not None]
        if not varying:
            return None
        return graph.multiply(scale[0], varying[0]) if scale else varying[0]
    if op is Op.EXP and kept:
        return graph.exp(kept[0])
    return None
