"""`workbench check-solver`: whether a solver keeps the laws that every solver has to keep."""

from __future__ import annotations

import argparse
import os
from dataclasses import asdict
from typing import TYPE_CHECKING

from workbench.cli.options import amount
from workbench.cli.settings import add_set_option
from workbench.core.errors import WorkbenchError
from workbench.io.json_text import json_text
from workbench.io.tables import table

if TYPE_CHECKING:
    from workbench.core.solver_laws import Finding
    from workbench.engine.law_trial import Trial

BROKEN = 1

DESCRIPTION = """\
Tries a registered solver, or every solver that a plugin file defines, on small problems: a plane figure, a surface and a
solid, without anchors, with anchors in place and with anchors to move. The file is run, in a process of its own."""


def add_parser(name: str, commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = commands.add_parser(
        name,
        help="whether a solver, or a file with one of your own, keeps the laws of solvers",
        description=DESCRIPTION,
        epilog="Exit status 1: a law is broken.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("solver", metavar="ID|FILE.py", help="a registered solver, or a plugin file")
    add_set_option(parser, "the solver")
    parser.add_argument(
        "--time-limit", type=amount, default=60.0, metavar="SECONDS", help="of each law (default: 60)"
    )  # fmt: skip
    parser.add_argument("--json", action="store_true", help="a JSON list, an object a solver")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Try every law and print what holds."""
    from workbench.engine.law_trial import try_in_child

    found: dict[str, list[Finding]] = {}
    for trial in _trials(options):
        if not options.json:
            print(f"{trial.id}" + (f" in {trial.file}" if trial.file else ""))
        found[trial.id] = []
        for finding in try_in_child(trial, options.time_limit):
            found[trial.id].append(finding)
        if not options.json:
            print(_text(found[trial.id]))
    if options.json:
        objects = [
            {"solver": id, "keeps_all": all(f.holds for f in findings), "laws": [_facts(f) for f in findings]}
            for id, findings in found.items()
        ]
        print(json_text(objects), end="")
    return 0 if all(finding.holds for findings in found.values() for finding in findings) else BROKEN


def _trials(options: argparse.Namespace) -> list[Trial]:
    from workbench.core.registry import registry
    from workbench.engine.law_trial import Trial, solver_ids

    values = dict(options.settings)
    if options.solver in registry().solvers:
        registry().solver(options.solver).configured(dict(values))
        return [Trial(options.solver, "", values)]
    if not os.path.isfile(options.solver):
        known = ", ".join(sorted(registry().solvers))
        raise WorkbenchError(f"There is no solver and no file {options.solver!r}; solvers: {known}.")
    return [Trial(id, options.solver, values) for id in solver_ids(options.solver, options.time_limit)]


def _facts(finding: Finding) -> dict[str, object]:
    from workbench.core.solver_laws import LAWS

    return {**asdict(finding), "words": LAWS[finding.law].words}


def _text(findings: list[Finding]) -> str:
    from workbench.core.solver_laws import LAWS

    rows = [["  holds" if f.holds else "  BROKEN", f.law, LAWS[f.law].words] for f in findings]
    lines = []
    for line, finding in zip(table(rows).splitlines(), findings, strict=True):
        lines.append(line)
        if not finding.holds:
            lines.append(f"          on {finding.case or 'no problem yet'}: {finding.sentence}")
    kept = sum(finding.holds for finding in findings)
    return "\n".join([*lines, f"{kept} of {len(findings)} laws hold."])
