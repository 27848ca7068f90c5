"""Everything that is measured of one simplex of a map, at no more cost than that one simplex."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.jacobians import build_elements, jacobians
from workbench.core.measure import Evaluator, SingularValues
from workbench.core.mesh import Mesh


@dataclass(frozen=True)
class SimplexReading:
    """Numbers of one simplex.

    Attributes
    ----------
    simplex : int
    vertices : tuple of int      its corners
    sigma : tuple of float       singular values, descending, the last with the sign of det J
    det : float                  det J: negative where it is inverted
    rest_measure : float         area or volume in the source
    measure : float              signed area or volume in the target: det J times that of the source
    values : dict                of every measure that was asked for, by its name
    """

    simplex: int
    vertices: tuple[int, ...]
    sigma: tuple[float, ...]
    det: float
    rest_measure: float
    measure: float
    values: dict[str, float]


def read_simplex(mesh: Mesh, positions: Floats, simplex: int, measures: Mapping[str, Evaluator]) -> SimplexReading:
    """Read what is measured of one simplex.

    Parameters
    ----------
    mesh : Mesh                    the source
    positions : (n, d) float64     the map, d that of the simplices
    simplex : int                  row of `mesh.simplices`
    measures : name -> Evaluator   from `Measure.prepare`

    Cost: does not depend on the size of the mesh.
    """
    corners = mesh.simplices[simplex]
    alone = Mesh(mesh.vertices[corners], np.arange(len(corners))[None])
    elements = build_elements(alone)
    (jacobian,) = jacobians(elements, np.asarray(positions[corners], dtype=np.float64))
    det = float(np.linalg.det(jacobian))
    sigma = np.linalg.svd(jacobian, compute_uv=False)
    sigma[-1] = np.copysign(sigma[-1], det)
    map = SingularValues(sigma[None])
    rest = float(elements.rest_measures[0])
    return SimplexReading(
        simplex,
        tuple(int(corner) for corner in corners),
        tuple(float(value) for value in sigma),
        det,
        rest,
        det * rest,
        {name: float(measure(map)[0]) for name, measure in measures.items()},
    )
