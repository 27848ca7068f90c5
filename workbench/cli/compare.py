"""`workbench compare`: solvers from one start on one problem, in a table, curves and a sheet of their maps."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from workbench.cli.options import add_problem_options, label_and_file
from workbench.cli.output import teller
from workbench.cli.threads import limit_threads
from workbench.core.errors import WorkbenchError
from workbench.engine.interrupt import InterruptFlag
from workbench.io.json_text import json_text
from workbench.io.tables import number, table

if TYPE_CHECKING:
    from workbench.cli.entries import Entry
    from workbench.engine.contestants import Contestant, SolverChoice
    from workbench.engine.preparation import PreparedProblem
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
With several meshes the curves and sheets stand in a folder a mesh. What does not fit a mesh, or a mesh that cannot be used,
is REFUSED in the table, and the rest goes on. Exit status 1: a contestant failed or was refused; all is written. Exit status
2: nothing could run, and nothing is written. Ctrl+C ends all runs; what they came to is written."""


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
    from workbench.cli.entries import complaints, enter_all
    from workbench.engine.contestants import PRESETS, check_labels, parse_choices

    preset = PRESETS[options.preset] if options.preset else None
    choices = (*(preset.choices if preset else ()), *parse_choices(options.solvers or ""))
    if not choices and not options.given:
        raise WorkbenchError("There is nobody to compare; name solvers with --solvers A,B,... or a --preset.")
    if options.given and len(options.files) > 1:
        raise WorkbenchError("A map that is --given belongs to one mesh; compare one FILE at a time with it.")
    given = dict(label_and_file(text) for text in options.given)
    check_labels([*(choice.label for choice in choices), *(label_and_file(text)[0] for text in options.given)])
    options.distortion = options.distortion or (preset.distortion if preset else "") or "symmetric-dirichlet"
    tell = teller(options.quiet)
    entries = enter_all(options, choices, given)
    complained = [_complain(sentence) for entry in entries for sentence in complaints(entry)]
    with InterruptFlag() as interrupt:
        races = {}
        for entry in entries:
            if entry.prepared is not None and entry.contestants:
                for note in entry.prepared.opened.notes:
                    tell(note)
                races[entry.name] = _race(entry.prepared, entry.contestants, options, interrupt, tell)
        found = _write(entries, races, choices, options)
    if not options.quiet:
        print(_text(found))
        print(f"in {options.out}")
    failures = [row for row in found if _is_failure(row["status"])]
    complained += [_complain(f"{row['mesh']}, {row['contestant']}: {row['message']}") for row in failures]
    return RUN_FAILED if complained else 0


def _complain(sentence: str) -> str:
    print(f"workbench: {sentence}", file=sys.stderr, flush=True)
    return sentence


def _race(
    prepared: PreparedProblem,
    contestants: Sequence[Contestant],
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


def _write(
    entries: list[Entry], races: dict[str, Race], choices: tuple[SolverChoice, ...], options: argparse.Namespace
) -> list[dict[str, Any]]:
    from workbench.cli.entries import refused_rows
    from workbench.engine.contestants import file_name
    from workbench.engine.race_table import history_rows, race_table
    from workbench.io.atomic import filling, write_text
    from workbench.io.write import csv_text

    tables = {name: race_table(race, name) for name, race in races.items()}
    columns = list(next(iter(tables.values()))[0])
    solvers = {choice.label: choice.solver for choice in choices}
    for entry in entries:
        tables[entry.name] = tables.get(entry.name, []) + refused_rows(entry, solvers, columns)
    found = [row for entry in entries for row in tables[entry.name]]
    with filling(options.out) as folder:
        write_text(folder / "table.csv", csv_text(found))
        write_text(folder / "table.json", json_text(_report(entries, tables, options)))
        histories = (row for name, race in races.items() for row in history_rows(race, name))
        write_text(folder / "history.csv", csv_text(histories))
        for name, race in races.items() if options.figures else ():
            place = folder / file_name(name) if len(entries) > 1 else folder
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


def _report(entries: list[Entry], tables: dict[str, list[dict[str, Any]]], options: argparse.Namespace) -> dict[str, Any]:
    from workbench.core.threads import thread_count
    from workbench.engine.doctor import versions

    distortion = next(entry.prepared.problem.distortion for entry in entries if entry.prepared is not None)
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
        "races": [_race_report(entry, tables[entry.name]) for entry in entries],
        "threads": thread_count(),
        "versions": versions(),
    }


def _race_report(entry: Entry, rows: list[dict[str, Any]]) -> dict[str, Any]:
    prepared = entry.prepared
    if prepared is None:
        return {"input": {"path": entry.path}, "refused": entry.reason, "contestants": rows}
    opened = prepared.opened
    source = {
        "path": prepared.path,
        "sha256": opened.file.sha256,
        "kind": opened.kind,
        "vertices": opened.mesh.vertex_count,
        "simplices": opened.mesh.simplex_count,
    }
    return {"input": source, "init": prepared.initializer, "contestants": rows}


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
