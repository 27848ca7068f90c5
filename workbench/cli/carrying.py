"""The options of a surface that the map of a volume carries with it, and what is told and written about it."""

from __future__ import annotations

import argparse
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from workbench.core.errors import WorkbenchError

if TYPE_CHECKING:
    from workbench.core.arrays import Floats
    from workbench.core.carried_surface import CarriedSurface
    from workbench.io.opening import OpenedSource


@dataclass(frozen=True, eq=False)
class Carried:
    """A surface that was named with `--carry`."""

    path: str
    surface: CarriedSurface


def add_carry_options(parser: argparse.ArgumentParser) -> None:
    """Which surface is carried, and where it is written."""
    add = parser.add_argument
    add("--carry", metavar="SURFACE", help="a surface inside the volume, which the map carries with it (Fig. 8)")
    add("--carried-out", metavar="OUT", help="the carried surface: .obj, .npz, .vtu, or .csv of its own measures")


def check_carry_options(options: argparse.Namespace) -> None:
    """Raises `WorkbenchError` where one is given without the other, or the file cannot be of that ending."""
    from workbench.io.write import SURFACE_ENDINGS

    if options.carried_out and not options.carry:
        raise WorkbenchError("--carried-out says where a carried surface goes; name the surface with --carry.")
    if options.carried_out and Path(options.carried_out).suffix.lower() not in SURFACE_ENDINGS:
        endings = ", ".join(SURFACE_ENDINGS)
        raise WorkbenchError(f"{options.carried_out}: surfaces are written as {endings}; choose one of these endings.")


def read_carried(options: argparse.Namespace, opened: OpenedSource) -> Carried | None:
    """The surface of `--carry`, placed in the volume; None where none was named. Raises `WorkbenchError`."""
    if not options.carry:
        return None
    from workbench.core.carried_surface import carry
    from workbench.io.opening import read_source

    return Carried(options.carry, carry(read_source(options.carry).mesh, opened.mesh))


def carried_report(carried: Carried, positions: Floats) -> dict[str, Any]:
    """What `--report` tells of it under one map of the volume: counts, and statistics of the surface's own map."""
    from workbench.core.quality import measure_map

    surface = carried.surface
    measured = measure_map(surface.measured, surface.at(positions))
    return {
        "path": carried.path,
        "vertices": surface.surface.vertex_count,
        "triangles": surface.surface.simplex_count,
        "outside": surface.outside_count,
        "farthest": surface.farthest,
        **{name: measured[name] for name in ("measures", "degenerate", "min_det", "histogram78")},
    }


def write_carried(path: str, carried: Carried, positions: Floats) -> None:
    """The surface where the map of the volume takes it. Raises `WorkbenchError`."""
    from workbench.io.write import write_surface

    moved = carried.surface.at(positions)
    write_surface(path, carried.surface.surface, moved, carried.surface.table(moved))
