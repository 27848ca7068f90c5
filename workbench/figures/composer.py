"""From a recipe and its maps to a figure."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.errors import WorkbenchError
from workbench.core.measure import DESCRIPTORS, Measure
from workbench.core.signature import Signature, common_edges, heights_on_axis
from workbench.figures.charts import BEYOND_BAR, LABEL, draw_bar, draw_curves, draw_histograms
from workbench.figures.colour_scale import LOGARITHMIC, centred_scale, colour_scale, in_the_way_of
from workbench.figures.figure_maps import FigureMap
from workbench.figures.mesh_panel import MOST_VECTORS, Scene, draw_scene, frame_in, scene_of
from workbench.figures.mesh_pictures import frame_round
from workbench.figures.page_layout import (
    LINE,
    MM_OF_POINT,
    Box,
    Cell,
    PageLayout,
    Place,
    bar_length,
    chart_reach,
    lay_out,
    panel_width,
)
from workbench.figures.recipe import Panel, Recipe
from workbench.figures.text_fit import fit_lines

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure

MOST_SPREAD = 1.8
"""Times the median size up to which maps of one frame are drawn on one scale of length."""
CENTRED = ("average-singular-value", *DESCRIPTORS)
"""Measures that are factors: 1 stands for no distortion."""
USUAL_TEXT = 8.0
"""Font size at which lines have their usual width, points."""
LETTER = 1.4
"""Room for a letter beside a caption, in font sizes."""


@dataclass(frozen=True, eq=False)
class Composition:
    """A figure, and sentences about what of it is no vector drawing, and why."""

    figure: Figure
    notes: tuple[str, ...]


def compose(recipe: Recipe, maps: Mapping[str, FigureMap], most_vectors: int = MOST_VECTORS) -> Composition:
    """The figure of a recipe, with up to `most_vectors` triangles drawn as vectors.

    Raises `WorkbenchError` for what the maps have not, or measures that fit no map.
    """
    import matplotlib

    with matplotlib.rc_context():
        matplotlib.rcdefaults()  # the same whatever the user's own settings are
        return _Composer(recipe, maps, most_vectors).compose()


def title_of(measure: Measure) -> str:
    """Words for a measure: its label, with its equation where it has one."""
    from workbench.core.registry import registry

    known = registry().distortions.get(measure.text)
    if known is None:
        return DESCRIPTORS.get(measure.id, measure.id)
    equation = re.match(r"\(\d+\)(-\(\d+\))?", known.citation)
    values = ", ".join(f"{name} = {value:g}" for name, value in measure.parameters)
    words = f"{known.label} {equation.group() if equation else ''}".strip()
    return f"{words}, {values}" if values else words


def paint_of(panels: Sequence[Panel], parts: Sequence[Floats]) -> ScalarMappable:
    """The colours that panels share, for values in several `parts` (k,) of which those that are not finite do not count."""
    values = np.concatenate([part[np.isfinite(part)] for part in parts])
    limits = next((panel.range for panel in panels if panel.range is not None), None)
    logarithmic = next((panel.logarithmic for panel in panels if panel.logarithmic is not None), None)
    is_centred = panels[0].colour in CENTRED
    scale = centred_scale(values, 1.0, limits, logarithmic) if is_centred else colour_scale(values, limits, logarithmic)
    is_reversed, is_clipped = any(panel.reversed for panel in panels), any(panel.clipped for panel in panels)
    return in_the_way_of(scale, is_reversed=is_reversed, is_clipped=is_clipped)


def one_size(halves: Sequence[tuple[float, float]]) -> tuple[float, float] | None:
    """Half the width and height that hold all of these; None where one is far larger than most."""
    sizes = np.array(halves)
    if sizes.max() > MOST_SPREAD * np.median(sizes.max(axis=1)):
        return None
    width, height = sizes.max(axis=0)
    return float(width), float(height)


def measure_of(panel: Panel) -> Measure:
    return Measure.of(panel.colour, panel.parameters)


@dataclass(eq=False)
class _Composer:
    recipe: Recipe
    maps: Mapping[str, FigureMap]
    most_vectors: int
    pictures: dict[str, list[int]] = field(default_factory=dict)
    """Numbers of the panels that are no vector drawings, by the reason."""

    def compose(self) -> Composition:
        from matplotlib.figure import Figure

        page = self.recipe.page
        layout = self._layout()
        figure = Figure(figsize=(layout.width / 25.4, layout.height / 25.4), dpi=page.dpi)
        if page.background == "transparent":
            figure.patch.set_alpha(0.0)
        if page.title:
            y = 1 - 1.125 * page.font_size * MM_OF_POINT / layout.height
            figure.text(0.5, y, page.title, ha="center", va="center", fontsize=1.2 * page.font_size, parse_math=False)
        self._draw_all(figure, layout)
        return Composition(figure, self._notes())

    def _notes(self) -> tuple[str, ...]:
        notes = []
        for reason, numbers in self.pictures.items():
            listed = ", ".join(map(str, numbers))
            words = f"Panels {listed} are pictures" if len(numbers) > 1 else f"Panel {listed} is a picture"
            notes.append(f"{words} of {self.recipe.page.dpi} dpi ({reason}).")
        return tuple(notes)

    # ------------------------------------------------------------------------------------------ what is shown

    @cached_property
    def scenes(self) -> dict[int, Scene]:
        return {
            index: scene_of(self.maps[panel.maps[0]], panel)
            for index, panel in enumerate(self.recipe.panels)
            if panel.is_picture
        }

    @cached_property
    def values(self) -> dict[int, Floats]:
        """(k,) of the visible triangles of each picture that shows a measure."""
        return {
            index: scene.map.values(measure_of(scene.panel))[scene.skin.simplex]
            for index, scene in self.scenes.items()
            if scene.panel.has_measure
        }

    @cached_property
    def halves(self) -> dict[int, tuple[float, float]]:
        """Half the width and height that each picture shows: of one frame the same, unless one is far larger than most."""
        own = {index: frame_round(scene.points).half for index, scene in self.scenes.items()}
        found = dict(own)
        for name in {scene.panel.frame for scene in self.scenes.values()} - {""}:
            members = [index for index, scene in self.scenes.items() if scene.panel.frame == name]
            common = one_size([own[index] for index in members])
            if common is not None:
                found |= dict.fromkeys(members, common)
        return found

    @cached_property
    def paints(self) -> dict[str, ScalarMappable]:
        """A scale of colours for each that panels share, and for each panel of its own."""
        groups: dict[str, list[int]] = {}
        for index in self.values:
            groups.setdefault(self._scale_name(index), []).append(index)
        return {name: self._paint(members) for name, members in groups.items()}

    def _scale_name(self, index: int) -> str:
        return self.recipe.panels[index].scale or f"\n{index}"  # no name has a line break

    def _paint(self, members: list[int]) -> ScalarMappable:
        upright = [self.values[index][~self.scenes[index].inverted] for index in members]
        return paint_of([self.recipe.panels[index] for index in members], upright)

    # ------------------------------------------------------------------------------------------ drawing

    def _caption(self, panel: Panel) -> str:
        if panel.caption or not panel.is_picture:
            return panel.caption
        title = self.maps[panel.maps[0]].title
        return title if panel.kind == "map" else f"source, {title}"

    @cached_property
    def captions(self) -> dict[int, tuple[str, float]]:
        """Words above panels and their size in points, which is one for the page, but for what would be cut short else."""
        page = self.recipe.page
        panels = enumerate(self.recipe.panels)
        fitted = {index: self._fitted_caption(panel) for index, panel in panels if self._caption(panel).strip()}
        size = min((size for words, size in fitted.values() if not words.endswith("…")), default=page.font_size)
        return {index: (words, min(size, own)) for index, (words, own) in fitted.items()}

    def _fitted_caption(self, panel: Panel) -> tuple[str, float]:
        page = self.recipe.page
        taken = LETTER * page.font_size * MM_OF_POINT if page.letters else 0.0
        return fit_lines(self._caption(panel), panel_width(page.width, page.columns, panel.span) - 2 * taken, page.font_size)

    def _words(self, panel: Panel) -> int:
        """Lines of the words below a colour bar or a chart."""
        page = self.recipe.page
        width = panel_width(page.width, page.columns, panel.span)
        is_bar = panel.kind == "colour-bar" or (panel.bar and panel.is_picture)
        if not (is_bar or panel.kind == "histogram") or not panel.has_measure:
            return 1
        room = BEYOND_BAR * bar_length(width) if is_bar else chart_reach(width, page.font_size)
        return _lines(fit_lines(title_of(measure_of(panel)), room, LABEL * page.font_size)[0])

    def _layout(self) -> PageLayout:
        page = self.recipe.page
        cells = []
        for index, panel in enumerate(self.recipe.panels):
            half = self.halves.get(index)
            is_chart = panel.kind in ("histogram", "curves")
            cells.append(
                Cell(
                    span=panel.span,
                    aspect=half[1] / half[0] if half else 0.0,
                    caption=self._caption_lines(index, is_chart=is_chart),
                    words=self._words(panel),
                    has_bar=panel.bar and panel.is_picture and panel.has_measure,
                    has_axes=is_chart,
                    is_bar=panel.kind == "colour-bar",
                )
            )
        return lay_out(cells, page.width, page.columns, page.font_size, bool(page.title))

    def _caption_lines(self, index: int, *, is_chart: bool) -> int:
        panel = self.recipe.panels[index]
        has_any = bool(self._caption(panel)) or (self.recipe.page.letters and (panel.is_picture or is_chart))
        return _lines(self.captions[index][0]) if index in self.captions else int(has_any)

    def _draw_all(self, figure: Figure, layout: PageLayout) -> None:
        page, letters = self.recipe.page, iter("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ")
        left = self.most_vectors
        for index, (panel, place) in enumerate(zip(self.recipe.panels, layout.places, strict=True)):
            if panel.kind == "empty":
                continue
            lettered = page.letters and panel.kind != "colour-bar"
            letter = next(letters, "") if lettered else ""
            self._write_caption(figure, layout, place, letter, *self.captions.get(index, ("", page.font_size)))
            if panel.is_picture:
                left -= self._draw_picture(self._axes(figure, layout, place.inside), index, place, left)
            elif panel.kind == "histogram":
                self._draw_histogram(self._axes(figure, layout, place.inside), panel, place.reach)
            elif panel.kind == "curves":
                self._draw_curves(self._axes(figure, layout, place.inside), panel, place.reach)
            if place.bar is not None:
                paint = self.paints[self._scale_name(index)]
                bar = self._axes(figure, layout, place.bar)
                draw_bar(bar, paint, title_of(measure_of(panel)), page.font_size, most_lines=3)

    @staticmethod
    def _axes(figure: Figure, layout: PageLayout, box: Box) -> Axes:
        width, height = layout.width, layout.height
        axes = figure.add_axes((box.left / width, 1 - (box.top + box.height) / height, box.width / width, box.height / height))
        axes.patch.set_alpha(0.0)
        return axes

    def _write_caption(self, figure: Figure, layout: PageLayout, place: Place, letter: str, words: str, fitted: float) -> None:
        size = self.recipe.page.font_size
        heading = place.inside.top - place.whole.top - 0.25 * LINE * size * MM_OF_POINT
        y = 1 - (place.whole.top + 0.5 * heading) / layout.height
        if letter:
            figure.text(place.whole.left / layout.width, y, letter, weight="bold", va="center", fontsize=1.1 * size)
        middle = (place.whole.left + 0.5 * place.whole.width) / layout.width
        if words:
            figure.text(middle, y, words, ha="center", va="center", fontsize=fitted, parse_math=False)

    def _draw_picture(self, axes: Axes, index: int, place: Place, most: int) -> int:
        """The number of triangles that were drawn as vectors."""
        scene, page = self.scenes[index], self.recipe.page
        frame = frame_in(scene.points, self.halves[index], place.inside.width, place.inside.height, page.dpi)
        count = len(scene.skin.triangles)
        as_vectors = scene.is_vector and count <= most
        paint = self.paints.get(self._scale_name(index))
        draw_scene(
            axes, scene, paint, self.values.get(index), frame, as_vectors=as_vectors, size=page.font_size / USUAL_TEXT
        )  # fmt: skip
        if not as_vectors:
            reason = "in space" if not scene.is_flat else "textured"
            if scene.is_vector:
                reason = "too many triangles for a file of moderate size"
            self.pictures.setdefault(reason, []).append(index + 1)
        return count if as_vectors else 0

    def _draw_histogram(self, axes: Axes, panel: Panel, room: float) -> None:
        alike = [p for p in self.recipe.panels if p.kind == "histogram" and panel.scale and p.scale == panel.scale] or [panel]
        everything = [self._signature(name, panel) for p in alike for name in p.maps]
        low = min(float(item.values.min()) for item in everything)
        high = max(float(item.values.max()) for item in everything)
        is_logarithmic = low > 0 and high > LOGARITHMIC**2 * low
        edges = common_edges(everything, panel.bins, logarithmic=is_logarithmic)
        tallest = max(float(heights_on_axis(item, edges, logarithmic=is_logarithmic).max()) for item in everything)
        items = [self._signature(name, panel) for name in panel.maps]
        paint = self.paints.get(panel.scale) if panel.scale else None
        draw_histograms(
            axes, items, edges, title_of(measure_of(panel)), self.recipe.page.font_size,
            room=room, is_logarithmic=is_logarithmic, tallest=tallest, paint=paint,
        )  # fmt: skip

    def _signature(self, name: str, panel: Panel) -> Signature:
        """The finite values of a measure, each with its part of the source."""
        found = self.maps[name]
        values, weights = found.values(measure_of(panel)), found.elements.rest_measures
        finite = np.isfinite(values)
        if not finite.any():
            raise WorkbenchError(f"{panel.colour} is infinite all over the map {name}; a histogram needs other values.")
        return Signature(found.title, values[finite], weights[finite] / weights[finite].sum())

    def _draw_curves(self, axes: Axes, panel: Panel, room: float) -> None:
        items = [self.maps[name] for name in panel.maps]
        bare = next((name for name, item in zip(panel.maps, items, strict=True) if not item.rows), None)
        if bare is not None:
            raise WorkbenchError(f"The map {bare} comes from a file, which has no curves; name maps that are solved for.")
        draw_curves(axes, items, panel.quantity, self.recipe.page.font_size, room)


def _lines(words: str) -> int:
    return 1 + words.count("\n")
