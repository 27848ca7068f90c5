"""The contact sheet of a comparison: a column a contestant, a row an iteration, the textured source at the right (Fig. 11)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.jacobians import determinants, signed_singular_values
from workbench.figures.colour_scale import INVERTED, colour_scale
from workbench.figures.mesh_pictures import (
    OFF_CORNERS,
    Skin,
    coloured_picture,
    frame_round,
    skin_of,
    texture_square,
    textured_picture,
    view_of,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure

    from workbench.core.problem import Problem
    from workbench.engine.race import Race

LAST = -1
"""The row of the last maps."""
MOST_SPREAD = 1.8
"""Times the median size that a map may have for all to be drawn on one scale of length."""
THICKEST = 0.15
"""Part of a map's area that the line round it may cover; else it is left out."""
OUTLINE = 0.35
"""Width of that line, points."""
CELL = 1.75
"""Width and height of a picture, inches."""
SOURCE = 1.25
"""Least height of a textured source, inches."""
TEXTURED = 1.9
"""Width of the column of textured sources, inches."""


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

    Tetrahedra are seen from outside. The sources at the right carry a chequered texture of the target's coordinates.
    """
    from matplotlib.figure import Figure

    mesh = problem.mesh
    skin = skin_of(mesh)
    view = view_of(mesh) if mesh.vertices.shape[1] == 3 else None
    paint = _colour_scale(problem, columns, skin)
    turned = [[_turned(item.positions, view) for item in column.maps] for column in columns]
    half = _common_half(turned)
    height = CELL if half is None else CELL * min(1.5, max(0.3, half[1] / half[0]))
    tall = max((height + 0.3) * len(rows), SOURCE * len(columns)) + 1.1
    figure = Figure(figsize=(CELL * len(columns) + TEXTURED + 0.5, tall), layout="constrained")
    grid = figure.add_gridspec(1, 2, width_ratios=[CELL * len(columns), TEXTURED])
    left = grid[0].subgridspec(len(rows), len(columns)).subplots(squeeze=False)
    right = grid[1].subgridspec(len(columns), 1).subplots(squeeze=False)[:, 0]
    for j, column in enumerate(columns):
        for i, item in enumerate(column.maps):
            cell = left[i, j]
            _draw_target(cell, problem, skin, paint, turned[j][i], item.positions, half)
            cell.set_title(_caption(column, item, rows[i]), fontsize=6.5, pad=2, parse_math=False)
            if i == 0:
                cell.annotate(
                    column.label, (0.5, 1), (0, 14), xycoords="axes fraction", textcoords="offset points",
                    ha="center", fontsize=9, parse_math=False,
                )  # fmt: skip
            if j == 0:
                cell.set_ylabel("last" if rows[i] == LAST else f"iteration {rows[i]}", fontsize=8)
        _draw_source(right[j], problem, skin, view, column)
    bar = figure.colorbar(paint, ax=list(left.ravel()), location="bottom", extend="max", shrink=0.6, aspect=40, pad=0.01)
    bar.set_label(_distortion_name(problem), fontsize=8, parse_math=False)
    bar.ax.tick_params(labelsize=7)
    if half is None:
        title = f"{title} (each map fills its cell)".strip()
    if title:
        figure.suptitle(title, fontsize=10, parse_math=False)
    return figure


def _common_half(maps: Sequence[Sequence[Floats]]) -> tuple[float, float] | None:
    """Half the width and height of cells that hold every map on one scale; None where some are far larger than most."""
    centred = [points[:, :2] - _middle(points[:, :2]) for each in maps for points in each]
    sizes = np.array([np.abs(points).max() for points in centred])
    if sizes.max() > MOST_SPREAD * np.median(sizes):
        return None
    return frame_round(np.vstack(centred)).half


def _square_round(points: Floats) -> tuple[float, float]:
    """Half the sides of a square that holds a map."""
    side = max(frame_round(points).half)
    return side, side


def _colour_scale(problem: Problem, columns: Sequence[SheetColumn], skin: Skin) -> ScalarMappable:
    """One scale for all maps."""
    maps = [item.positions for column in columns for item in column.maps]
    values = np.concatenate([_upright_distortions(problem, positions, skin) for positions in maps])
    return colour_scale(values)


def _upright_distortions(problem: Problem, positions: Floats, skin: Skin) -> Floats:
    """The finite distortions of what is visible and not inverted."""
    values = _distortions(problem, positions)[skin.simplex]
    upright = determinants(problem.elements, positions)[skin.simplex] > 0
    chosen: Floats = values[upright & np.isfinite(values)]
    return chosen


def _distortions(problem: Problem, positions: Floats) -> Floats:
    """The distortion (m,) of every simplex, infinite where it is inverted or undefined."""
    with np.errstate(all="ignore"):
        values = problem.distortion.value(signed_singular_values(problem.elements, positions))
    return np.where(np.isnan(values), np.inf, values)


def _turned(positions: Floats, view: Floats | None) -> Floats:
    return positions @ view.T if positions.shape[1] == 3 and view is not None else positions


def _middle(points: Floats) -> Floats:
    middle: Floats = 0.5 * (points.min(axis=0) + points.max(axis=0))
    return middle


def _draw_target(
    cell: Axes,
    problem: Problem,
    skin: Skin,
    paint: ScalarMappable,
    points: Floats,
    positions: Floats,
    half: tuple[float, float] | None,
) -> None:
    from matplotlib.collections import LineCollection

    inverted = ~(determinants(problem.elements, positions)[skin.simplex] > 0)
    values = np.minimum(_distortions(problem, positions)[skin.simplex], np.finfo(float).max)
    colours = paint.to_rgba(values)[:, :3]
    colours[inverted] = INVERTED
    frame = frame_round(points, half or _square_round(points))
    cell.imshow(coloured_picture(points, skin, colours, frame, inverted), extent=frame.extent, origin="lower")
    if problem.dimension == 2:
        edges = positions[problem.mesh.topology.boundary_facets]
        width = OUTLINE / 72 * 2 * max(frame.half) / CELL  # in the units of the map
        covered = width * np.linalg.norm(edges[:, 1] - edges[:, 0], axis=1).sum()
        area = np.abs(determinants(problem.elements, positions)) @ problem.elements.rest_measures
        if covered < THICKEST * area:
            cell.add_collection(LineCollection(list(edges), colors="#222222", linewidths=OUTLINE))
    anchors = problem.anchors.vertices
    if len(anchors) and problem.dimension == 2:
        cell.plot(*positions[anchors].T, "o", ms=2.2, color="#0072b2", mec="black", mew=0.3)
    left, right, bottom, top = frame.extent
    cell.set(xlim=(left, right), ylim=(bottom, top))
    _bare(cell)


def _caption(column: SheetColumn, item: SheetMap, row: int) -> str:
    if column.is_constant:
        return "given"
    if row == LAST or item.iteration == row:
        return f"{item.iteration} · {item.seconds:.3g} s" if row == LAST else f"{item.seconds:.3g} s"
    return f"ended at {item.iteration}"


def _draw_source(cell: Axes, problem: Problem, skin: Skin, view: Floats | None, column: SheetColumn) -> None:
    """The source under the texture that the last map of a contestant gives it."""
    mesh = problem.mesh
    points = mesh.vertices if view is None else mesh.vertices @ view.T
    frame = frame_round(points)
    places = column.maps[-1].positions / texture_square(mesh, problem.total_measure) + OFF_CORNERS
    image = textured_picture(points, skin, places, frame)
    cell.imshow(image, extent=frame.extent, origin="lower")
    cell.set_title(f"source, {column.label}", fontsize=7, pad=2, parse_math=False)
    _bare(cell)


def _bare(cell: Axes) -> None:
    cell.set(xticks=[], yticks=[], aspect="equal")
    cell.spines[:].set_visible(False)


def _distortion_name(problem: Problem) -> str:
    distortion = problem.distortion
    return distortion.label if len(distortion.label) <= 60 else f"{distortion.label[:59]}…"
