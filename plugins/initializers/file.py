"""A map that a file holds as the start."""

from dataclasses import dataclass

from workbench.api import Floats, Initializer, StartRequest, WorkbenchError, map_from_file


@dataclass(frozen=True)
class FromFile(Initializer):
    """Texture coordinates or positions that a file holds for the vertices of the source."""

    id = "file"
    label = "From a file"
    citation = ""

    def start(self, request: StartRequest) -> Floats:
        """The map in `request.file`, one row a vertex of the source."""
        if not request.file:
            raise WorkbenchError("The start file needs a file: name one that holds the map of this mesh.")
        return map_from_file(request.file, request.mesh, request.kind)
