"""The start `auto`: what the quick initializers make of a mesh, the best of it."""

from __future__ import annotations

from workbench.core.arrays import Floats
from workbench.core.best_start import Candidate, best_start
from workbench.core.errors import WorkbenchError
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.engine.starts import make_start

QUICK = ("rest", "tutte", "mean-value", "harmonic", "lscm")
"""Initializers that are tried: one linear system each, or none."""


def make_best_start(problem: Problem) -> tuple[Candidate, ...]:
    """Every quick start of the problem's mesh at its best scale, the best first (see `workbench.core.best_start`).

    An initializer that refuses the mesh, or fails on it, is passed over. Raises `WorkbenchError` where all do.
    """
    known = registry().initializers
    starts: dict[str, Floats] = {}
    for id in QUICK:
        if id in known and problem.kind in known[id].kinds:
            try:
                starts[id] = make_start(problem.mesh, problem.kind, id)
            except WorkbenchError:
                continue
    return best_start(problem, starts)
