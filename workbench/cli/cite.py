"""`workbench cite`: what to cite for a session, or for methods by name, as BibTeX."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING

from workbench.cli.output import check_places

if TYPE_CHECKING:
    from workbench.core.bibliography import Cited


def add_parser(name: str, commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = commands.add_parser(name, help="what to cite, as BibTeX: for a session, or for methods by name")
    add = parser.add_argument
    add("names", nargs="+", metavar="SESSION|METHOD", help="session files, and ids of distortions, solvers, initializers")
    add("--out", metavar="FILE.bib", help="write it there instead of printing it")
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Collect the methods, then print or write their bibliography; it always has the survey."""
    from workbench.core.bibliography import bibtex
    from workbench.io.atomic import write_text

    check_places([options.out] if options.out else [])
    text = bibtex(item for name in options.names for item in _cited(name))
    if options.out:
        write_text(options.out, text)
    else:
        print(text, end="")
    return 0


def _cited(name: str) -> tuple[Cited, ...]:
    from workbench.core.bibliography import methods_named
    from workbench.engine.citing import cited_in_file
    from workbench.engine.session_file import is_session_file

    return cited_in_file(name) if is_session_file(name) or Path(name).is_file() else methods_named(name)
