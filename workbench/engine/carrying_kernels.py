"""The kernels of carried surfaces, compiled where it stops nobody."""

from __future__ import annotations

import numpy as np

from workbench.core import nearest_tetrahedron
from workbench.core.carried_surface import carry
from workbench.core.measure import Measure
from workbench.core.mesh import Mesh
from workbench.core.surface_normals import vertex_normals
from workbench.engine.compile_elsewhere import compile_elsewhere


def compile_carrying() -> None:
    """To be called before a surface is carried on a thread of the window."""
    compile_elsewhere(nearest_tetrahedron._locate_all, carry_a_triangle)


def carry_a_triangle() -> None:
    """Everything that is done with a carried surface, once, in one tetrahedron."""
    corners = np.vstack([np.zeros(3), np.eye(3)])
    carried = carry(Mesh(0.2 * corners[:3] + [0.1, 0.1, 0.4], np.array([[0, 1, 2]])), Mesh(corners, np.arange(4)[None]))
    moved = carried.at(corners)
    carried.measures(moved, [Measure("det")])
    vertex_normals(moved, carried.surface.simplices)
