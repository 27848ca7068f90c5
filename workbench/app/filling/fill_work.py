"""What the fill dialog has done on a thread: reading the surface, filling it, writing the solid."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from workbench.core.errors import WorkbenchError

ENDINGS = (".mesh", ".msh", ".vtu", ".npz", ".obj")


@dataclass(frozen=True)
class FillRequest:
    """A file or `sample:ID` with a closed surface, how many edges make its diagonal, and the file for the solid."""

    source: str
    parts: int
    path: Path


def check_request(request: FillRequest) -> None:
    """Raises `WorkbenchError` for what can be told before the work."""
    if not request.source:
        raise WorkbenchError("Name the file of a closed surface first.")
    if not request.source.startswith("sample:") and not Path(request.source).is_file():
        raise WorkbenchError(f"There is no file {request.source}; choose another.")
    if request.path.suffix.lower() not in ENDINGS:
        raise WorkbenchError(f"Solids are written as {', '.join(ENDINGS)}; choose one of these endings.")
    if not request.path.parent.is_dir():
        raise WorkbenchError(f"There is no folder {request.path.parent}; make it first, or choose another.")
    if request.path.exists():
        raise WorkbenchError(f"{request.path.name} is there already; choose another name.")


def fill_into(request: FillRequest, cancelled: Callable[[], bool], tell: Callable[[str], None]) -> str:
    """Fill and write; a sentence about the solid. Raises `WorkbenchError`."""
    from workbench.core.fixes import reorient
    from workbench.engine.filling import FillOptions, fill_surface
    from workbench.engine.verdict_kernels import compile_verdicts
    from workbench.io.opening import read_source
    from workbench.io.write import write_map

    compile_verdicts()
    surface, _ = reorient(read_source(request.source).mesh)
    options = FillOptions(edge_length=surface.diameter / request.parts)
    solid = fill_surface(surface, options, cancelled=cancelled, tell=tell)
    write_map(request.path, solid, solid, solid.vertices, "volume", fields={})
    return f"{surface.simplex_count} triangles are filled with {solid.simplex_count} tetrahedra, in {request.path.name}."
