"""From the arguments to the exit status: 0 done or a limit of the user's, 1 the run failed, 2 bad usage or input."""

from __future__ import annotations

import argparse
import io
import os
import re
import sys
from collections.abc import Sequence
from pathlib import PurePath
from typing import NoReturn

from workbench import __version__
from workbench.cli import (
    check,
    check_solver,
    cite,
    compare,
    doctor,
    figure,
    fill,
    formula,
    listing,
    measure,
    open_window,
    refine,
    replay,
    signatures,
    solve,
)
from workbench.cli.output import full_sentence
from workbench.core.errors import SolverFailedError, WorkbenchError

DESCRIPTION = "Inversion-free maps of least distortion between simplicial meshes. Without a command: the window."
EPILOG = "`workbench FILE` opens the window on a mesh; `workbench COMMAND --help` explains a command."
RUN_FAILED, BAD_INPUT = 1, 2

COMMANDS = {
    "open": open_window,
    "list": listing,
    "solve": solve,
    "run": replay,
    "compare": compare,
    "measure": measure,
    "formula": formula,
    "signatures": signatures,
    "refine": refine,
    "fill": fill,
    "figure": figure,
    "check": check,
    "check-solver": check_solver,
    "cite": cite,
    "doctor": doctor,
}


class Parser(argparse.ArgumentParser):
    """A parser that refuses with one sentence."""

    def error(self, message: str) -> NoReturn:
        self.exit(BAD_INPUT, f"{self.prog}: {message}; see {self.prog} --help\n")


def main(arguments: Sequence[str] | None = None) -> int:
    """Carry out a command line (`sys.argv` where none is given) and return the exit status."""
    given = list(sys.argv[1:] if arguments is None else arguments)
    given[1:] = map(_as_formula, given[1:])
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="backslashreplace")  # what names of files have that is no text is shown all the same
    parser = build_parser()
    try:
        options = parser.parse_args(_with_command(given, parser))
    except SystemExit as exit:  # argparse has said what there is to say
        return exit.code if isinstance(exit.code, int) else BAD_INPUT
    try:
        return int(options.run(options))
    except SolverFailedError as error:
        _refuse(full_sentence(error))
        return RUN_FAILED
    except WorkbenchError as error:
        return _refuse(full_sentence(error))
    except KeyboardInterrupt:
        return _refuse("Interrupted before there was a result; nothing was written.")
    except BrokenPipeError:  # the reader of a pipe has gone, as after `| head`
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except OSError as error:
        return _refuse(f"{error.filename or 'A file'}: {error.strerror or error}.")
    except MemoryError:
        return _refuse("There is not enough memory for this mesh.")


def build_parser() -> argparse.ArgumentParser:
    """The parser of every command that there is."""
    parser = Parser(prog="workbench", description=DESCRIPTION, epilog=EPILOG)
    parser.add_argument("--version", action="version", version=f"workbench {__version__}")
    commands = parser.add_subparsers(title="commands", metavar="COMMAND", required=True)
    for name, module in COMMANDS.items():
        module.add_parser(name, commands)
    return parser


def _with_command(arguments: list[str], parser: argparse.ArgumentParser) -> list[str]:
    """`arguments` with `open` put first where no command is named: nothing, options of the window, or a file."""
    first = next((text for text in arguments if not text.startswith("-")), None)
    if arguments and arguments[0] in ("-h", "--help", "--version"):
        return arguments
    if first is None or (first is not arguments[0] and arguments[0].startswith("--theme")):
        return ["open", *arguments]
    if first not in COMMANDS and not _names_a_source(first):
        parser.error(f"unknown command {first!r}: the commands are {', '.join(COMMANDS)}; a mesh is named by its file")
    return arguments if first in COMMANDS else ["open", *arguments]


def _as_formula(text: str) -> str:
    """`text` with a blank before it where it is a formula that begins with a minus, which would be taken for an option."""
    return f" {text}" if re.match(r"-[a-z(]", text) and text != "-h" else text


def _names_a_source(text: str) -> bool:
    path = PurePath(text)
    return text.startswith("sample:") or bool(path.suffix) or len(path.parts) > 1 or os.path.exists(text)


def _refuse(sentence: str) -> int:
    print(f"workbench: {sentence}", file=sys.stderr)
    return BAD_INPUT
