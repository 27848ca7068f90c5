"""`workbench run`: repeat a session without a screen, with the energies that the window showed."""

from __future__ import annotations

import argparse
import sys
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from workbench.cli.options import positive_count
from workbench.cli.output import teller
from workbench.cli.threads import limit_threads
from workbench.core.errors import WorkbenchError
from workbench.core.nouns import count_of
from workbench.engine.interrupt import InterruptFlag
from workbench.io.json_text import json_text
from workbench.io.tables import number

if TYPE_CHECKING:
    from workbench.engine.replay import Replayed
    from workbench.io.opening import OpenedSource
    from workbench.session.record import SessionRecord

RUN_FAILED = 1
SAME_ENERGY = 1e-10
"""Relative difference of energies that counts as none."""


def add_parser(name: str, commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = commands.add_parser(name, help="repeat a session of the window")
    add = parser.add_argument
    add("file", metavar="SESSION", help="session file: .dwb, or .json")
    add("--out", metavar="DIR", help="folder for map, report.json, history.csv and anchors.csv")
    add("--script", metavar="FILE.py", help="write a Python script that repeats the session; nothing is run without --out")
    add("--mesh", metavar="FILE", help="the mesh, where it is not at the place that the session names, or was changed")
    add("--threads", type=positive_count, metavar="N", help="threads of the kernels and the linear algebra")
    add("--quiet", action="store_true", help="no progress; errors are still said")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Repeat what led to the map, write it, and say whether its energy is the one that was recorded."""
    limit_threads(options.threads)
    from workbench.engine.replay import replay
    from workbench.engine.session_file import read_session
    from workbench.io.atomic import check_folder
    from workbench.io.opening import open_source

    if not (options.out or options.script):
        raise WorkbenchError("Name a folder with --out, or a Python script to write with --script.")
    if options.out:
        check_folder(options.out)
    record = _with_mesh(read_session(options.file), options.mesh)
    session = record.session
    opened = open_source(session.source, kind=session.kind, fixes=session.fixes)
    tell = teller(options.quiet)
    for note in opened.notes:
        tell(note)
    if options.script:
        _write_script(options, record, opened)
    if not options.out:
        return 0
    with InterruptFlag() as interrupt:
        found = replay(record, opened, interrupt=interrupt)
        report = _write(options, record, opened, found)
    if not options.quiet:
        print(_summary(report, options.out))
    if report["session"]["same_energy"] is False:
        print("workbench: The energy is not the one that was recorded; the map was written all the same.", file=sys.stderr)
        return RUN_FAILED
    if record.map is None and not record.legs and found.result.state.status.is_failure:  # it was solved here and now
        print(f"workbench: {report['message']}", file=sys.stderr)
        return RUN_FAILED
    return 0


def _write_script(options: argparse.Namespace, record: SessionRecord, opened: OpenedSource) -> None:
    from workbench.engine.python_script import write_script

    write_script(options.script, replace(record, sha256="") if options.mesh else record, opened)
    if not options.quiet:
        print(f"A script that repeats the session: {options.script}")


def _with_mesh(record: SessionRecord, mesh: str | None) -> SessionRecord:
    """The session on the mesh that is to be used; a missing or changed one is asked for, not guessed."""
    from workbench.engine.session_file import source_trouble

    if mesh is not None:
        return replace(record, session=replace(record.session, source=mesh))
    trouble = source_trouble(record)
    if trouble:
        raise WorkbenchError(f"{trouble} Name the mesh to use with --mesh.")
    return record


def _write(options: argparse.Namespace, record: SessionRecord, opened: OpenedSource, found: Replayed) -> dict[str, Any]:
    from workbench.engine.preparation import Prepared
    from workbench.engine.run_report import build_report, history_text
    from workbench.io.anchor_rows import AnchorTable
    from workbench.io.anchors import write_anchors
    from workbench.io.atomic import filling, write_text
    from workbench.io.write import write_map

    result, positions = found.result, found.result.state.positions
    prepared = Prepared(
        path=record.session.source,
        opened=opened,
        problem=found.problem,
        initializer=found.initializer,
        start=result.initial.positions,
        solver=found.solver,
    )
    report = {**build_report(prepared, result), "session": _comparison(options.file, record, found)}
    anchors = found.problem.anchors
    with filling(options.out) as folder:
        case = folder / "map.npz"
        held: dict[str, Any] = {"anchor_vertices": anchors.vertices, "anchor_targets": anchors.targets}
        for path in (case, folder / ("map.obj" if opened.kind != "volume" else "map.vtu")):
            write_map(path, opened.file.mesh, opened.mesh, positions, opened.kind, **held)
        write_text(folder / "report.json", json_text(report))
        write_text(folder / "history.csv", history_text(result.rows))
        if len(anchors.vertices):
            held_ones = AnchorTable(anchors.vertices, anchors.targets, anchors.weights, anchors.groups)
            write_anchors(folder / "anchors.csv", held_ones)
        _write_carried(folder, record, opened, found)
    return report


def _write_carried(folder: Path, record: SessionRecord, opened: OpenedSource, found: Replayed) -> None:
    if not record.session.carried:
        return
    from workbench.engine.carried_source import carry_source
    from workbench.io.write import write_surface

    surface = carry_source(record.session.carried, opened.mesh)
    write_surface(folder / "carried.obj", surface.surface, surface.at(found.result.state.positions))


def _comparison(path: str, record: SessionRecord, found: Replayed) -> dict[str, Any]:
    """What the report says of the session: the energy that was recorded, and how near the new one is."""
    recorded, energy = record.energy, found.result.state.energy
    apart = None if recorded is None else abs(energy - recorded) / max(abs(recorded), 1e-300)
    return {
        "path": path,
        "legs": len(record.legs),
        "recorded_energy": recorded,
        "relative_difference": apart,
        "same_energy": None if apart is None else apart <= SAME_ENERGY,
        "farthest_vertex": found.farthest,
    }


def _summary(report: dict[str, Any], out: str) -> str:
    session = report["session"]
    legs = f" in {count_of(session['legs'], 'leg')}" if session["legs"] else ""
    head = f"{count_of(report['iterations'], 'iteration')}{legs}: energy {number(report['energy'], 12)}"
    if session["same_energy"] is None:
        words = "no energy was recorded"
    elif session["same_energy"]:
        words = "as recorded"
    else:
        words = f"recorded was {number(session['recorded_energy'], 12)}"
    return f"{head}, {words}; {report['inverted']} inverted; written to {out}"
