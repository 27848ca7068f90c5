"""The steps that led to a map, as a table in a file: what `workbench solve --history` writes."""

from __future__ import annotations

import csv
import math
import os
from collections.abc import Iterable
from dataclasses import asdict, fields
from pathlib import Path

from workbench.core.errors import WorkbenchError
from workbench.core.run import HistoryRow
from workbench.io.atomic import write_text
from workbench.io.read import read_bytes
from workbench.io.write import csv_text

LARGEST = 2**26
WHOLE = ("iteration", "inverted")
NEEDED = ("iteration", "energy", "gradient_norm", "inverted")


def write_history(path: str | os.PathLike[str], rows: Iterable[HistoryRow]) -> None:
    """Write rows as a table."""
    write_text(path, csv_text(asdict(row) for row in rows))


def read_history(path: str | os.PathLike[str]) -> tuple[HistoryRow, ...]:
    """The rows of a table; what a column that is not there would say is no number. Raises `WorkbenchError`."""
    data = read_bytes(Path(path))
    if len(data) > LARGEST:
        raise WorkbenchError(f"{path}: it is too large for a history.")
    try:
        found = list(csv.DictReader(data.decode("utf-8-sig").splitlines()))
        if not found:
            raise ValueError
        return tuple(_row(line) for line in found)
    except (UnicodeDecodeError, csv.Error, KeyError, TypeError, ValueError, OverflowError):
        raise WorkbenchError(
            f"{path}: it is no history: a table with the columns {', '.join(NEEDED)} is needed, and numbers in them."
        ) from None


def _row(line: dict[str, str]) -> HistoryRow:
    values = {name: float(line[name] or "nan") for name in line if name in {field.name for field in fields(HistoryRow)}}
    if not set(NEEDED) <= set(values):
        raise KeyError
    whole = {name: int(values[name]) for name in WHOLE}
    rest = {field.name: math.nan for field in fields(HistoryRow)}
    return HistoryRow(**(rest | values | whole))  # type: ignore[arg-type]
