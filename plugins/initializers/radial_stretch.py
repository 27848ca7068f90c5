"""A solid onto a ball by stretching rays."""

from dataclasses import dataclass
from typing import Literal

from workbench.api import Floats, Initializer, StartRequest, parameter, radial_stretch


@dataclass(frozen=True)
class RadialStretch(Initializer):
    """Rays from the centre stretched until the boundary lies on a ball: never an inverted one where the mesh is fine enough.

    That holds for solids that are star-shaped; where others are folded, tetrahedra come out inverted.
    """

    id = "radial-stretch"
    label = "Radial stretch onto a ball"
    citation = "NCQ*18; Figs. 1, 10"
    kinds = ("volume",)

    shape: Literal["ball", "cube"] = parameter("ball", "What the boundary goes to; it has the volume of the source in the end.")
    boundary: Literal["rays", "harmonic"] = parameter("rays", "How it gets there: along rays, or by its own harmonic map.")

    def start(self, request: StartRequest) -> Floats:
        """Positions (n, 3); raises `MeshError` where the boundary is not like a sphere."""
        return radial_stretch(request.mesh, self.shape, self.boundary)
