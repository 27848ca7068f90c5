"""How sheets of solvers are laid out: a column a solver, a row an iteration, the textured sources at the right (Fig. 11)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from workbench.figures.recipe import CHEQUERED, DEFAULT_MEASURE, Page, Panel

SCALE = "distortion"
"""Of the colours of all maps."""
FONT_SIZE = 7.0
COLUMN, FEWEST = 36.0, 3
"""Width of a column, mm, and columns that a page is wide at least: with many solvers it is wider."""


@dataclass(frozen=True)
class SheetCell:
    """A map by its name, and the words above it; none for its label."""

    map: str
    caption: str = ""


def sheet_page(columns: int, title: str = "") -> Page:
    """The page of a sheet."""
    return Page(width=COLUMN * max(columns, FEWEST), columns=columns, font_size=FONT_SIZE, title=title)


def sheet_panels(
    rows: Sequence[Sequence[SheetCell]],
    sources: Sequence[SheetCell],
    colour: str = DEFAULT_MEASURE,
    parameters: Mapping[str, float] | None = None,
) -> tuple[int, tuple[Panel, ...]]:
    """The number of columns, and the panels: maps on one scale of colours and of length, and the bar of the colours.

    `sources` are maps whose texture lies on their source: one at the right of each row, and rows of their own for more.
    """
    shown = [
        [
            Panel("map", (cell.map,), colour, dict(parameters or {}), scale=SCALE, frame="map", caption=cell.caption)
            for cell in row
        ]
        for row in rows
    ]
    textured = [Panel("source", (cell.map,), CHEQUERED, caption=cell.caption, anchors=False) for cell in sources]
    columns, panels = len(rows[0]), []
    if len(rows) > 1:
        columns += 1
        for row in shown:
            row.append(textured.pop(0) if textured else Panel("empty"))
    for row in shown:
        panels += row
    bar = Panel("colour-bar", colour=colour, parameters=dict(parameters or {}), scale=SCALE, span=columns)
    return columns, (*panels, *textured, bar)
