"""`workbench solve`: map a mesh without a screen, with the numbers that the window shows."""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from workbench.cli.carrying import add_carry_options, carried_report, check_carry_options, read_carried, write_carried
from workbench.cli.filming import Filming, add_film_option
from workbench.cli.options import add_solve_options, wishes_of
from workbench.cli.output import check_places, teller
from workbench.cli.threads import limit_threads
from workbench.core.errors import WorkbenchError
from workbench.core.nouns import count_of
from workbench.engine.interrupt import InterruptFlag
from workbench.io.json_text import json_text
from workbench.io.tables import number

if TYPE_CHECKING:
    from workbench.cli.carrying import Carried
    from workbench.core.run import HistoryRow, RunResult
    from workbench.core.state import State
    from workbench.engine.preparation import Prepared

RUN_FAILED = 1
PROGRESS_INTERVAL = 0.5
"""Seconds between two lines of progress."""


def add_parser(name: str, commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = commands.add_parser(name, help="map a mesh and write the map")
    parser.add_argument("file", metavar="FILE", help="mesh file, case (.npz), or sample:ID")
    parser.add_argument(
        "--out", required=True, metavar="OUT", help="the map: .obj, .npz, .vtu, .mesh, .msh, or .csv of its measures"
    )
    add_solve_options(parser)
    add_carry_options(parser)
    add_film_option(parser)
    parser.add_argument("--report", metavar="REPORT.json", help="one JSON object about the run")
    parser.add_argument("--history", metavar="HISTORY.csv", help="a row an iteration")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Solve, and write the last map, report and history whatever the status."""
    limit_threads(options.threads)
    _check_outputs(options)
    from workbench.engine.preparation import prepare

    prepared = prepare(wishes_of(options), options.file, options.solver)
    carried = read_carried(options, prepared.opened)
    tell = teller(options.quiet)
    for note in (*prepared.opened.notes, *((carried.surface.note,) if carried and carried.surface.note else ())):
        tell(note)
    film = Filming(options.film, prepared) if options.film else None
    with InterruptFlag() as interrupt:
        result, fault = _solve(prepared, options, interrupt, tell, film.take if film else lambda state: None)
        report = _write(prepared, carried, options, result, fault)
        try:
            if film is not None:
                film.write(tell)
        except WorkbenchError as error:  # all else is there
            print(f"workbench: {error.sentence}", file=sys.stderr)
            return RUN_FAILED
    if not options.quiet:
        print(_summary(report, options.out))
    if report["status"] == "FAILED" or result.state.status.is_failure:
        print(f"workbench: {report['message']}", file=sys.stderr)
        return RUN_FAILED
    return 0


def _check_outputs(options: argparse.Namespace) -> None:
    from workbench.io.write import WRITABLE

    ending = Path(options.out).suffix.lower()
    if ending not in WRITABLE:
        raise WorkbenchError(f"{options.out}: maps are written as {', '.join(WRITABLE)}; choose one of these endings.")
    check_carry_options(options)
    check_places(path for path in (options.out, options.carried_out, options.report, options.history, options.film) if path)


def _solve(
    prepared: Prepared,
    options: argparse.Namespace,
    interrupt: InterruptFlag,
    tell: Callable[[str], None],
    on_state: Callable[[State], None],
) -> tuple[RunResult, str]:
    """The result, and the sentence of a solver that raised (a plugin's fault): then the result ends at its last map."""
    from workbench.engine.last_map_run import run_to_last_map

    told = time.perf_counter()

    def on_row(row: HistoryRow) -> None:
        nonlocal told
        if time.perf_counter() - told >= PROGRESS_INTERVAL:
            told = time.perf_counter()
            words = f"iteration {row.iteration}  energy {number(row.energy, 9)}  inverted {row.inverted}"
            tell(f"{words}  {row.seconds:.1f} s")

    return run_to_last_map(
        prepared.solver,
        prepared.problem,
        prepared.start,
        iterations=options.iterations,
        tolerance=options.tolerance,
        gradient_tolerance=options.gradient_tolerance,
        time_limit=options.time_limit,
        interrupt=interrupt,
        on_row=on_row,
        on_state=on_state,
    )


def _write(
    prepared: Prepared, carried: Carried | None, options: argparse.Namespace, result: RunResult, fault: str
) -> dict[str, Any]:
    from workbench.core.measure import Measure
    from workbench.engine.run_report import build_report, history_text
    from workbench.io.atomic import write_text
    from workbench.io.write import write_map

    opened, anchors = prepared.opened, prepared.problem.anchors
    write_map(
        options.out,
        opened.file.mesh,
        opened.mesh,
        result.state.positions,
        opened.kind,
        others=(Measure.of_distortion(prepared.problem.distortion),),
        anchor_vertices=anchors.vertices,
        anchor_targets=anchors.targets,
    )
    report = build_report(prepared, result)
    if fault:
        report |= {"status": "FAILED", "message": fault}
    if carried:
        report["carried"] = carried_report(carried, result.state.positions)
        if options.carried_out:
            write_carried(options.carried_out, carried, result.state.positions)
    if options.report:
        write_text(options.report, json_text(report))
    if options.history:
        write_text(options.history, history_text(result.rows))
    return report


def _summary(report: dict[str, Any], out: str) -> str:
    return (
        f"{report['status']} after {count_of(report['iterations'], 'iteration')} in {report['seconds']['total']:.3g} s: "
        f"mean distortion {number(report['mean_distortion'], 9)}, {report['inverted']} inverted; map in {out}"
    )
