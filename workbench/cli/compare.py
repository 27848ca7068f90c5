"""`workbench compare`: solvers from one start on one problem, in a table, curves and a sheet of their maps."""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from workbench.cli.interrupt import InterruptFlag
from workbench.cli.options import add_problem_options
from workbench.cli.output import json_text, number, table, teller
from workbench.cli.threads import limit_threads
from workbench.core.errors import WorkbenchError

if TYPE_CHECKING:
    from workbench.cli.preparation import PreparedProblem
    from workbench.engine.contestants import Contestant, SolverChoice
    from workbench.engine.race import Race

RUN_FAILED = 1
SCHEMA = 1
PROGRESS_INTERVAL = 0.5
"""Seconds between two lines of progress."""
PRESET_IDS = ("acceleration", "anderson", "progressive")
ROWS = (0, 1, 5, 20, -1)

DESCRIPTION = """\
Solvers from one start on one problem, each with factors and a clock of its own. A solver is written
[LABEL=]ID[:NAME=VALUE]..., as in
    --solvers projected-newton,slim,plain=aqp:accelerate=no:eta=50
--set sets a parameter of the distortion, else of every solver that has it, else of the initializer."""

FILES = """\
DIR then holds table.csv, table.json (a row a contestant), history.csv (a row an iteration), curves.svg, .pdf and .png
(energy, relative error to the best, gradient norm, inverted simplices), sheet.png and .pdf (maps at chosen iterations).
With several meshes the curves and sheets stand in a folder a mesh. Exit status 1: a contestant failed; all is written."""


def add_parser(name: str, commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = commands.add_parser(
        name,
        help="solvers from one start: table, history, curves, sheet of maps",
        description=DESCRIPTION,
        epilog=FILES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    add = parser.add_argument
    add("files", nargs="+", metavar="FILE", help="mesh files, cases (.npz), or sample:ID")
    add("--solvers", metavar="A,B,...", help="solvers, separated by commas")
    add("--preset", choices=PRESET_IDS, help="solvers that are worth comparing, before those of --solvers")
    add(
        "--given", action="append", default=[], metavar="[LABEL=]FILE",
        help="a map from elsewhere (vt or positions of an OBJ, X of a case) as a contestant; may be given many times",
    )  # fmt: skip
    add("--out", required=True, metavar="DIR", help="folder of the results, made where it is missing")
    add("--turns", action="store_true", help="take turns by slices of time; default: one after another")
    add(
        "--rows", type=rows, default=ROWS, metavar="N,...",
        help="iterations on the sheet, `last` for the end (default: 0,1,5,20,last)",
    )  # fmt: skip
    add("--no-figures", dest="figures", action="store_false", help="tables alone, no curves and no sheet")
    add_problem_options(parser)
    parser.set_defaults(run=run, distortion=None)


def rows(text: str) -> tuple[int, ...]:
    """Iterations separated by commas; `last` is -1."""
    words = [word.strip() for word in text.split(",") if word.strip()]
    if not words or not all(word == "last" or word.isdecimal() for word in words):
        raise argparse.ArgumentTypeError(f"{text!r} is not of the form 0,1,5,last")
    return tuple(dict.fromkeys(-1 if word == "last" else int(word) for word in words))


def run(options: argparse.Namespace) -> int:
    """Race on every mesh, then write all results at once."""
    limit_threads(options.threads)
    from workbench.io.atomic import check_folder

    check_folder(options.out)
    from workbench.cli.preparation import prepare_problem
    from workbench.core.registry import registry
    from workbench.engine.contestants import PRESETS, check_labels, parse_choices

    preset = PRESETS[options.preset] if options.preset else None
    choices = (*(preset.choices if preset else ()), *parse_choices(options.solvers or ""))
    if len(choices) + len(options.given) < 1:
        raise WorkbenchError("There is nobody to compare; name solvers with --solvers A,B,... or a --preset.")
    if options.given and len(options.files) > 1:
        raise WorkbenchError("A map that is --given belongs to one mesh; compare one FILE at a time with it.")
    given = dict(_label_and_file(text) for text in options.given)
    check_labels([*(choice.label for choice in choices), *(_label_and_file(text)[0] for text in options.given)])
    options.distortion = options.distortion or (preset.distortion if preset else "") or "symmetric-dirichlet"
    methods = tuple(registry().solver(choice.solver) for choice in choices)
    tell = teller(options.quiet)
    prepared, contestants = [], []
    for file in options.files:
        problem, settings = prepare_problem(options, file, methods)
        prepared.append(problem)
        contestants.append(_contestants(problem, choices, settings, given, options.seed))
    with InterruptFlag() as interrupt:
        races = []
        for problem, entries in zip(prepared, contestants, strict=True):
            for note in problem.opened.notes:
                tell(note)
            races.append(_race(problem, entries, options, interrupt, tell))
        found = _write(prepared, races, options)
    if not options.quiet:
        print(_text(found))
        print(f"in {options.out}")
    failures = [row for row in found if _is_failure(row["status"])]
    for row in failures:
        print(f"workbench: {row['mesh']}, {row['contestant']}: {row['message']}", file=sys.stderr)
    return RUN_FAILED if failures else 0


def _label_and_file(text: str) -> tuple[str, str]:
    label, equals, file = text.partition("=")
    return (label, file) if equals and not os.path.exists(text) else (Path(text).name, text)


def _contestants(
    prepared: PreparedProblem, choices: tuple[SolverChoice, ...], settings: dict[str, str], given: dict[str, str], seed: int
) -> list[Contestant]:
    from workbench.cli.preparation import configured
    from workbench.core.registry import registry
    from workbench.engine.contestants import Contestant
    from workbench.io.opening import map_from_file

    found = []
    for choice in choices:
        method = registry().solver(choice.solver)
        method.configured(dict(choice.values))  # refuses names that it has not
        found.append(Contestant(choice.label, configured(method, {**settings, **choice.values}, seed)))
    mesh, kind = prepared.opened.mesh, prepared.opened.kind
    return found + [Contestant(label, None, map_from_file(file, mesh, kind)) for label, file in given.items()]


def _race(
    prepared: PreparedProblem,
    contestants: list[Contestant],
    options: argparse.Namespace,
    interrupt: InterruptFlag,
    tell: Callable[[str], None],
) -> Race:
    from workbench.core.problem import Criteria
    from workbench.engine.race import Limits, Race

    race = Race(
        prepared.problem,
        prepared.start,
        contestants,
        criteria=Criteria(options.tolerance, options.gradient_tolerance),
        limits=Limits(options.iterations, options.time_limit),
        pinned=[row for row in options.rows if row >= 0],
    )
    told = time.perf_counter()
    while not (race.is_over or interrupt()):
        if options.turns:
            racer = race.advance(interrupt=interrupt)
        else:
            racer = next(racer for racer in race.racers if racer.is_running)
            racer.step(interrupt)
        if racer is not None and time.perf_counter() - told >= PROGRESS_INTERVAL:
            told = time.perf_counter()
            row = racer.rows[-1]
            tell(f"{racer.label}  iteration {row.iteration}  energy {number(row.energy, 9)}  {racer.seconds:.1f} s")
    race.stop()
    return race


def _write(prepared: list[PreparedProblem], races: list[Race], options: argparse.Namespace) -> list[dict[str, Any]]:
    from workbench.engine.contestants import file_name
    from workbench.engine.race_table import history_rows, race_table
    from workbench.io.atomic import filling, write_text
    from workbench.io.write import csv_text

    names = _mesh_names(options.files)
    tables = [race_table(race, name) for name, race in zip(names, races, strict=True)]
    found = [row for rows in tables for row in rows]
    with filling(options.out) as folder:
        write_text(folder / "table.csv", csv_text(found))
        write_text(folder / "table.json", json_text(_report(prepared, tables, options)))
        histories = (row for name, race in zip(names, races, strict=True) for row in history_rows(race, name))
        write_text(folder / "history.csv", csv_text(histories))
        for name, race in zip(names, races, strict=True) if options.figures else ():
            place = folder / file_name(name) if len(names) > 1 else folder
            place.mkdir(exist_ok=True)
            _draw(race, name, options.rows, place)
    return found


def _draw(race: Race, name: str, rows: tuple[int, ...], folder: Path) -> None:
    from workbench.figures.contact_sheet import contact_sheet, sheet_columns
    from workbench.figures.convergence_curves import convergence_curves, curves_of
    from workbench.figures.save import save_figure, settle

    curves = convergence_curves(curves_of(race), name)
    sheet = contact_sheet(race.racers[0].problem, sheet_columns(race, rows), rows, name)
    for stem, figure, endings in (("curves", curves, (".svg", ".pdf", ".png")), ("sheet", sheet, (".png", ".pdf"))):
        settle(figure)
        for ending in endings:
            save_figure(figure, folder / f"{stem}{ending}")


def _mesh_names(files: list[str]) -> list[str]:
    """A name for each file: its last part without the ending, numbered where that is not enough."""
    names: list[str] = []
    for file in files:
        stem = Path(file.removeprefix("sample:")).stem
        taken = sum(name == stem or name.startswith(f"{stem}-") for name in names)
        names.append(f"{stem}-{taken + 1}" if taken else stem)
    return names


def _report(prepared: list[PreparedProblem], tables: list[list[dict[str, Any]]], options: argparse.Namespace) -> dict[str, Any]:
    from workbench.core.threads import thread_count
    from workbench.engine.doctor import versions

    distortion = prepared[0].problem.distortion
    return {
        "schema": SCHEMA,
        "distortion": {"id": distortion.id, "formula": distortion.formula, "parameters": distortion.parameter_values},
        "criteria": {
            "tolerance": options.tolerance,
            "gradient_tolerance": options.gradient_tolerance,
            "iterations": options.iterations,
            "time_limit": options.time_limit,
        },
        "turns": options.turns,
        "races": [
            {
                "input": {
                    "path": item.path,
                    "sha256": item.opened.file.sha256,
                    "kind": item.opened.kind,
                    "vertices": item.opened.mesh.vertex_count,
                    "simplices": item.opened.mesh.simplex_count,
                },
                "init": item.initializer,
                "contestants": rows,
            }
            for item, rows in zip(prepared, tables, strict=True)
        ],
        "threads": thread_count(),
        "versions": versions(),
    }


COLUMNS = {
    "mesh": "mesh",
    "contestant": "contestant",
    "status": "status",
    "iterations": "iterations",
    "seconds": "seconds",
    "factorisations": "factorised",
    "gradient_evaluations": "gradients",
    "energy_evaluations": "energies",
    "mean_distortion": "mean distortion",
    "relative_error": "relative error",
    "inverted": "inverted",
}


def _text(found: list[dict[str, Any]]) -> str:
    lines = [list(COLUMNS.values())]
    for row in found:
        lines.append([row[name] if isinstance(row[name], str) else _number(row[name]) for name in COLUMNS])
    return table(lines)


def _number(value: Any) -> str:
    return str(value) if isinstance(value, int) else number(value)


def _is_failure(status: str) -> bool:
    from workbench.core.status import Status

    return status == "FAILED" or (status in Status.__members__ and Status[status].is_failure)
