"""`workbench measure`: how good a map is."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING, Any

from workbench.cli.options import add_source_options
from workbench.cli.output import json_text, number, table
from workbench.core.errors import MeshError

if TYPE_CHECKING:
    from workbench.core.arrays import Floats
    from workbench.core.mesh import Mesh


def add_parser(name: str, commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = commands.add_parser(name, help="every measure of a map, inverted simplices, injectivity verdicts")
    parser.add_argument("source", metavar="SOURCE", help="mesh file; without TARGET its vt (OBJ) or X (npz) is the map")
    parser.add_argument("target", nargs="?", metavar="TARGET", help="file of the map: vt, X, or positions")
    add_source_options(parser)
    parser.add_argument("--json", action="store_true", help="one JSON object")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Measure and print."""
    from workbench.core.quality import measure_map

    mesh, positions = _source_and_map(options)
    measured = measure_map(mesh, positions)
    print(json_text(measured) if options.json else _text(measured), end="")
    return 0


def _source_and_map(options: argparse.Namespace) -> tuple[Mesh, Floats]:
    """The source, and the map of TARGET or else the one that SOURCE holds itself.

    A map is measured on any mesh, a disc or not; where texture coordinates are the map, their seams are part of it.
    """
    import numpy as np

    from workbench.core.fixes import apply_fixes
    from workbench.core.kinds import resolve_kind, source_for_kind
    from workbench.engine.starts import adjusted_start
    from workbench.io.opening import map_from_file, read_source

    name, target = options.source, options.target
    file = read_source(name, tets=options.tets)
    holds_map = file.map_positions is not None or file.mesh.texture is not None
    if target is None and not holds_map:
        raise MeshError(f"{name} holds no map (vt of an OBJ, X or X0 of a case); name a second file that does.")
    fixes = options.fixes or ("unreferenced", *(("seams",) if target is None else ()))
    fixed = apply_fixes(file.mesh, fixes).mesh
    kind = resolve_kind(fixed, options.map)
    mesh = source_for_kind(fixed, kind)
    positions = map_from_file(target or name, mesh, kind)
    adjusted = adjusted_start(mesh, kind, positions, match_area=False)
    if not np.array_equal(adjusted, positions):
        print("The map is mirrored as a whole; it is measured as its reflection.", file=sys.stderr)
    return mesh, adjusted


def _text(measured: dict[str, Any]) -> str:
    names = ("mean", "min", "p50", "p95", "max", "area_weighted_mean")
    rows = [["measure", *names]]
    rows += [[id, *(number(values[name]) for name in names)] for id, values in measured["measures"].items()]
    verdict = measured["injective"]
    words = {True: "yes", False: "no", None: "not known"}
    lines = (
        table(rows),
        "inverted {inverted}, degenerate {degenerate}, least det {min_det:.6g}".format_map(measured),
        f"locally injective: {words[verdict['local']]}, globally injective: {words[verdict['global']]}",
        verdict["reason"],
    )
    return "\n".join(lines) + "\n"
