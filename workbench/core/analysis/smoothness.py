"""Smoothness almost everywhere: defined on almost all singular values, and the places of the kinks."""

from __future__ import annotations

import numpy as np

from workbench.core.analysis.density import Density, spread
from workbench.core.analysis.properties import Property, point_text
from workbench.core.expression import Op


def smoothness(density: Density) -> Property:
    """Whether D is weakly differentiable: a formula is analytic in pieces, so it is unless it is undefined on an open set."""
    n = density.dimension
    points = spread(np.random.default_rng(15), 400, n, (0.3, 1.0, 3.0, 6.0))
    values = density(points)
    undefined = np.flatnonzero(np.isnan(values))
    if len(undefined):
        k = int(undefined[0])
        sentence = f"D is not defined at sigma = {point_text(points[k])} and near it."
        return Property(False, "numeric", sentence, {"sigma": points[k].tolist(), "value": None})
    return Property(True, "symbolic", _kinks(density))


def _kinks(density: Density) -> str:
    switches = {Op.MAXIMUM: "max", Op.MINIMUM: "min", Op.ABS: "abs"}
    used = sorted({switches[op] for op in (density.graph.nodes[node][0] for node in density.order) if op in switches})
    if used:
        return f"Analytic in pieces; kinks where {', '.join(used)} switch, and where singular values are equal."
    return "Analytic where the singular values differ."
