"""`workbench measure`: how good a map is."""

from __future__ import annotations

import argparse
import sys
from typing import TYPE_CHECKING

from workbench.cli.options import add_source_options
from workbench.cli.output import check_places
from workbench.cli.settings import add_set_option
from workbench.core.errors import WorkbenchError
from workbench.io.json_text import json_text

if TYPE_CHECKING:
    from workbench.core.measure import Measure
    from workbench.engine.map_file import MapFile


def add_parser(name: str, commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = commands.add_parser(name, help="every measure of a map, inverted simplices, injectivity verdicts")
    add = parser.add_argument
    add("source", metavar="SOURCE", help="mesh file; without TARGET its vt (OBJ) or X (npz) is the map")
    add("target", nargs="?", metavar="TARGET", help="file of the map: vt, X, or positions")
    add_source_options(parser)
    add(
        "--distortion", dest="distortions", action="append", default=[], metavar="ID|FORMULA",
        help="measure this, too; may be given many times",
    )  # fmt: skip
    add_set_option(parser, "the distortions named, each that has it")
    add(
        "--simplices", metavar="OUT.csv|OUT.vtu",
        help="write singular values, det, every measure, area or volume of each simplex: a table, or fields on the map",
    )  # fmt: skip
    add("--json", action="store_true", help="one JSON object")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Measure, print, write."""
    from workbench.core.quality import measure_map, simplex_table
    from workbench.io.measure_text import measure_lines
    from workbench.io.write import write_simplices

    check_places([options.simplices] if options.simplices else [])
    others = _measures(options.distortions, options.settings)
    opened = open_given_map(options)
    measured = measure_map(opened.mesh, opened.positions, others)
    if options.simplices:
        table = simplex_table(opened.mesh, opened.positions, others)
        write_simplices(options.simplices, opened.mesh, opened.positions, table)
    print(json_text(measured) if options.json else "\n".join(measure_lines(measured)) + "\n", end="")
    return 0


def open_given_map(options: argparse.Namespace) -> MapFile:
    """The map that the options name; says so where it is measured as its reflection."""
    from workbench.engine.map_file import open_map

    opened = open_map(options.source, options.target, kind=options.map, fixes=tuple(options.fixes), tets=options.tets)
    if opened.was_mirrored:
        print("The map is mirrored as a whole; it is measured as its reflection.", file=sys.stderr)
    return opened


def _measures(texts: list[str], settings: list[tuple[str, str]]) -> tuple[Measure, ...]:
    """The measures named, with the settings that each of them has. Raises `WorkbenchError` for one that none has."""
    from workbench.core.distortion import Distortion
    from workbench.core.measure import DESCRIPTORS, Measure
    from workbench.engine.parameter_owners import assign, distortion_parameters

    forms = {text: () if text in DESCRIPTORS else distortion_parameters(text) for text in texts}
    for name, _ in settings:
        if not any(name in form for form in forms.values()):
            known = ", ".join(dict.fromkeys(item for form in forms.values() for item in form)) or "none"
            raise WorkbenchError(f"There is no parameter {name!r} to set; there are: {known}.")
    measures = []
    for text, form in forms.items():
        if text in DESCRIPTORS:
            measures.append(Measure(text))
            continue
        (values,) = assign([(name, value) for name, value in settings if name in form], text)
        given = Distortion.resolve(text, values).parameter_values
        measures.append(Measure.of(text, {name: given[name] for name in values}))
    return tuple(measures)
