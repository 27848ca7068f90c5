"""Tutte's embedding."""

from dataclasses import dataclass
from typing import Literal

from workbench.api import (
    Floats,
    Initializer,
    StartRequest,
    map_disc,
    match_source_frame,
    parameter,
    uniform_weights,
    upright,
)


@dataclass(frozen=True)
class Tutte(Initializer):
    """Boundary on a convex curve, every inner vertex at the mean of its neighbours: never an inverted triangle."""

    id = "tutte"
    label = "Tutte embedding"
    citation = "Tutte 1963 [Tut63]; Floater 2003 [F03]"
    kinds = ("parameterize", "plane")

    boundary: Literal["circle", "square"] = parameter("circle", "Curve for the boundary, by arc length.")
    repair: bool = parameter(True, "Change the weights (still positive) where parts come out too small for rounding.")

    def start(self, request: StartRequest) -> Floats:
        """Positions (n, 2); raises `MeshError` where the mesh is no disc."""
        mesh = upright(request.mesh)
        return match_source_frame(request.mesh, map_disc(mesh, uniform_weights(mesh), self.boundary, self.repair))
