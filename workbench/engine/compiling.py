"""Compiling ahead: the kernels of a solver are loaded, or the first time ever compiled, before a clock runs."""

from __future__ import annotations

from contextlib import suppress

import numpy as np

from workbench.core.constraints import Anchors
from workbench.core.problem import Problem
from workbench.core.samples import make_sample
from workbench.core.solver import Solver

SIMPLICES = 60
"""Of the mesh for the trial steps: one simplex would leave out what a factorisation does between its parts."""


def compile_kernels(problem: Problem, solver: Solver) -> None:
    """Steps on a mesh of few simplices of the same dimension, and one of anchors that lag where the problem has anchors."""
    n = problem.dimension
    with suppress(Exception, SystemExit), np.errstate(all="ignore"):  # whatever is wrong will be said of the real problem
        mesh = make_sample("bar" if n == 2 else "bar-3d", SIMPLICES)
        rest = np.ascontiguousarray(mesh.vertices[:, :n])
        small = Problem.create(mesh, "plane" if n == 2 else "volume", problem.distortion)
        small.inverted(rest)
        for scale in (1.25, np.linspace(20.0, 0.05, n)):  # some solvers go another way where the distortion is large
            solver.step(small, solver.init(small, rest * scale))
        if len(problem.anchors.vertices):
            moved = small.with_anchors(Anchors(np.zeros(1, dtype=np.int64), rest[:1] - 0.1))
            solver.step(moved, solver.init(moved, rest * 1.25))
