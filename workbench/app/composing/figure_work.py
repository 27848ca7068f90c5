"""What the figure dialog has done on a thread: previews, and files."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.errors import WorkbenchError
from workbench.core.history_row import HistoryRow
from workbench.core.mesh import Mesh
from workbench.core.method import Kind
from workbench.figures.recipe import MapChoice, Page, Panel, Recipe
from workbench.io.atomic import write_bytes
from workbench.session.session import Session

if TYPE_CHECKING:
    from workbench.core.carried_surface import CarriedSurface
    from workbench.figures.figure_maps import FigureMap

NAME = "map"
"""What recipes of the window call its map."""
ENDINGS = (".pdf", ".svg", ".png", ".json")


@dataclass(frozen=True, eq=False)
class Subject:
    """The map of the window at a moment: the choices that name its source and anchors, and the steps that led to it."""

    stem: str
    session: Session
    mesh: Mesh
    kind: Kind
    positions: Floats
    rows: tuple[HistoryRow, ...] = ()
    carried: CarriedSurface | None = None
    cuts: Integers = field(default_factory=lambda: np.empty((0, 2), np.int64))

    @property
    def choice(self) -> MapChoice:
        return MapChoice(NAME, self.session, label=self.stem)

    @property
    def map(self) -> FigureMap:
        from workbench.figures.figure_maps import FigureMap  # late, as all that draws: the window opens without

        anchors = np.array(self.session.in_force.anchor_vertices, dtype=np.int64)
        return FigureMap(self.stem, self.mesh, self.positions, anchors, self.rows, self.carried, self.cuts)


@dataclass(frozen=True, eq=False)
class Order:
    """A figure that is wanted: of what, on which page, with which panels."""

    subject: Subject
    page: Page
    panels: tuple[Panel, ...]

    @property
    def recipe(self) -> Recipe:
        return Recipe(self.page, (self.subject.choice,), self.panels)


def draw_preview(order: Order, pixels: int) -> bytes:
    """PNG of the figure, so many pixels wide; triangles are not drawn one by one. Raises `WorkbenchError`."""
    from workbench.figures.composer import compose

    _check(order)
    dpi = max(20, round(pixels / (order.page.width / 25.4)))
    recipe = replace(order.recipe, page=replace(order.page, dpi=dpi))
    figure = compose(recipe, {NAME: order.subject.map}, most_vectors=0).figure
    stream = BytesIO()
    figure.savefig(stream, format="png", dpi=dpi)
    return stream.getvalue()


def save(order: Order, path: Path, bind: Callable[[bytes], bytes] = bytes) -> tuple[str, ...]:
    """Write the figure, or its recipe with the map beside it; sentences about what of it is no vector drawing.

    `bind` makes the bytes that are written out of those of the figure: a picture may carry more.
    """
    from workbench.figures.composer import compose
    from workbench.figures.recipe_text import checked_page
    from workbench.figures.save import check_format, figure_bytes

    _check(order)
    checked_page(order.page, {})
    if path.suffix.lower() == ".json":
        _save_recipe(order, path)
        return ()
    composition = compose(order.recipe, {NAME: order.subject.map})
    write_bytes(path, bind(figure_bytes(composition.figure, check_format(path), order.page.dpi)))
    return composition.notes if path.suffix.lower() != ".png" else ()


def _check(order: Order) -> None:
    if not order.panels:
        raise WorkbenchError("No panel is chosen; tick one at least.")


def _save_recipe(order: Order, path: Path) -> None:
    """The recipe, the map as `NAME-map.npz`, and where there are curves the history as `NAME-history.csv`."""
    from workbench.figures.history_file import write_history
    from workbench.figures.recipe_text import write_recipe
    from workbench.io.write import write_map

    subject = order.subject
    choice = replace(subject.choice, target=str(path.with_name(f"{path.stem}-map.npz")))
    write_map(choice.target, subject.mesh, subject.mesh, subject.positions, subject.kind)
    if any(panel.kind == "curves" for panel in order.panels):
        choice = replace(choice, history=str(path.with_name(f"{path.stem}-history.csv")))
        write_history(choice.history, subject.rows)
    write_recipe(path, replace(order.recipe, maps=(choice,)))
