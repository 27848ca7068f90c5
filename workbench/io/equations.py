"""Linear constraints as text, an equation a line."""

from __future__ import annotations

import os
from pathlib import Path

from workbench.core.errors import WorkbenchError
from workbench.core.linear_equations import read_equations
from workbench.io.atomic import write_text
from workbench.io.read import read_bytes
from workbench.io.text import decoded


def read_equation_file(path: str | os.PathLike[str]) -> tuple[str, ...]:
    """The equations of a file such as `x[12] - x[30] = 0`, a line each. Raises `WorkbenchError` that names file and line."""
    path = Path(path)
    try:
        return read_equations(decoded(path, read_bytes(path)))
    except WorkbenchError as error:
        named = error.sentence.startswith(str(path))
        raise error if named else WorkbenchError(f"{path}: {error.sentence}") from None


def write_equation_file(path: str | os.PathLike[str], equations: tuple[str, ...]) -> None:
    """One equation a line."""
    write_text(Path(path), "".join(line + "\n" for line in equations))
