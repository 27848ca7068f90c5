"""How distorted a map is level by level of a refinement: the curves of Fig. 20."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from workbench.core.arrays import Floats
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.mesh import Mesh
from workbench.core.refine.refined import Refined, refined_levels
from workbench.core.solver import Interrupt, never

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
    positions: ArrayLike | None,
    scheme: str,
    levels: int,
    distortions: Sequence[Distortion],
    interrupt: Interrupt = never,
) -> tuple[LevelMeasures, ...]:
    """Measures of the map as it is and after each level of refinement.

    Parameters
    ----------
    positions : (n, d) float64     d is the dimension of the simplices; None: the texture coordinates of `mesh`
    interrupt : () -> bool         asked before each level; once it says so, the levels so far are returned

    A parameterization that is mirrored as a whole is measured as its reflection.
    Raises `WorkbenchError` as `refine` does, and `MeshError` for a source with simplices of no area or volume.
    """
    from workbench.core.jacobians import build_elements, signed_singular_values

    if positions is None and mesh.texture is None:
        raise WorkbenchError("There is no map to measure: neither positions nor texture coordinates.")
    if positions is not None and np.shape(positions)[1:] != (mesh.dimension,):
        raise WorkbenchError(f"The map has shape {np.shape(positions)}; {mesh.dimension} columns are needed to measure it.")
    rows: list[LevelMeasures] = []
    is_mirrored = False
    for refined in refined_levels(mesh, positions, scheme, levels):
        if interrupt():
            break
        source, target = _source_and_target(refined)
        elements = build_elements(source)
        sigma = signed_singular_values(elements, target)
        if not rows and mesh.vertices.shape[1] > mesh.dimension:
            is_mirrored = bool((sigma[:, -1] < 0).all())
        if is_mirrored:
            sigma[:, -1] *= -1.0
        shares = elements.rest_measures / elements.rest_measures.sum()
        means = {item.id: float(shares @ item.value(sigma)) for item in distortions}
        inverted = int(np.count_nonzero(~(sigma[:, -1] > 0)))
        rows.append(LevelMeasures(refined.levels, refined.mesh.vertex_count, refined.mesh.simplex_count, inverted, means))
    return tuple(rows)


def _source_and_target(refined: Refined) -> tuple[Mesh, Floats]:
    """The map by vertices; texture coordinates, which a seam gives two values, by corners of loose triangles."""
    mesh = refined.mesh
    if refined.positions is not None:
        return mesh, refined.positions
    assert mesh.texture is not None
    corners = mesh.simplices.ravel()
    loose = np.arange(len(corners)).reshape(-1, 3)
    return Mesh(mesh.vertices[corners], loose), mesh.texture.coordinates[mesh.texture.corners.ravel()]
