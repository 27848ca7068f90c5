"""Starts: an initializer applied to a source, scaled and the right way round."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.errors import WorkbenchError
from workbench.core.initializer import StartRequest
from workbench.core.mesh import Mesh
from workbench.core.method import Kind
from workbench.core.registry import registry

if TYPE_CHECKING:
    from workbench.core.problem import Problem

OWN_SCALE = ("rest", "file", "auto", "arap-start")
"""Initializers whose scale is meant."""
DEFAULT_INITIALIZERS: dict[Kind, str] = {"plane": "rest", "parameterize": "tutte", "volume": "rest"}


def default_initializer(kind: Kind, wished: str = "") -> str:
    """Id of the start for a kind of map: on a surface the one that the solver wishes for, where it does.

    In the plane and in space the source itself is at hand, and as good a map as there is.
    """
    return wished if wished and kind == "parameterize" else DEFAULT_INITIALIZERS[kind]


def make_start(
    mesh: Mesh,
    kind: Kind,
    initializer: str = "",
    parameters: Mapping[str, Any] | None = None,
    file: str = "",
    match_area: bool = True,
    problem: Problem | None = None,
) -> Floats:
    """Positions of the start.

    Parameters
    ----------
    initializer : str      id; empty for the default of the kind of map
    file : str             for the initializer `file`
    match_area : bool      scale to the total area (volume) of the source; a start at rest has it already
    problem : Problem      what it is for, for initializers that choose by the energy

    Returns
    -------
    (n, d) float64     a parameterization that came out mirrored as a whole is reflected

    Raises `WorkbenchError` for an unknown id, parameters that do not fit, or a mesh that does not allow the start.
    """
    id = initializer or DEFAULT_INITIALIZERS[kind]
    method = registry().initializer(id)
    if kind not in method.kinds:
        raise WorkbenchError(f"{method.label} makes no start for {kind} maps; choose another initializer.")
    request = StartRequest(mesh, kind, file, problem, lambda other: make_start(mesh, kind, other))
    start = method.configured(dict(parameters or {})).start(request)
    start = np.ascontiguousarray(start, dtype=np.float64)
    if start.shape != (mesh.vertex_count, mesh.dimension) or not np.isfinite(start).all():
        raise WorkbenchError(f"{method.label} gave no usable start for this mesh; choose another initializer.")
    return adjusted_start(mesh, kind, start, match_area and id not in OWN_SCALE)


def adjusted_start(mesh: Mesh, kind: Kind, start: Floats, match_area: bool) -> Floats:
    """The start (n, d) reflected where all of it is mirrored, and scaled to the area of the source where asked."""
    from workbench.core.jacobians import build_elements, determinants

    elements = build_elements(mesh)
    det = determinants(elements, start)
    if kind == "parameterize" and (det < 0).all():
        start = start * np.array([-1.0, 1.0])
        det = -det
    if match_area:
        covered = float(np.abs(det) @ elements.rest_measures)
        if covered > 0 and np.isfinite(covered):
            start = start * (float(elements.rest_measures.sum()) / covered) ** (1.0 / mesh.dimension)
    return np.ascontiguousarray(start)
