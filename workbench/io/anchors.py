"""Anchors as CSV: header `vertex,x,y[,z][,weight]`, vertices from 0."""

from __future__ import annotations

import csv
import math
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from workbench.core.arrays import Floats, Integers, frozen
from workbench.core.errors import WorkbenchError
from workbench.io.atomic import write_text
from workbench.io.mesh_file import LARGEST_COORDINATE
from workbench.io.read import read_bytes
from workbench.io.text import decoded


@dataclass(frozen=True, eq=False)
class AnchorTable:
    """Anchors as a file has them.

    Parameters
    ----------
    vertices : (k,) int64
    targets : (k, d) float64
    weights : (k,) float64      inf is hard (where the file has no weights), finite is a penalty
    """

    vertices: Integers
    targets: Floats
    weights: Floats

    def __post_init__(self) -> None:
        object.__setattr__(self, "vertices", frozen(self.vertices, np.int64))
        object.__setattr__(self, "targets", frozen(self.targets))
        object.__setattr__(self, "weights", frozen(self.weights))


def read_anchors(path: str | os.PathLike[str], vertex_count: int, dimension: int) -> AnchorTable:
    """Anchors of a CSV file for a map of `dimension` columns on a mesh of `vertex_count` vertices.

    Raises `WorkbenchError` with the line that is wrong: a vertex out of range or twice, a number that is not finite.
    """
    path = Path(path)
    lines = decoded(path, read_bytes(path)).split("\n")
    rows = [(number, row) for number, line in enumerate(lines, 1) if line.strip() for row in csv.reader([line])]
    axes = ("x", "y", "z")[:dimension]
    header = [name.strip().lower() for name in rows[0][1]] if rows else []
    plain = ["vertex", *axes]
    if header not in (plain, [*plain, "weight"]):
        raise WorkbenchError(
            f"{path}: the first line is {','.join(header)[:80]!r}; "
            f"for this map it has to be '{','.join(plain)}' or '{','.join(plain)},weight'."
        )
    seen: dict[int, int] = {}
    targets, weights = [], []
    for line, row in rows[1:]:
        if len(row) != len(header):
            raise WorkbenchError(f"{path}, line {line}: it has {len(row)} fields, and the header has {len(header)}.")
        vertex = _vertex(path, line, row[0], vertex_count)
        if vertex in seen:
            raise WorkbenchError(f"{path}, line {line}: vertex {vertex} has an anchor already, in line {seen[vertex]}.")
        seen[vertex] = line
        targets.append([_coordinate(path, line, word) for word in row[1 : 1 + dimension]])
        weights.append(_weight(path, line, row[-1]) if len(header) > len(plain) else math.inf)
    return AnchorTable(
        np.array(list(seen), dtype=np.int64), np.array(targets).reshape(-1, dimension), np.array(weights)
    )  # fmt: skip


def write_anchors(path: str | os.PathLike[str], vertices: Integers, targets: Floats, weights: Floats) -> None:
    """Anchors as a CSV that reads back to the same numbers; the column `weight` only where one is finite."""
    weighted = bool(np.isfinite(weights).any())
    header = ["vertex", *("x", "y", "z")[: targets.shape[1]], *(["weight"] if weighted else [])]
    lines = [",".join(header)]
    for vertex, target, weight in zip(vertices.tolist(), targets.tolist(), weights.tolist(), strict=True):
        numbers = [*target, weight] if weighted else target
        lines.append(",".join([str(vertex), *(f"{number:.17g}" for number in numbers)]))
    write_text(path, "\n".join(lines) + "\n")


def _vertex(path: Path, line: int, word: str, vertex_count: int) -> int:
    try:
        vertex = int(word)
    except ValueError:
        raise WorkbenchError(f"{path}, line {line}: {word[:40]!r} is not the number of a vertex.") from None
    if not 0 <= vertex < vertex_count:
        raise WorkbenchError(f"{path}, line {line}: there is no vertex {vertex}; the mesh has {vertex_count}, numbered from 0.")
    return vertex


def _coordinate(path: Path, line: int, word: str) -> float:
    try:
        value = float(word)
    except ValueError:
        raise WorkbenchError(f"{path}, line {line}: {word[:40]!r} is not a number.") from None
    if not abs(value) <= LARGEST_COORDINATE:
        raise WorkbenchError(f"{path}, line {line}: the coordinate {word.strip()[:40]} is not finite, or too large.")
    return value


def _weight(path: Path, line: int, word: str) -> float:
    if not word.strip():
        return math.inf
    try:
        value = float(word)
    except ValueError:
        value = math.nan
    if not value > 0:
        raise WorkbenchError(f"{path}, line {line}: the weight {word.strip()[:40]!r} is not a positive number or inf.")
    return value
