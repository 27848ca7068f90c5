"""A source and its map out of one file or two, as they are measured."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.errors import MeshError
from workbench.core.fixes import apply_fixes
from workbench.core.kinds import resolve_kind, source_for_kind
from workbench.core.mesh import Mesh
from workbench.engine.starts import adjusted_start
from workbench.io.opening import read_source
from workbench.io.reading_fixes import split_fixes
from workbench.io.start_file import fit_dimension, leads_into_space, positions_in_file


@dataclass(frozen=True, eq=False)
class MapFile:
    """`mesh` is the source, `positions` (n, d) the map; `was_mirrored`: it is the reflection of what the file holds."""

    mesh: Mesh
    positions: Floats
    was_mirrored: bool


def open_map(
    source: str,
    target: str | None = None,
    *,
    kind: str = "auto",
    fixes: tuple[str, ...] = (),
    tets: bool = False,
) -> MapFile:
    """The source, and the map of `target` or else the one that `source` holds itself (vt of an OBJ, X or X0 of a case).

    A map is measured on any mesh, a disc or not; where texture coordinates are the map, their seams are part of it.
    Where positions of a surface lie in no plane, it is a map from surface to surface, of three columns (45).
    Raises `WorkbenchError` for files that cannot be used, `MeshError` where there is no map.
    """
    reading, others = split_fixes(fixes)
    file = read_source(source, **{"tets": tets, **reading})
    holds_map = file.map_positions is not None or file.mesh.texture is not None
    if target is None and not holds_map:
        raise MeshError(
            f"{source} holds no map (vt of an OBJ, X or X0 of a case, a VTU of this program); name a second file that does."
        )
    others = others or ("unreferenced", *(("seams",) if target is None else ()))
    fixed = apply_fixes(file.mesh, others).mesh
    found = resolve_kind(fixed, kind)
    mesh = source_for_kind(fixed, found)
    positions = positions_in_file(target or source, mesh, found)
    if kind == "auto" and leads_into_space(positions, mesh):
        return MapFile(mesh, positions, False)
    positions = fit_dimension(Path(target or source), positions, mesh, found)
    adjusted = adjusted_start(mesh, found, positions, match_area=False)
    return MapFile(mesh, adjusted, not np.array_equal(adjusted, positions))
