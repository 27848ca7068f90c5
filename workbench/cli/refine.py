"""`workbench refine`: a mesh and its map, refined together; distortion against the level (Fig. 20)."""

from __future__ import annotations

import argparse
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from workbench.cli.options import add_source_options, count
from workbench.cli.output import check_places, teller
from workbench.core.errors import MeshError, WorkbenchError
from workbench.io.json_text import json_text
from workbench.io.tables import number, table

if TYPE_CHECKING:
    from workbench.core.distortion import Distortion
    from workbench.core.refine import LevelMeasures
    from workbench.io.refinable import Refinable

SCHEMA = 1
SCHEME_IDS = ("linear", "loop", "catmull-clark")


def add_parser(name: str, commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = commands.add_parser(name, help="refine a mesh and its map together; distortion against level")
    add = parser.add_argument
    add("source", metavar="FILE", help="mesh file, case (.npz), or sample:ID; its vt (OBJ) or X, X0 (npz) is the map")
    add("target", nargs="?", metavar="TARGET", help="file of the map, where FILE holds none or another")
    add("--scheme", choices=SCHEME_IDS, default="linear", help="default: linear, which keeps every energy")
    add("--levels", type=count, default=1, metavar="K", help="how often (default: 1)")
    add(
        "--out", required=True, metavar="OUT", help="the refined mesh with its map: .obj, .npz, .vtu; a mesh alone: .mesh, .msh"
    )
    add_source_options(parser)
    add(
        "--measure", dest="measures", action="append", metavar="ID|FORMULA",
        help="distortion to measure at each level; may be given many times (default: mips, condition-number, arap)",
    )  # fmt: skip
    add("--plot", metavar="PLOT", help="mean distortion against level for every scheme: .png, .pdf or .svg")
    add("--report", metavar="REPORT.json", help="one JSON object: counts and mean distortions of every level")
    add("--quiet", action="store_true", help="no remarks; errors are still said")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Refine, measure where asked for, write."""
    from workbench.core.refine import refine
    from workbench.io.refinable import check_refined_place, open_refinable, write_refined

    check_places(path for path in (options.out, options.plot, options.report) if path)
    if options.plot:
        from workbench.figures.save import check_format

        check_format(options.plot)
    given = open_refinable(options.source, options.target, kind=options.map, fixes=options.fixes, tets=options.tets)
    check_refined_place(options.out, given)
    wants_measures = bool(options.plot or options.report or options.measures)
    if wants_measures and not given.has_map:
        raise MeshError(f"{options.source} holds no map to measure (vt of an OBJ, X or X0 of a case); name a TARGET that does.")
    tell = teller(options.quiet)
    for note in given.notes:
        tell(note)
    curves: dict[str, tuple[LevelMeasures, ...]] = {}
    if wants_measures:
        curves = _curves(given, options, _distortions(options.measures, given.mesh.dimension), tell)
    refined = refine(given.mesh, given.columns, options.scheme, options.levels)
    for note in write_refined(options.out, given, refined):
        tell(note)
    if options.plot:
        from workbench.figures.level_curves import level_curves
        from workbench.figures.save import save_figure

        save_figure(level_curves(curves, given.file.mesh.name), options.plot)
    if options.report:
        from workbench.io.atomic import write_text

        write_text(options.report, json_text(_report(given, options, curves)))
    if not options.quiet:
        if curves:
            print(_text(curves))
        noun = "triangles" if given.mesh.dimension == 2 else "tetrahedra"
        print(f"{given.mesh.simplex_count} -> {refined.mesh.simplex_count} {noun} by {options.scheme}; in {options.out}")
    return 0


def _distortions(texts: list[str] | None, dimension: int) -> list[Distortion]:
    """The distortions named, each compiled for the dimension, so that what is refused is refused at once."""
    from workbench.core.distortion import Distortion
    from workbench.core.refine import FIGURE_20

    chosen = [Distortion.resolve(text) for text in dict.fromkeys(texts or FIGURE_20)]
    for item in chosen:
        item.compiled(dimension)
    return chosen


def _curves(
    given: Refinable, options: argparse.Namespace, distortions: list[Distortion], tell: Any
) -> dict[str, tuple[LevelMeasures, ...]]:
    """Levels by scheme: the chosen one, and for a plot the others that the mesh allows."""
    from workbench.core.refine import measure_levels

    mesh, positions = given.to_measure()
    curves = {options.scheme: measure_levels(mesh, positions, options.scheme, options.levels, distortions)}
    for scheme in SCHEME_IDS if options.plot and mesh.dimension == 2 else ():
        if scheme != options.scheme:
            try:
                curves[scheme] = measure_levels(mesh, positions, scheme, options.levels, distortions)
            except WorkbenchError as error:
                tell(f"{scheme} is not in the plot. {error.sentence}")
    return {scheme: curves[scheme] for scheme in SCHEME_IDS if scheme in curves}


def _report(given: Refinable, options: argparse.Namespace, curves: dict[str, tuple[LevelMeasures, ...]]) -> dict[str, Any]:
    from workbench.engine.doctor import versions

    return {
        "schema": SCHEMA,
        "input": {
            "path": options.source,
            "sha256": given.file.sha256,
            "kind": given.kind,
            "vertices": given.mesh.vertex_count,
            "simplices": given.mesh.simplex_count,
        },
        "scheme": options.scheme,
        "levels": options.levels,
        "schemes": {scheme: [asdict(row) for row in rows] for scheme, rows in curves.items()},
        "versions": versions(),
    }


def _text(curves: dict[str, tuple[LevelMeasures, ...]]) -> str:
    names = list(next(iter(curves.values()))[0].measures)
    rows = [["scheme", "level", "simplices", "inverted", *names]]
    for scheme, levels in curves.items():
        rows += [
            [scheme, str(row.level), str(row.simplices), str(row.inverted), *(number(row.measures[name]) for name in names)]
            for row in levels
        ]
    return table(rows)
