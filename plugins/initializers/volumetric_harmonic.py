"""The harmonic map of a solid whose boundary is mapped first."""

from dataclasses import dataclass
from typing import Literal

from workbench.api import (
    Floats,
    Initializer,
    StartRequest,
    boundary_images,
    dirichlet_matrix,
    harmonic_extension,
    parameter,
    relaxed_inside,
    solid_boundary,
    solve_with_fixed,
)


@dataclass(frozen=True)
class VolumetricHarmonic(Initializer):
    """Minimiser of the Dirichlet energy (25) among maps with the boundary on a ball or a cube, or at rest.

    Weights of tetrahedra with obtuse dihedral angles are negative: such ones may come out inverted.
    """

    id = "volumetric-harmonic"
    label = "Volumetric harmonic map"
    citation = "Wang et al. 2003 [WGY*03]; Li et al. 2007 [LGW*07]"
    kinds = ("volume",)

    shape: Literal["ball", "cube", "rest"] = parameter(
        "ball", "What the boundary goes to; it has the volume of the source in the end."
    )
    boundary: Literal["rays", "harmonic", "balanced"] = parameter(
        "harmonic", "How it gets there: along rays, by its own harmonic map, or by one whose arms do not shrink."
    )
    repair: bool = parameter(True, "Move inner vertices of inverted tetrahedra to the middle of their neighbours.")

    def start(self, request: StartRequest) -> Floats:
        """Positions (n, 3); raises `MeshError` where the boundary is not like a sphere."""
        mesh = request.mesh
        if self.shape == "rest":
            return harmonic_extension(mesh, mesh.topology.boundary_vertices)
        boundary = solid_boundary(mesh)
        images = boundary_images(mesh, boundary, self.shape, self.boundary)
        positions = solve_with_fixed(dirichlet_matrix(mesh), boundary.vertices, images, mesh.elimination_order)
        return relaxed_inside(mesh, positions) if self.repair else positions
