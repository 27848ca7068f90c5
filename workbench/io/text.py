"""Text of any encoding."""

from __future__ import annotations

import codecs
from pathlib import Path

from workbench.core.errors import MeshError
from workbench.io.atomic import utf8


def decoded(path: Path, data: bytes) -> str:
    """Text of a file with lines ended by a newline alone.

    A byte order mark decides; then UTF-8; then Latin-1, which never fails: outside names and comments, the formats
    are plain ASCII. Raises `MeshError` for binary data.
    """
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        text = data.decode("utf-16", errors="replace")
    elif b"\0" in data:
        raise MeshError(f"{path}: it holds binary data, not the text that its name promises; is the ending right?")
    else:
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = data.decode("latin-1")
    return text.replace("\r\n", "\n").replace("\r", "\n")


def shown_name(name: str) -> str:
    r"""The name of a file for people: bytes in it that are no text stand as `\udcff` does."""
    return utf8(name).decode("utf-8")
