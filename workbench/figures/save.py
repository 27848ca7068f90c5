"""Writing a figure: PNG, PDF or SVG, whole or not there, the same bytes for the same figure."""

from __future__ import annotations

import io
import os
from pathlib import Path
from typing import TYPE_CHECKING

from workbench.core.errors import WorkbenchError
from workbench.io.atomic import write_bytes

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FORMATS = (".png", ".pdf", ".svg")

NO_DATES = {".png": {"Software": None}, ".pdf": {"CreationDate": None}, ".svg": {"Date": None}}

SETTINGS = {"svg.hashsalt": "figure", "pdf.fonttype": 42}
"""Names inside an SVG are drawn by lot unless they are salted; publishers want the fonts of a PDF as outlines."""


def check_format(path: str | os.PathLike[str]) -> str:
    """The ending of `path`. Raises `WorkbenchError` unless it is one of `FORMATS`."""
    ending = Path(path).suffix.lower()
    if ending not in FORMATS:
        raise WorkbenchError(f"{path}: figures are written as {', '.join(FORMATS)}; choose one of these endings.")
    return ending


def settle(figure: Figure) -> None:
    """Lay out `figure` once for all; else it is laid out anew, the same, for every file that it is saved in."""
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
        figure.set_layout_engine("none")


def figure_bytes(figure: Figure, ending: str, dpi: int = 160) -> bytes:
    """`figure` in the format of an ending out of `FORMATS`; `dpi` is that of pixels."""
    import matplotlib

    stream = io.BytesIO()
    with matplotlib.rc_context(SETTINGS):
        figure.savefig(stream, format=ending[1:], dpi=dpi, metadata=NO_DATES[ending])
    return stream.getvalue()


def save_figure(figure: Figure, path: str | os.PathLike[str], dpi: int = 160) -> None:
    """Write `figure` in the format of the ending of `path`; `dpi` is that of pixels.

    Raises `WorkbenchError` where it cannot be written.
    """
    ending = check_format(path)
    write_bytes(path, figure_bytes(figure, ending, dpi))
