"""A solid onto a ball by stretching rays."""

from dataclasses import dataclass
from typing import Literal

from workbench.api import Floats, Initializer, StartRequest, parameter, radial_stretch, relaxed_inside


@dataclass(frozen=True)
class RadialStretch(Initializer):
    """Rays from the centre stretched until the boundary lies on a ball: star-shaped solids come out upright.

    Others fold; tetrahedra that stay inverted are counted as those of any start.
    """

    id = "radial-stretch"
    label = "Radial stretch onto a ball"
    citation = "Naitsat et al. 2018 [NCQ*18]; Figs. 1, 10"
    kinds = ("volume",)

    shape: Literal["ball", "cube"] = parameter("ball", "What the boundary goes to; it has the volume of the source in the end.")
    boundary: Literal["rays", "harmonic", "balanced"] = parameter(
        "rays", "How it gets there: along rays, by its own harmonic map, or by one whose arms do not shrink."
    )
    repair: bool = parameter(True, "Move inner vertices of inverted tetrahedra to the middle of their neighbours.")

    def start(self, request: StartRequest) -> Floats:
        """Positions (n, 3); raises `MeshError` where the boundary is not like a sphere."""
        positions = radial_stretch(request.mesh, self.shape, self.boundary)
        return relaxed_inside(request.mesh, positions) if self.repair else positions
