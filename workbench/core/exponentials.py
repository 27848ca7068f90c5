"""Logarithms of expressions that are made of exponentials: they can be computed where the exponentials overflow."""

from __future__ import annotations

import math

from workbench.core.expression import Graph, Op


def logarithm(graph: Graph, root: int) -> int | None:
    """Node of log(`root`), without the exponentials that may overflow; None where none is to be avoided.

    Exponentials, their products, quotients, powers, extremes, and sums with anything else (a blend with amips, say).
    """
    found: dict[int, int] = {}
    # A graph lists arguments before what uses them, so one pass in order needs no recursion.
    for node in graph.reachable([root]):
        exponent = _logarithm(graph, node, found)
        if exponent is not None:
            found[node] = exponent
    return found.get(root)


def _logarithm(graph: Graph, node: int, found: dict[int, int]) -> int | None:
    """log(`node`), where `found` has the logarithms of those of its arguments that are made of exponentials."""
    op, _, arguments = graph.nodes[node]
    if op is Op.EXP:
        return arguments[0]
    if not any(a in found for a in arguments):
        return None
    if op is Op.SQRT:
        return graph.multiply(graph.constant(0.5), found[arguments[0]])
    if op is Op.POWER:
        is_constant = graph.constant_value(arguments[1]) is not None
        return graph.multiply(arguments[1], found[arguments[0]]) if is_constant else None
    known = [found.get(a, _of_constant(graph, a)) for a in arguments]
    if op is Op.ADD:
        return _of_sum(graph, arguments, known)
    operation = {
        Op.MULTIPLY: graph.add,
        Op.DIVIDE: graph.subtract,
        Op.MAXIMUM: graph.maximum,
        Op.MINIMUM: graph.minimum,
    }.get(op)
    if operation is None or known[0] is None or known[1] is None:
        return None
    return operation(known[0], known[1])


def _of_constant(graph: Graph, node: int) -> int | None:
    value = graph.constant_value(node)
    return graph.constant(math.log(value)) if value is not None and value > 0.0 else None


def _of_sum(graph: Graph, terms: tuple[int, ...], known: list[int | None]) -> int:
    """log(a + b) = m + log(a/e^m + b/e^m), m the larger one of the logarithms that are known; one of them is."""
    a, b = (graph.zero if exponent is None else exponent for exponent in known)
    largest = graph.select(a, b, a, b)  # no maximum: its kink is not one of the sum
    parts = [
        graph.exp(graph.subtract(exponent, largest))
        if exponent is not None
        else graph.multiply(term, graph.exp(graph.subtract(graph.zero, largest)))
        for term, exponent in zip(terms, known, strict=True)
    ]
    return graph.add(largest, graph.log(graph.add(parts[0], parts[1])))
