"""Smoothness almost everywhere: a formula is analytic in pieces, so that only holes, jumps and poles speak against it."""

from __future__ import annotations

from typing import Any

import numpy as np

from workbench.core.analysis.density import Density, spread
from workbench.core.analysis.properties import Property, point_text
from workbench.core.arrays import Booleans, Floats
from workbench.core.expression import Op

SWITCHES = {Op.MAXIMUM: "max", Op.MINIMUM: "min", Op.ABS: "abs"}
MAXIMUM_CROSSINGS = 40
DISTANCES = np.array([1e-4, 1e-6, 1e-8])
"""How near a place is looked at from both sides, in log sigma."""


def smoothness(density: Density, kinked_at_ties: bool) -> Property:
    """Whether D is weakly differentiable.

    It is not where it is undefined or infinite on an open set, nor where it jumps or has a pole inside the cone; kinks of max,
    min and abs and at equal singular values do no harm. Holes are sought at sample points, jumps and poles where some part of
    the formula changes its sign between two of them.

    Parameters
    ----------
    kinked_at_ties : bool     whether D has kinks, as a function of the map, at equal singular values
    """
    points = spread(np.random.default_rng(15), 300, density.dimension, (0.3, 1.0, 3.0, 6.0))
    nodes = density.nodes(points)
    hole = _hole(density, nodes)
    if hole.any():
        k = int(np.argmax(hole))
        sentence = f"D is not defined at sigma = {point_text(points[k])} and near it."
        return Property(False, "numeric", sentence, {"sigma": points[k].tolist(), "value": None})
    found = _break(density, points, nodes)
    if found is not None:
        what = "has a pole" if found.pop("is_pole") else "jumps"
        return Property(False, "numeric", f"D {what} at sigma = {point_text(found['sigma'])}.", found)
    return Property(True, "both", _kinks(density, nodes, kinked_at_ties))


def _hole(density: Density, nodes: dict[int, Floats]) -> Booleans:
    """(m,) whether an operation at that point has no value, for another reason than numbers running over or under."""
    graph = density.graph
    found = np.zeros(len(nodes[density.root]), dtype=bool)
    for node in density.order:
        op, _, arguments = graph.nodes[node]
        if op not in (Op.DIVIDE, Op.POWER, Op.SQRT, Op.LOG):
            continue
        first = nodes[arguments[0]]
        if op in (Op.SQRT, Op.LOG):
            found |= (first < 0.0) & np.isfinite(first)
        if op is Op.POWER:
            found |= (first < 0.0) & np.isfinite(first) & np.isnan(nodes[node])
        # A zero that is no underflow: what subtracts or chooses can vanish on an open set.
        below = arguments[1] if op is Op.DIVIDE else arguments[0]
        if op is not Op.SQRT and graph.nodes[below][0] in (Op.ADD, Op.SUBTRACT, Op.ABS, *SWITCHES):
            found |= (nodes[below] == 0.0) & ~np.isfinite(nodes[node])
    return found


def _break(density: Density, points: Floats, nodes: dict[int, Floats]) -> dict[str, Any] | None:
    """A place where D jumps or has a pole: the point, values on both sides and which of the two it is."""
    logs = np.log(points)
    looked = 0
    for node in density.order:
        signs = np.sign(nodes[node])
        positive, negative = np.flatnonzero(signs > 0), np.flatnonzero(signs < 0)
        if density.graph.nodes[node][0] is Op.CONSTANT or not len(positive) or not len(negative):
            continue
        looked += 1
        if looked > MAXIMUM_CROSSINGS:
            return None
        # Several places, for a part of the formula may only matter on one side of a switch.
        low, high = logs[np.resize(negative, 8)], logs[np.resize(positive, 8)]
        part = Density(density.graph, node)
        for _ in range(60):
            middle = 0.5 * (low + high)
            below = part(np.exp(middle))[:, None] < 0.0
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        found = _discontinuity(density, low, logs[np.resize(positive, 8)] - logs[np.resize(negative, 8)])
        if found is not None:
            return found
    return None


def _discontinuity(density: Density, places: Floats, directions: Floats) -> dict[str, Any] | None:
    steps = DISTANCES[:, None, None] * directions / np.linalg.norm(directions, axis=1, keepdims=True)
    shape = steps.shape[:2]
    before, after = (density(np.exp((places + s * steps).reshape(-1, places.shape[1]))).reshape(shape) for s in (-1.0, 1.0))
    gap = np.abs(after - before)
    size = np.maximum(np.abs(before), np.abs(after))
    jumps = (gap[2] > 1e-3 * (1e-3 + size[0])) & (gap[2] > 0.5 * gap[1])
    # Even a logarithm grows as much from 1e-6 to 1e-8 as from 1e-4 to 1e-6.
    poles = (size[2] - size[1] > 0.8 * (size[1] - size[0])) & (size[1] - size[0] > 1e-2 * (1.0 + size[0]))
    which = np.flatnonzero(jumps | poles)
    if not len(which):
        return None
    k = int(which[0])
    values = [float(before[2, k]), float(after[2, k])]
    sides = [np.exp(places[k] + s * steps[2, k]).tolist() for s in (-1.0, 1.0)]
    return {"sigma": np.exp(places[k]).tolist(), "sides": sides, "values": values, "is_pole": bool(poles[k])}


def _kinks(density: Density, nodes: dict[int, Floats], at_ties: bool) -> str:
    used = set()
    for node in density.order:
        op, _, arguments = density.graph.nodes[node]
        if op in SWITCHES:
            gap = nodes[arguments[0]] - (nodes[arguments[1]] if len(arguments) > 1 else 0.0)
            if (gap > 0.0).any() and (gap < 0.0).any():
                used.add(SWITCHES[op])
    places = [f"where {' and '.join(sorted(used))} switch{'' if len(used) > 1 else 'es'}"] if used else []
    places += ["at equal singular values"] if at_ties else []
    return f"Analytic but for kinks {' and '.join(places)}." if places else "Analytic wherever no simplex collapses."
