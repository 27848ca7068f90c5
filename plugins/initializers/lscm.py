"""Least-squares conformal map."""

from dataclasses import dataclass

import numpy as np

from workbench.api import (
    Floats,
    Initializer,
    StartRequest,
    conformal_energy,
    disc_boundary,
    signed_areas,
    solve_with_fixed,
)


@dataclass(frozen=True)
class LeastSquaresConformal(Initializer):
    """Minimiser of the conformal energy with two far-apart boundary vertices held; the rest of the boundary is free.

    Triangles may come out inverted on surfaces that bend strongly.
    """

    id = "lscm"
    label = "Least-squares conformal map"
    citation = "Lévy, Petitjean, Ray, Maillot 2002 [LPRM02]"
    kinds = ("parameterize",)

    def start(self, request: StartRequest) -> Floats:
        """Positions (n, 2), mirrored where most of the area would be inverted; raises `MeshError` for no disc."""
        mesh = request.mesh
        loop = disc_boundary(mesh)
        first, second = far_apart(mesh.vertices[loop])
        distance = float(np.linalg.norm(mesh.vertices[loop[first]] - mesh.vertices[loop[second]]))
        held = 2 * loop[[first, first, second, second]] + np.array([0, 1, 0, 1])
        places = np.array([[0.0], [0.0], [distance], [0.0]])
        order = (2 * mesh.elimination_order[:, None] + np.arange(2)).ravel()
        positions = solve_with_fixed(conformal_energy(mesh), held, places, order).reshape(-1, 2)
        if signed_areas(positions, mesh.simplices).sum() < 0:
            positions[:, 1] *= -1.0
        return positions


def far_apart(points: Floats) -> tuple[int, int]:
    """Rows of two points (k, 3) that are far from each other: two sweeps from the centre."""
    first = int(np.argmax(np.linalg.norm(points - points.mean(axis=0), axis=1)))
    return first, int(np.argmax(np.linalg.norm(points - points[first], axis=1)))
