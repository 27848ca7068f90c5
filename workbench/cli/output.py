"""What is printed and written: strict JSON, tables, places that can be written to."""

from __future__ import annotations

import json
import math
import os
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from workbench.core.errors import WorkbenchError


def plain(value: Any) -> Any:
    """`value` as JSON can hold it: NumPy's types become Python's, numbers that are not finite become None."""
    if isinstance(value, Mapping):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, str) or value is None or isinstance(value, bool):
        return value
    if hasattr(value, "tolist"):  # arrays and scalars of NumPy
        return plain(value.tolist())
    if isinstance(value, int):
        return value
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Iterable):
        return [plain(item) for item in value]
    return str(value)


def json_text(value: Any) -> str:
    """JSON with a line break at its end; no NaN, no Infinity."""
    return json.dumps(plain(value), indent=2, allow_nan=False, ensure_ascii=False) + "\n"


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


def table(rows: Sequence[Sequence[str]]) -> str:
    """Left-aligned columns, two spaces apart; the last column is not padded."""
    if not rows:
        return ""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    lines = ("  ".join(text.ljust(width) for text, width in zip(row, widths, strict=True)).rstrip() for row in rows)
    return "\n".join(lines)


def number(value: Any, digits: int = 6) -> str:
    """A number as people read it."""
    if value is None:
        return "-"
    return f"{float(value):.{digits}g}"
