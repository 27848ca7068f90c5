"""What the refinement dialog has done on a thread: refining into a file, curves of distortion against level."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from workbench.core.arrays import Floats, Integers
from workbench.core.errors import WorkbenchError
from workbench.core.mesh import Mesh
from workbench.core.method import Kind
from workbench.core.refine import FIGURE_20, SCHEMES, measure_levels, refine, refined_count

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from workbench.core.distortion import Distortion

MOST_MEASURED = 1_000_000
"""Simplices of one level beyond which a curve ends: the next level would take minutes."""

PICTURE_DPI = 80


@dataclass(frozen=True, eq=False)
class RefineRequest:
    """A source, the map of it and its anchors, taken at the moment of asking."""

    mesh: Mesh
    kind: Kind
    positions: Floats
    anchor_vertices: Integers
    anchor_targets: Floats
    scheme: str
    levels: int


@dataclass(frozen=True, eq=False)
class CurveRequest:
    """A map, the most levels, the distortion of the session, and how many pixels of the screen make one of Qt's."""

    mesh: Mesh
    positions: Floats
    levels: int
    title: str
    distortion: str
    parameters: Mapping[str, Any] = field(default_factory=dict)
    pixel_ratio: float = 1.0


@dataclass(frozen=True, eq=False)
class CurvePicture:
    """The figure, to be saved, and the bytes of a PNG of it."""

    figure: Figure
    png: bytes


def refine_into(path: Path, request: RefineRequest) -> int:
    """Write the refined source with its map, as a case; the number of its simplices. Raises `WorkbenchError`."""
    from workbench.io.write import write_map

    if path.suffix.lower() != ".npz":
        raise WorkbenchError(f"{path}: a source with its map and anchors is written as .npz; choose that ending.")
    if path.exists():
        raise WorkbenchError(f"{path} is there already; choose another name.")
    refined = refine(request.mesh, request.positions, request.scheme, request.levels)
    assert refined.positions is not None
    write_map(
        path,
        refined.mesh,
        refined.mesh,
        refined.positions,
        request.kind,
        anchor_vertices=request.anchor_vertices,
        anchor_targets=request.anchor_targets,
    )
    return refined.mesh.simplex_count


def free_name(folder: Path, stem: str, ending: str = ".npz") -> Path:
    """`stem.npz` in `folder`, or with the first number that is free."""
    path, number = folder / f"{stem}{ending}", 2
    while path.exists():
        path, number = folder / f"{stem}-{number}{ending}", number + 1
    return path


def schemes_of(mesh: Mesh) -> tuple[str, ...]:
    """Schemes that the mesh allows."""
    return tuple(SCHEMES) if mesh.dimension == 2 else ("linear",)


def draw_curves(request: CurveRequest, interrupt: Callable[[], bool] = lambda: False) -> CurvePicture:
    """Mean distortion against level, for every scheme that the mesh allows.

    Raises `WorkbenchError`, also once `interrupt` says that nobody waits any longer.
    """
    from workbench.figures.level_curves import level_curves

    distortions = _distortions(request)
    curves = {}
    for scheme in schemes_of(request.mesh):
        levels = max(k for k in range(request.levels + 1) if k == 0 or refined_count(request.mesh, scheme, k) <= MOST_MEASURED)
        curves[scheme] = measure_levels(request.mesh, request.positions, scheme, levels, distortions, interrupt)
        if interrupt():
            raise WorkbenchError("The curves are no longer wanted.")
    figure = level_curves(curves, request.title)
    stream = BytesIO()
    figure.savefig(stream, format="png", dpi=PICTURE_DPI * request.pixel_ratio)
    return CurvePicture(figure, stream.getvalue())


def _distortions(request: CurveRequest) -> list[Distortion]:
    """Those of Fig. 20, and the one of the session."""
    from workbench.core.distortion import Distortion

    chosen = [Distortion.resolve(id) for id in FIGURE_20]
    if request.distortion not in FIGURE_20:
        chosen.append(Distortion.resolve(request.distortion, request.parameters))
    return chosen
