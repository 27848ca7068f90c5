"""The kernels of verdicts on solids, and of the look at a surface before it is filled, compiled where it stops nobody."""

from __future__ import annotations

import numpy as np

from workbench.core import triangle_pairs
from workbench.core.injectivity import global_injectivity
from workbench.core.mesh import Mesh
from workbench.engine.compile_elsewhere import compile_elsewhere


def compile_verdicts() -> None:
    """To be called before a verdict on a thread of the window."""
    compile_elsewhere(triangle_pairs._sweep, judge_a_tetrahedron)


def judge_a_tetrahedron() -> None:
    """Everything that a verdict looks at, once."""
    corners = np.vstack([np.zeros(3), np.eye(3)])
    global_injectivity(Mesh(corners, np.arange(4)[None]), corners)
