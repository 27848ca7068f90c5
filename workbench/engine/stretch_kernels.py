"""The kernel of principal stretches, compiled where it stops nobody."""

from __future__ import annotations

import numpy as np

from workbench.core import principal_stretches
from workbench.core.mesh import Mesh
from workbench.core.principal_stretches import StretchProbe
from workbench.engine.compile_elsewhere import compile_elsewhere


def compile_stretches() -> None:
    """To be called on a thread of the window before the first glyph is drawn."""
    compile_elsewhere(principal_stretches._decompose, look_at_a_simplex)
    look_at_a_simplex()


def look_at_a_simplex() -> None:
    """The stretches of one tetrahedron and of one triangle."""
    corners = np.vstack([np.zeros(3), np.eye(3)])
    StretchProbe(Mesh(corners, np.arange(4)[None]), np.array([0])).at(corners)
    StretchProbe(Mesh(corners[:3, :2], np.arange(3)[None]), np.array([0])).at(corners[:3, :2])
