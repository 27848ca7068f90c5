"""`workbench`, `workbench FILE`, `workbench open FILE`: the window."""

from __future__ import annotations

import argparse
import os

from workbench.core.errors import WorkbenchError


def add_parser(name: str, commands: argparse._SubParsersAction[argparse.ArgumentParser]) -> None:
    parser = commands.add_parser(name, help="open the window; also without the word: workbench FILE")
    parser.add_argument("source", nargs="?", metavar="FILE", help="mesh file, or sample:ID; without it a sample")
    themes, when = ("system", "light", "dark"), "default: your last choice, at first the system's"
    parser.add_argument("--theme", choices=themes, default="", help=f"colours ({when})")
    reset = "begin with the defaults: layout, views and preferences are forgotten, recent files and formulas are not"
    parser.add_argument("--reset", action="store_true", help=reset)
    parser.set_defaults(run=run)


def run(options: argparse.Namespace) -> int:
    """Open the window and stay until it is closed."""
    source = options.source
    if source and not source.startswith("sample:") and not os.path.isfile(source):
        raise WorkbenchError(f"There is no file {source}; name a mesh file, or sample:ID (workbench list samples).")
    os.environ.setdefault("QT_API", "pyside6")
    try:
        from workbench.app.main import run_window
    except ImportError as error:
        raise WorkbenchError(
            f"The window cannot be loaded ({error}); `workbench doctor` says what is missing and how to install it."
        ) from error
    return int(run_window(source, theme=options.theme, reset=options.reset))
