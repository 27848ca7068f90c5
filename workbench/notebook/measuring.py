"""How good a map is, as a mapping that shows itself as a table."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from workbench.core.arrays import Floats
from workbench.core.errors import WorkbenchError
from workbench.core.measure import Measure
from workbench.core.mesh import Mesh
from workbench.core.quality import measure_map, simplex_table
from workbench.engine.map_file import open_map
from workbench.io.measure_text import measure_lines, measure_rows
from workbench.io.opening import SAMPLE
from workbench.notebook.pictures import html_lines, html_table
from workbench.notebook.source import Source, source_of
from workbench.notebook.wording import in_words_of_scripts

if TYPE_CHECKING:
    from workbench.notebook.solution import Solution

Path = str | os.PathLike[str]
MapGiven = Path | tuple[Source | Mesh | Path, ArrayLike | Path]
"""A file that holds source and map, or the two apart: source, and positions (n, d) or a file of them."""


@dataclass(frozen=True, eq=False)
class Measured(Mapping[str, Any]):
    """All numbers about one map: the object of `workbench measure --json`, by key.

    `measures` {id: {mean, max, min, p50, p95, area_weighted_mean}}, `inverted`, `degenerate`, `min_det`,
    `injective` {local, global, reason}, `histogram78` {edges, counts}.
    """

    mesh: Mesh
    positions: Floats
    values_by_key: Mapping[str, Any]
    others: tuple[Measure, ...] = ()

    def __getitem__(self, key: str) -> Any:
        return self.values_by_key[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self.values_by_key)

    def __len__(self) -> int:
        return len(self.values_by_key)

    @cached_property
    def simplices(self) -> dict[str, Floats]:
        """Columns (m,) by name, a row a simplex: singular values, det, inverted, every measure, area or volume."""
        return simplex_table(self.mesh, self.positions, self.others)

    def __repr__(self) -> str:
        return "\n".join(measure_lines(self.values_by_key))

    def _repr_html_(self) -> str:
        _, *below = measure_lines(self.values_by_key)
        return html_table(measure_rows(self.values_by_key)) + html_lines(below)


@in_words_of_scripts
def measure(
    what: Solution | Source | MapGiven,
    target: ArrayLike | Path | None = None,
    *,
    distortions: Sequence[str] = (),
    kind: str = "auto",
    fixes: Sequence[str] = (),
) -> Measured:
    """Every measure of a map, as `workbench measure` finds them.

    Parameters
    ----------
    what           a result of `solve`, a loaded mesh with a map, a file that holds one, or (source, positions)
    target         the map where `what` is a source: positions (n, d), or a file
    distortions    ids or formulas that are measured beside all registered distortions
    kind, fixes    how files are read

    Raises `WorkbenchError` where there is no map, or where it does not fit.
    """
    others = tuple(Measure(text) for text in distortions)
    mesh, positions = map_given(what, target, kind, fixes)
    return measured_map(mesh, positions, others)


def measured_map(mesh: Mesh, positions: Floats, others: Iterable[Measure] = ()) -> Measured:
    """The measures of a map (n, d) of a source."""
    kept = tuple(others)
    return Measured(mesh, positions, measure_map(mesh, positions, kept), kept)


def map_given(
    what: Solution | Source | MapGiven, target: ArrayLike | Path | None = None, kind: str = "auto", fixes: Sequence[str] = ()
) -> tuple[Mesh, Floats]:
    """Source and map (n, d) in any of the forms that `measure` takes. Raises `WorkbenchError`."""
    given: Any = what
    if isinstance(given, tuple):
        if target is not None or len(given) != 2:
            raise WorkbenchError("A map is given as (source, positions), or as a source and a target.")
        given, target = given
    result = getattr(given, "result", None)
    if result is not None:
        return given.problem.mesh, result.state.positions
    is_file = isinstance(given, str | os.PathLike) and not os.fspath(given).startswith(SAMPLE)
    if is_file and (target is None or isinstance(target, str | os.PathLike)):
        found = open_map(os.fspath(given), None if target is None else os.fspath(target), kind=kind, fixes=tuple(fixes))
        return found.mesh, found.positions
    source = source_of(given, kind, fixes)
    if target is None:
        if source.map is None:
            raise WorkbenchError(f"{source!r} has no map; name one as the second argument.")
        return source.mesh, source.map
    if isinstance(target, str | os.PathLike):
        from workbench.io.opening import map_from_file

        return source.mesh, map_from_file(os.fspath(target), source.mesh, source.kind)
    positions = np.ascontiguousarray(target, dtype=np.float64)
    if positions.ndim != 2 or len(positions) != source.mesh.vertex_count or not np.isfinite(positions).all():
        raise WorkbenchError(
            f"The map has the shape {positions.shape}; finite numbers with {source.mesh.vertex_count} rows are needed."
        )
    return source.mesh, positions
