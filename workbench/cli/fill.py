"""`workbench fill`: a closed surface filled with tetrahedra."""

from __future__ import annotations

import argparse
from typing import Any

from workbench.cli.options import amount, fixes
from workbench.cli.output import check_places, teller
from workbench.core.errors import WorkbenchError
from workbench.io.json_text import json_text

SCHEMA = 1
ENDINGS = (".mesh", ".msh", ".vtu", ".npz", ".obj")


def add_parser(name: str, commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = commands.add_parser(name, help="fill a closed surface with tetrahedra")
    add = parser.add_argument
    add("surface", metavar="SURFACE", help="file of a closed surface of triangles, or sample:ID")
    add("--out", required=True, metavar="TETS", help=f"the solid: {', '.join(ENDINGS)}")
    add("--edge-length", type=amount, default=0.0, metavar="L", help="wanted (default: a twentieth of the diagonal)")
    add("--fix", dest="fixes", type=fixes, default=(), metavar="FIX,...", help="mend the surface first: reorient, largest")
    add("--time-limit", type=amount, default=600.0, metavar="SECONDS", help="give up after so long (default: 600)")
    add("--memory-limit", type=amount, default=0.0, metavar="GB", help="of the mesher (default: half of the machine's)")
    add("--report", metavar="REPORT.json", help="one JSON object: counts, volumes, angles, seconds")
    add("--quiet", action="store_true", help="no progress; errors are still said")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Read, fill, write."""
    import time
    from pathlib import Path

    from workbench.core.fixes import apply_fixes
    from workbench.engine.filling import FillOptions, fill_surface
    from workbench.io.opening import read_source
    from workbench.io.reading_fixes import split_fixes
    from workbench.io.write import write_map

    check_places(path for path in (options.out, options.report) if path)
    if Path(options.out).suffix.lower() not in ENDINGS:
        raise WorkbenchError(f"{options.out}: solids are written as {', '.join(ENDINGS)}; name a file with such an ending.")
    reading, others = split_fixes(options.fixes)
    file = read_source(options.surface, **reading)
    surface = apply_fixes(file.mesh, others).mesh
    tell = teller(options.quiet)
    begin = time.perf_counter()
    limits = FillOptions(options.edge_length, options.time_limit, int(options.memory_limit * 2**30))
    try:
        solid = fill_surface(surface, limits, tell=tell)
    except WorkbenchError as error:
        raise type(error)(f"{options.surface}: {error.sentence}", fixes=error.fixes) from None
    seconds = time.perf_counter() - begin
    write_map(options.out, solid, solid, solid.vertices, "volume", fields={})
    facts = _facts(solid)
    if options.report:
        from workbench.io.atomic import write_text

        given = {"path": options.surface, "sha256": file.sha256, "triangles": surface.simplex_count}
        write_text(options.report, json_text({"schema": SCHEMA, "input": given, **facts, "seconds": seconds}))
    if not options.quiet:
        print(
            f"{surface.simplex_count} triangles -> {facts['tetrahedra']} tetrahedra, {facts['vertices']} vertices "
            f"in {seconds:.1f} s; dihedral angles {facts['dihedral_degrees'][0]:.1f} to {facts['dihedral_degrees'][1]:.1f}; "
            f"in {options.out}"
        )
    return 0


def _facts(solid: Any) -> dict[str, Any]:
    from workbench.core.jacobians import simplex_measures
    from workbench.core.solid_stars import dihedral_range

    return {
        "tetrahedra": solid.simplex_count,
        "vertices": solid.vertex_count,
        "volume": float(simplex_measures(solid).sum()),
        "dihedral_degrees": dihedral_range(solid.simplices, solid.vertices),
    }
