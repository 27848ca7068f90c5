"""Compiling ahead: the kernels of a solver are loaded, or the first time ever compiled, before a clock runs."""

from __future__ import annotations

from contextlib import suppress

import numpy as np

from workbench.core.constraints import Anchors
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.solver import Solver


def compile_kernels(problem: Problem, solver: Solver) -> None:
    """Steps on a single simplex of the same dimension, and one of anchors that lag where the problem has anchors."""
    n = problem.dimension
    corners = np.vstack([np.zeros(n), np.eye(n)])
    simplex = Mesh(corners, np.arange(n + 1)[None])
    with suppress(Exception, SystemExit):  # whatever is wrong will be said of the real problem
        small = Problem.create(simplex, "plane" if n == 2 else "volume", problem.distortion)
        for scale in (1.25, np.linspace(20.0, 0.05, n)):  # some solvers go another way where the distortion is large
            solver.step(small, solver.init(small, corners * scale))
        if len(problem.anchors.vertices):
            moved = small.with_anchors(Anchors(np.zeros(1, dtype=np.int64), np.full((1, n), -0.1)))
            solver.step(moved, solver.init(moved, corners * 1.25))
