"""The discrete harmonic map."""

from dataclasses import dataclass
from typing import Literal

from workbench.api import (
    Floats,
    Initializer,
    StartRequest,
    cotangent_weights,
    harmonic_extension,
    map_disc,
    parameter,
)


@dataclass(frozen=True)
class Harmonic(Initializer):
    """Minimiser of the Dirichlet energy (25) with a given boundary.

    A surface has its boundary on a convex curve; in the plane and in space the boundary stays at rest.
    """

    id = "harmonic"
    label = "Harmonic map (cotangent weights)"
    citation = "Floater & Hormann 2005 [FH05]"

    boundary: Literal["circle", "square"] = parameter("circle", "Curve for the boundary of a surface, by arc length.")
    repair: bool = parameter(True, "Make the weights positive where triangles come out inverted or collapsed.")

    def start(self, request: StartRequest) -> Floats:
        """Positions (n, d); raises `MeshError` where a surface is no disc."""
        mesh = request.mesh
        if request.kind == "parameterize":
            return map_disc(mesh, cotangent_weights(mesh), self.boundary, self.repair)
        return harmonic_extension(mesh, mesh.topology.boundary_vertices)
