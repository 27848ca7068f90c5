"""Pictures of maps and tables of numbers, as a notebook shows them."""

from __future__ import annotations

import base64
import html
from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.measure import Measure
from workbench.core.mesh import Mesh

if TYPE_CHECKING:
    from workbench.figures.recipe import Panel

WIDTH = 130.0
"""Of a picture of a source and its map, mm."""
WIDTH_ALONE = 65.0
DPI = 110
MOST_VECTORS = 2000
"""Triangles that are drawn one by one; of more a picture is made, which is quicker."""
DEFAULT = Measure("symmetric-dirichlet")


class WithPicture(ABC):
    """What a notebook shows with a picture: `png` is its bytes."""

    @property
    @abstractmethod
    def png(self) -> bytes:
        """The picture."""

    def _repr_png_(self) -> bytes:
        return self.png


def picture_of(
    mesh: Mesh, positions: Floats | None, measure: Measure = DEFAULT, anchors: Integers | None = None, title: str = ""
) -> bytes:
    """PNG of a source beside its map (n, d), the map in the colours of a measure with a colour bar; else of the source alone.

    `anchors` (k,) are marked.
    """
    from workbench.figures.composer import compose
    from workbench.figures.figure_maps import FigureMap
    from workbench.figures.recipe import Page, Panel, Recipe
    from workbench.figures.save import figure_bytes

    held = np.empty(0, dtype=np.int64) if anchors is None else anchors
    is_alone = positions is None
    shown = FigureMap(title, mesh, mesh.vertices if positions is None else positions, held)
    panels = [source_panel("map", mesh, " " if is_alone else "source", is_alone=is_alone)]
    if not is_alone:
        values = dict(measure.parameters)
        panels.append(
            Panel("map", ("map",), measure.text, values, bar=True, caption=title or "map", frame="map", view=view_of_both(mesh))
        )
    page = Page(width=WIDTH_ALONE if is_alone else WIDTH, dpi=DPI, columns=len(panels))
    composition = compose(Recipe(page, (), tuple(panels)), {"map": shown}, MOST_VECTORS)
    return figure_bytes(composition.figure, ".png", DPI)


def source_panel(name: str, mesh: Mesh, caption: str, *, is_alone: bool = False) -> Panel:
    """The source of the map `name`: under its texture where it is a surface beside its map, else plain."""
    from workbench.figures.recipe import CHEQUERED, PLAIN, Panel

    if mesh.dimension == 3:
        return Panel("source", (name,), PLAIN, caption=caption, frame="" if is_alone else "map", view=view_of_both(mesh))
    return Panel("source", (name,), PLAIN if is_alone else CHEQUERED, caption=caption, edges=True)


def view_of_both(mesh: Mesh) -> tuple[tuple[float, ...], ...]:
    """The turn in which a solid is seen, source and map alike, as `Panel.view` has it; empty for what lies flat."""
    from workbench.figures.mesh_pictures import view_of

    return tuple(map(tuple, view_of(mesh).tolist())) if mesh.dimension == 3 else ()


def html_page(png: bytes | None, rows: Iterable[tuple[str, str]], notes: Sequence[str] = ()) -> str:
    """A picture with a table of names and values beside it, and sentences below."""
    picture = f'<img src="data:image/png;base64,{base64.b64encode(png).decode()}" style="max-width: 100%">' if png else ""
    lines = "".join(
        f'<tr><th style="text-align: left">{html.escape(name)}</th><td style="text-align: left">{html.escape(value)}</td></tr>'
        for name, value in rows
    )
    return (
        '<div style="display: flex; flex-wrap: wrap; gap: 1em; align-items: center">'
        f"<div>{picture}</div><table>{lines}</table></div>{html_lines(notes)}"
    )


def html_lines(lines: Iterable[str]) -> str:
    """A paragraph a line."""
    return "".join(f"<p>{html.escape(line)}</p>" for line in lines)


def html_table(rows: Sequence[Sequence[str]]) -> str:
    """A table whose first row is its head."""
    head, *others = rows
    first = "".join(f"<th>{html.escape(text)}</th>" for text in head)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(text)}</td>" for text in row) + "</tr>" for row in others)
    return f"<table><thead><tr>{first}</tr></thead><tbody>{body}</tbody></table>"
