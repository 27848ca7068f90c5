"""SLIM and ARAP of libigl, as outside references for energies and times."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass

import igl
import numpy as np

from workbench.core.constraints import Anchors
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem

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


@dataclass(frozen=True, eq=False)
class SlimRun:
    """Where SLIM ended: its seconds (precomputation among them), iterations, `energy` and `positions` of the last map."""

    seconds: float
    iterations: int
    energy: float
    positions: np.ndarray


def run_slim(problem: Problem, start: np.ndarray, is_there: Callable[[float], bool], budget: float) -> SlimRun:
    """SLIM from `start` until `is_there` holds for the problem's energy of its map, or it has spent `budget` seconds."""
    begin = time.perf_counter()
    slim = slim_solver(problem.mesh, start, problem.anchors)
    spent, iterations, energy, positions = time.perf_counter() - begin, 0, np.inf, start
    while not is_there(energy) and spent < budget:
        begin = time.perf_counter()
        positions = slim(1)
        spent += time.perf_counter() - begin
        iterations += 1
        energy = problem.energy(positions)
    return SlimRun(spent, iterations, energy, positions)


def arap_map(mesh: Mesh, start: np.ndarray, anchors: Anchors, iterations: int) -> np.ndarray:
    """Positions (n, d) after so many local/global iterations of libigl, simplex by simplex; the anchors are hard."""
    data = igl.ARAPData()
    data.max_iter = iterations
    vertices, simplices = np.asfortranarray(mesh.vertices), np.asfortranarray(mesh.simplices)
    igl.arap_precomputation(vertices, simplices, mesh.dimension, anchors.hard_vertices.astype(np.int32), data)
    return np.ascontiguousarray(igl.arap_solve(np.asfortranarray(anchors.hard_targets), data, np.asfortranarray(start)))
