"""How distorted a map is level by level of a refinement: the curves of Fig. 20."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.jacobians import build_elements, signed_singular_values
from workbench.core.mesh import Mesh
from workbench.core.quality import statistics
from workbench.core.refine.refined import refined_levels

FIGURE_20 = ("mips", "condition-number", "arap")
"""Distortions that Fig. 20 shows: (26), (29), (33)."""


@dataclass(frozen=True)
class LevelMeasures:
    """One level: counts, and the mean of each distortion over the area or volume of the source, by id."""

    level: int
    vertices: int
    simplices: int
    inverted: int
    measures: dict[str, float]


def measure_levels(
    mesh: Mesh,
    positions: ArrayLike,
    scheme: str,
    levels: int,
    distortions: Sequence[Distortion],
    *,
    tell: Callable[[LevelMeasures], object] | None = None,
) -> tuple[LevelMeasures, ...]:
    """Measures of the map as it is and after each level of refinement.

    Parameters
    ----------
    positions : (n, d) float64     d is the dimension of the simplices
    tell : called with each level as it is done

    Raises `WorkbenchError` as `refine` does, and `MeshError` for a source with simplices of no area or volume.
    """
    if np.shape(positions)[1:] != (mesh.dimension,):
        raise WorkbenchError(f"The map has shape {np.shape(positions)}; {mesh.dimension} columns are needed to measure it.")
    rows = []
    for refined in refined_levels(mesh, positions, scheme, levels):
        assert refined.positions is not None
        elements = build_elements(refined.mesh)
        sigma = signed_singular_values(elements, refined.positions)
        means = {item.id: statistics(item.value(sigma), elements.rest_measures)["area_weighted_mean"] for item in distortions}
        inverted = int(np.count_nonzero(~(sigma[:, -1] > 0)))
        rows.append(LevelMeasures(refined.levels, refined.mesh.vertex_count, refined.mesh.simplex_count, inverted, means))
        if tell is not None:
            tell(rows[-1])
    return tuple(rows)
