"""Figures from a notebook: presets, recipes, and maps that are at hand."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from workbench.core.errors import WorkbenchError
from workbench.engine.interrupt import InterruptFlag
from workbench.figures.composer import compose
from workbench.figures.figure_maps import FigureMap, make_maps
from workbench.figures.presets import PRESETS, Given, preset_recipe
from workbench.figures.recipe import DEFAULT_MEASURE, Page, Panel, Recipe
from workbench.figures.recipe_text import checked_page, read_recipe, write_recipe
from workbench.figures.save import figure_bytes, save_figure
from workbench.notebook.measuring import MapGiven, map_given
from workbench.notebook.pictures import WithPicture, source_panel, view_of_both
from workbench.notebook.solution import Solution
from workbench.notebook.source import Source

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    OneMap = Solution | Source | MapGiven

SCREEN_DPI = 110
LARGEST_SVG = 2**21
"""Bytes of an SVG that a notebook shows as such; what is larger is shown as a PNG."""


@dataclass(frozen=True, eq=False)
class Drawing(WithPicture):
    """A figure on paper: `figure` is Matplotlib's, `notes` say what of it is no vector drawing.

    `recipe` is what it was made from; a file of it makes the same figure again where its maps come from files or solvers.
    """

    figure: Figure
    recipe: Recipe
    notes: tuple[str, ...] = ()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write it as PNG, PDF or SVG, or its recipe as JSON, by the ending. Raises `WorkbenchError`."""
        if Path(path).suffix.lower() != ".json":
            save_figure(self.figure, path, self.recipe.page.dpi)
            return
        if not self.recipe.maps:
            raise WorkbenchError("Its maps are not in files; save them, or draw from a recipe, to have a recipe.")
        write_recipe(path, self.recipe)

    @cached_property
    def png(self) -> bytes:
        """PNG for the screen."""
        return figure_bytes(self.figure, ".png", SCREEN_DPI)

    def _repr_svg_(self) -> str | None:
        svg = figure_bytes(self.figure, ".svg", SCREEN_DPI)
        return svg.decode("utf-8") if len(svg) <= LARGEST_SVG else None

    def __repr__(self) -> str:
        page = self.recipe.page
        return f"<Drawing of {len(self.recipe.panels)} panels, {page.width:g} mm wide, {page.dpi} dpi>"


def figure(
    what: str | os.PathLike[str] | Recipe | OneMap | Sequence[OneMap] | Mapping[str, OneMap],
    *,
    colour: str | Sequence[str] = DEFAULT_MEASURE,
    mesh: str = "",
    given: Mapping[str, str] | None = None,
    **page: Any,
) -> Drawing:
    """A figure fit to print.

    Parameters
    ----------
    what         a preset (see `workbench list figures`), a recipe or its file (.json), or maps: a result of `solve`, a loaded
                 mesh with a map, (source, positions), or several of these, by name where they are given as a mapping
    colour       measures whose colours the maps have: distortions by id, formulas, det, sigma1, sigman
    mesh, given  of a preset: a mesh file or `sample:ID`, and files of maps by label
    page         width (mm), dpi, font_size (points), background (white, transparent), columns, letters, title

    Maps that are drawn together have one scale of colours for each measure, and one of length. Raises `WorkbenchError`.
    """
    if isinstance(what, str | os.PathLike) and (named := _named_recipe(os.fspath(what), mesh, given or {})):
        what = named
    if isinstance(what, Recipe):
        recipe = replace(what, page=checked_page(what.page, page))
        with InterruptFlag() as interrupt:
            maps = make_maps(recipe.maps, interrupt=interrupt)
    else:
        maps = {f"map-{i + 1}": item for i, item in enumerate(_maps_at_hand(what))}
        recipe = _recipe_of(maps, (colour,) if isinstance(colour, str) else tuple(colour), page)
    composition = compose(recipe, maps)
    return Drawing(composition.figure, recipe, composition.notes)


def _named_recipe(name: str, mesh: str, given: Mapping[str, str]) -> Recipe | None:
    """The recipe of a preset or of a file; None where the name is that of a mesh."""
    if name in PRESETS:
        return preset_recipe(name, Given(mesh, targets=tuple(given.items())))
    if Path(name).suffix.lower() == ".json":
        return read_recipe(name)
    if not Path(name).suffix and not Path(name).exists():
        raise WorkbenchError(f"There is no figure {name!r}; there are: {', '.join(PRESETS)}, or a recipe (.json).")
    return None


def _maps_at_hand(what: Any) -> list[FigureMap]:
    if isinstance(what, Mapping):
        named = list(what.items())
    elif isinstance(what, list) or (isinstance(what, tuple) and all(isinstance(item, Solution) for item in what)):
        named = [("", item) for item in what]
    else:
        named = [("", what)]
    if not named:
        raise WorkbenchError("There is no map to draw; give one at least, as `solve` and `load` make them.")
    return [_figure_map(str(name), item) for name, item in named]


def _figure_map(name: str, item: Any) -> FigureMap:
    positions = map_given(item)
    if isinstance(item, Solution):
        solver = item.prepared.solver.label
        return FigureMap(name or solver, *positions, item.problem.anchors.vertices, item.result.rows)
    return FigureMap(name or positions[0].name or "map", *positions, np.empty(0, dtype=np.int64))


def _recipe_of(maps: Mapping[str, FigureMap], colours: tuple[str, ...], page: Mapping[str, Any]) -> Recipe:
    """A row a map: its source under the texture, then the map in each colouring; bars below the last."""
    rows = list(maps)
    panels: list[Panel] = []
    for name in rows:
        mesh, title, is_last = maps[name].mesh, maps[name].title, name == rows[-1]
        panels.append(source_panel(name, mesh, f"source, {title}" if len(rows) > 1 else "source"))
        panels += [
            Panel("map", (name,), colour, scale=colour, frame="map", bar=is_last, caption=title, view=view_of_both(mesh))
            for colour in colours
        ]
    return Recipe(checked_page(Page(columns=1 + len(colours)), page), (), tuple(panels))
