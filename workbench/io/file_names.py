"""Names of files as other files have them: from the folder that they stand in, where that can be."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

SAMPLE = "sample:"
"""What the name of a sample begins with."""


def relative_name(name: str | os.PathLike[str], folder: str | os.PathLike[str]) -> str:
    """`name` as it is called from `folder`, links followed and with slashes; its whole path where it is on another drive."""
    try:
        return Path(os.path.relpath(os.path.realpath(name), os.path.realpath(folder))).as_posix()
    except ValueError:
        return Path(os.path.abspath(name)).as_posix()


def renamed(name: str, change: Callable[[str], str]) -> str:
    """`name` changed where it is that of a file; samples stay, and so does what names nothing."""
    return change(name) if name and not name.startswith(SAMPLE) else name
