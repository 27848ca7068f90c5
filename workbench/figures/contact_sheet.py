"""The contact sheet of a comparison: the maps of its solvers after some iterations, laid out as in Fig. 11."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from workbench.core.arrays import Floats
from workbench.core.measure import Measure
from workbench.figures.composer import compose, one_size
from workbench.figures.figure_maps import FigureMap
from workbench.figures.mesh_panel import scene_of
from workbench.figures.mesh_pictures import frame_round
from workbench.figures.recipe import Recipe
from workbench.figures.solver_sheet import SheetCell, sheet_page, sheet_panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from workbench.core.problem import Problem
    from workbench.engine.race import Race

LAST = -1
"""The row of the last maps."""


@dataclass(frozen=True, eq=False)
class SheetMap:
    """A map on the sheet, as it was after `iteration` steps."""

    iteration: int
    seconds: float
    positions: Floats


@dataclass(frozen=True, eq=False)
class SheetColumn:
    """A contestant: its map for every row; `is_constant` for a map from elsewhere."""

    label: str
    maps: tuple[SheetMap, ...]
    is_constant: bool = False


def sheet_columns(race: Race, rows: Sequence[int]) -> list[SheetColumn]:
    """The maps of a race after these iterations, `LAST` for the end; who ended before keeps its last map."""
    columns = []
    for racer in race.racers:
        frames = [racer.maps.frames[-1] if row == LAST else racer.maps.at_iteration(row) for row in rows]
        maps = tuple(SheetMap(frame.iteration, frame.seconds, frame.positions) for frame in frames)
        columns.append(SheetColumn(racer.label, maps, racer.solver is None))
    return columns


def contact_sheet(problem: Problem, columns: Sequence[SheetColumn], rows: Sequence[int], title: str = "") -> Figure:
    """The figure: targets coloured by the distortion of `problem` on one scale, inverted simplices yellow on top.

    Parameters
    ----------
    columns : sequence of SheetColumn     each with as many maps as there are `rows`
    rows : sequence of int                iterations, `LAST` for the end

    Tetrahedra are seen from outside. The sources carry a chequered texture of the coordinates of the last maps.
    """
    first = FigureMap("", problem.mesh, columns[0].maps[0].positions, problem.anchors.vertices)
    first.elements, first.skin  # noqa: B018  # found once, for all maps
    maps = {
        _name(i, j): first.moved(item.positions, problem.anchors.vertices)
        for j, column in enumerate(columns)
        for i, item in enumerate(column.maps)
    }
    cells = [
        [SheetCell(_name(i, j), _caption(column, column.maps[i], row)) for j, column in enumerate(columns)]
        for i, row in enumerate(rows)
    ]
    sources = [SheetCell(_name(len(rows) - 1, j), f"source, {column.label}") for j, column in enumerate(columns)]
    measure = Measure.of_distortion(problem.distortion)
    count, panels = sheet_panels(cells, sources, measure.text, dict(measure.parameters))
    shown = [frame_round(scene_of(maps[panel.maps[0]], panel).points).half for panel in panels if panel.kind == "map"]
    if one_size(shown) is None:
        title = f"{title} (each map fills its cell)".strip()
    return compose(Recipe(sheet_page(count, title), (), panels), maps).figure


def _name(row: int, column: int) -> str:
    return f"{row} {column}"


def _caption(column: SheetColumn, item: SheetMap, row: int) -> str:
    if column.is_constant:
        return f"{column.label}, given"
    if row == LAST:
        return f"{column.label}, last: {item.iteration} · {item.seconds:.3g} s"
    if item.iteration != row:
        return f"{column.label}, ended at {item.iteration}"
    return f"{column.label}, {row} · {item.seconds:.3g} s"
