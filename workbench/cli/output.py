"""What is printed: sentences, progress; places that can be written to."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

from workbench.core.errors import WorkbenchError


def full_sentence(error: WorkbenchError) -> str:
    """The sentence, with the place in a formula, or the `--fix` that helps, where it does not name them itself."""
    position = getattr(error, "position", 0)
    if position:
        return f"{error.sentence} (at character {position + 1} of the formula)"
    if error.fixes and "--fix" not in error.sentence:
        return f"{error.sentence} Add --fix {','.join(error.fixes)}."
    return error.sentence


def check_places(paths: Iterable[str]) -> None:
    """Raise `WorkbenchError` unless each file can be written: better now than after the work is done."""
    seen: set[Path] = set()
    for text in paths:
        path = Path(text).absolute()
        if path in seen:
            raise WorkbenchError(f"Two outputs have the same name {text}; give each a file of its own.")
        seen.add(path)
        if path.is_dir():
            raise WorkbenchError(f"{text} is a folder; name a file to write.")
        if not path.parent.is_dir():
            raise WorkbenchError(f"There is no folder {path.parent}; make it first, or name another place.")
        if not os.access(path.parent, os.W_OK):
            raise WorkbenchError(f"{text} may not be written (permission denied); name another place.")


def teller(quiet: bool) -> Callable[[str], None]:
    """What takes remarks and progress: standard error, or nothing."""
    return _silent if quiet else _say


def _say(sentence: str) -> None:
    print(sentence, file=sys.stderr, flush=True)


def _silent(sentence: str) -> None:
    pass
