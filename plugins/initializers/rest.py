"""The source itself as the start."""

from dataclasses import dataclass

from workbench.api import Floats, Initializer, StartRequest, WorkbenchError


@dataclass(frozen=True)
class Rest(Initializer):
    """Every vertex where it is in the source: the identity, without distortion."""

    id = "rest"
    label = "Rest (the source itself)"
    citation = ""
    kinds = ("plane", "volume")

    def start(self, request: StartRequest) -> Floats:
        """A copy of the vertices of the source."""
        mesh = request.mesh
        if mesh.vertices.shape[1] != mesh.dimension:
            raise WorkbenchError("A surface in space is no map to the plane; choose the start tutte, harmonic or lscm.")
        return mesh.vertices.copy()
