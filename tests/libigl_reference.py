"""SLIM and ARAP of libigl, as outside references for energies and times."""

from __future__ import annotations

from collections.abc import Callable

import igl
import numpy as np

from workbench.core.constraints import Anchors
from workbench.core.mesh import Mesh

SOFT = 1e5
"""Weight of anchors, which are soft in libigl's SLIM: that of its own examples."""


def slim_solver(mesh: Mesh, start: np.ndarray, anchors: Anchors | None = None) -> Callable[[int], np.ndarray]:
    """A function `iterations -> positions (n, d)` that goes on from where it was; symmetric Dirichlet, free boundary.

    Without anchors libigl's matrix is singular by a translation; it regularises that by itself.
    """
    dimension = start.shape[1]
    anchors = anchors or Anchors.none(dimension)
    points = np.zeros((mesh.vertex_count, 3))
    points[:, : mesh.vertices.shape[1]] = mesh.vertices
    data = igl.slim_precompute(
        np.asfortranarray(points),
        np.asfortranarray(mesh.simplices.astype(np.int32)),
        np.asfortranarray(start),
        igl.MappingEnergyType.SYMMETRIC_DIRICHLET,
        anchors.hard_vertices.astype(np.int32),
        np.asfortranarray(anchors.hard_targets),
        SOFT if len(anchors.vertices) else 0.0,
    )

    def advance(iterations: int) -> np.ndarray:
        return np.ascontiguousarray(igl.slim_solve(data, iterations)[:, :dimension])

    return advance


def arap_map(mesh: Mesh, start: np.ndarray, anchors: Anchors, iterations: int) -> np.ndarray:
    """Positions (n, d) after so many local/global iterations of libigl, simplex by simplex; the anchors are hard."""
    data = igl.ARAPData()
    data.max_iter = iterations
    vertices, simplices = np.asfortranarray(mesh.vertices), np.asfortranarray(mesh.simplices)
    igl.arap_precomputation(vertices, simplices, mesh.dimension, anchors.hard_vertices.astype(np.int32), data)
    return np.ascontiguousarray(igl.arap_solve(np.asfortranarray(anchors.hard_targets), data, np.asfortranarray(start)))
