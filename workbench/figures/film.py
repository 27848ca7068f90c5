"""A film of maps of one mesh: every frame in the same place, on the same scales."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.errors import WorkbenchError
from workbench.core.jacobians import Elements, build_elements
from workbench.core.measure import Evaluator, SingularValues
from workbench.core.mesh import Mesh
from workbench.core.surface_jacobians import singular_values_of_any
from workbench.figures.colour_scale import INVERTED, centred_scale, colour_scale, in_the_way_of
from workbench.figures.composer import CENTRED, measure_of, title_of
from workbench.figures.film_page import GROUNDS, INKS, Box, Cell, FilmPage, make_page
from workbench.figures.film_shading import Paint, Pixels, draw_triangles
from workbench.figures.mesh_panel import PLAIN_COLOUR
from workbench.figures.mesh_pictures import Frame, frame_round, shades, skin_of, texture_square, view_of
from workbench.figures.recipe import PLAIN, TEXTURES, Panel

if TYPE_CHECKING:
    from matplotlib.cm import ScalarMappable

LEAST, MOST = 64, 4096
"""Pixels of a side of a film."""
MOST_FRAMES = 20_000
RATES = (1.0, 60.0)
"""Frames a second, at least and at most."""
SAMPLED = 12
"""Frames to which colours are fitted."""
DARK_PLAIN = (0.27, 0.32, 0.37)
EDGES = {True: (0.62, 0.68, 0.74), False: (0.30, 0.35, 0.40)}
"""Colours of edges on dark and on light grounds."""
PLAIN_EDGES, OTHER_EDGES = 0.7, 0.25
"""How strongly edges are drawn on one colour, and over colours that are to be read."""
ANCHOR = (0.12, 0.44, 0.92)
ANCHOR_SIZE = 0.36
"""Radius of an anchor, in heights of the text."""
MANY = 60
"""Anchors from which on their discs are half as large."""


@dataclass(frozen=True)
class Film:
    """What a film shows, and how.

    Parameters
    ----------
    panels : tuple of Panel       of the kinds `map` and `source`; those with a `range` keep it
    width, height : int           pixels, even numbers
    rate : float                  frames a second
    ground : str                  one of `GROUNDS`
    has_captions : bool           a line below each frame
    repeats : bool                a GIF begins anew at its end
    """

    panels: tuple[Panel, ...]
    width: int = 960
    height: int = 720
    rate: float = 25.0
    ground: str = "white"
    has_captions: bool = True
    repeats: bool = True

    def check(self, frame_count: int) -> None:
        """Raises `WorkbenchError` for what no film can be made of."""
        if not self.panels:
            raise WorkbenchError("No view is chosen for the film; choose one at least.")
        if not all(LEAST <= side <= MOST and side % 2 == 0 for side in (self.width, self.height)):
            raise WorkbenchError(f"A film is {LEAST} to {MOST} pixels wide and high, even numbers; choose another size.")
        if not RATES[0] <= self.rate <= RATES[1]:
            raise WorkbenchError(f"A film has {RATES[0]:g} to {RATES[1]:g} frames a second; choose another rate.")
        if self.ground not in GROUNDS:
            raise WorkbenchError(f"A film has one of the grounds {', '.join(GROUNDS)}; {self.ground} is none.")
        if not frame_count:
            raise WorkbenchError("There is no map to film; let the solver run first.")
        if frame_count > MOST_FRAMES:
            raise WorkbenchError(f"The film would have {frame_count} frames; choose a shorter part, or a quicker pace.")


@dataclass(frozen=True, eq=False)
class Still:
    """A frame before it is drawn: `positions` makes the map (n, d) when it is wanted; `anchors` (k,) are vertices."""

    positions: Callable[[], Floats]
    caption: str = ""
    anchors: tuple[int, ...] = ()


class FilmDrawer:
    """Draws stills of one mesh; what all frames share is found once.

    Every frame is looked at for that when the drawer is made: the pictures show all of the motion, and do not move themselves.
    `look` is told of each part of that work and may end it by raising.
    """

    def __init__(self, film: Film, mesh: Mesh, stills: Sequence[Still], look: Callable[[], None] = lambda: None) -> None:
        film.check(len(stills))
        self.film = film
        self._mesh = mesh
        self._skin = skin_of(mesh)
        self._elements: Elements = build_elements(mesh)
        self._square = texture_square(mesh, float(self._elements.rest_measures.sum()))
        self._axes = [self._axes_of(panel, stills[0].positions()) for panel in film.panels]
        self._evaluators: dict[int, Evaluator] = {
            i: measure_of(panel).prepare(mesh.dimension) for i, panel in enumerate(film.panels) if panel.has_measure
        }
        frames = self._frames(stills, look)
        self._scales = self._fitted_scales(stills, look)
        cells = [self._cell(i, frame) for i, frame in enumerate(frames)]
        self.page: FilmPage = make_page(cells, film.width, film.height, film.ground, film.has_captions)
        self._frames_of = [_filling(frame, box) for frame, box in zip(frames, self.page.boxes, strict=True)]

    @property
    def is_dark(self) -> bool:
        return self.film.ground == "dark"

    @property
    def colours(self) -> Floats:
        """(k, 3) in [0, 1]: colours that must not be lost where a film has few."""
        from matplotlib.colors import to_rgb

        ground, ink = to_rgb(GROUNDS[self.film.ground]), to_rgb(INKS[self.film.ground])
        return np.array([ground, ink, INVERTED, ANCHOR, EDGES[self.is_dark], self._plain])

    @property
    def _plain(self) -> tuple[float, float, float]:
        return DARK_PLAIN if self.is_dark else PLAIN_COLOUR

    def _cell(self, index: int, frame: Frame) -> Cell:
        panel, aspect = self.film.panels[index], frame.half[1] / frame.half[0]
        if index not in self._scales or not panel.bar:
            return Cell(panel.caption.strip(), aspect)
        return Cell(panel.caption.strip(), aspect, self._scales[index], title_of(measure_of(panel)))

    # ------------------------------------------------------------------------------------------ what all frames share

    def _axes_of(self, panel: Panel, positions: Floats) -> Floats | None:
        """How a panel turns what lies in space."""
        points = self._mesh.vertices if panel.kind == "source" else positions
        if points.shape[1] == 2:
            return None
        if panel.view:
            return np.array(panel.view)
        return view_of(self._mesh if self._mesh.vertices.shape[1] == 3 else Mesh(points, self._mesh.simplices))

    def _points(self, index: int, positions: Floats) -> Floats:
        points = self._mesh.vertices if self.film.panels[index].kind == "source" else positions
        axes = self._axes[index]
        return points if axes is None else points @ axes.T

    def _frames(self, stills: Iterable[Still], look: Callable[[], None]) -> list[Frame]:
        """About all of the motion, one of each panel; those of maps that are seen alike are alike."""
        lows: dict[int, Floats] = {}
        highs: dict[int, Floats] = {}
        for number, still in enumerate(stills):
            look()
            positions = still.positions()
            for index, panel in enumerate(self.film.panels):
                if panel.kind == "source" and number:
                    continue
                places = self._points(index, positions)[:, :2]
                low, high = (np.array([f(column) for column in places.T]) for f in (np.min, np.max))
                lows[index] = np.minimum(lows.get(index, low), low)
                highs[index] = np.maximum(highs.get(index, high), high)
        return [frame_round(np.stack([lows[index], highs[index]])) for index in range(len(self.film.panels))]

    def _fitted_scales(self, stills: Sequence[Still], look: Callable[[], None]) -> dict[int, ScalarMappable]:
        rows = np.unique(np.linspace(0, len(stills) - 1, SAMPLED).astype(int)) if self._evaluators else []
        found: dict[int, list[Floats]] = {index: [] for index in self._evaluators}
        for row in rows:
            look()
            values = self._singular_values(stills[row].positions())
            for index, evaluator in self._evaluators.items():
                measured = _measured(evaluator, values)
                found[index].append(measured[np.isfinite(measured) & ~values.inverted])
        scales = {}
        for index, parts in found.items():
            panel = self.film.panels[index]
            make = (lambda *rest: centred_scale(rest[0], 1.0, *rest[1:])) if panel.colour in CENTRED else colour_scale
            scale = make(np.concatenate(parts), panel.range, panel.logarithmic)
            scales[index] = in_the_way_of(scale, is_reversed=panel.reversed, is_clipped=panel.clipped)
        return scales

    def _singular_values(self, positions: Floats) -> SingularValues:
        return SingularValues(singular_values_of_any(self._elements, positions))

    # ------------------------------------------------------------------------------------------ frames

    def draw(self, still: Still) -> Pixels:
        """(height, width, 3) uint8"""
        positions = still.positions()
        values = self._singular_values(positions)
        pixels = self.page.pixels.copy()
        for index, box in enumerate(self.page.boxes):
            part = pixels[box.top : box.top + box.height, box.left : box.left + box.width]
            picture = np.ascontiguousarray(part)
            self._draw_panel(index, positions, values, still, picture)
            part[:] = picture
        if self.film.has_captions and still.caption:
            _write(pixels, self.page.caption, still.caption, self.page.font_size, INKS[self.film.ground])
        return pixels

    def _draw_panel(self, index: int, positions: Floats, values: SingularValues, still: Still, picture: Pixels) -> None:
        points, frame, panel = self._points(index, positions), self._frames_of[index], self.film.panels[index]
        left, _, bottom, _ = frame.extent
        pixels = np.column_stack([(points[:, :2] - [left, bottom]) * frame.density, points[:, 2:]])
        inverted = values.inverted[self._skin.simplex]
        paint = self._paint(index, positions, values)
        if panel.edges:
            paint = replace(paint, edge=EDGES[self.is_dark], strength=PLAIN_EDGES if panel.colour == PLAIN else OTHER_EDGES)
        if points.shape[1] == 3:
            paint = replace(paint, colours=paint.colours * shades(points, self._skin)[:, None])
        draw_triangles(pixels, self._skin.triangles, inverted.astype(np.int64), paint, picture)
        if panel.anchors and still.anchors:
            chosen = np.array(still.anchors)
            radius = ANCHOR_SIZE * self.page.font_size * (0.5 if len(chosen) > MANY else 1.0)
            for x, y in pixels[chosen, :2].tolist():
                _disc(picture, x, len(picture) - y, radius)

    def _paint(self, index: int, positions: Floats, values: SingularValues) -> Paint:
        panel, nothing = self.film.panels[index], np.empty((0, 2))
        count = len(self._skin.triangles)
        if panel.colour in TEXTURES:  # in a film all of them are chequered
            return Paint(np.ones((count, 3)), positions, self._square)
        colours = np.tile(np.array(self._plain), (count, 1))
        if index in self._evaluators:
            scale = self._scales[index]
            found = _measured(self._evaluators[index], values)[self._skin.simplex]
            colours = np.asarray(scale.to_rgba(np.clip(found, scale.norm.vmin, scale.norm.vmax)))[:, :3].copy()
        colours[values.inverted[self._skin.simplex]] = INVERTED
        return Paint(colours, nothing)


def _measured(evaluator: Evaluator, values: SingularValues) -> Floats:
    with np.errstate(all="ignore"):
        found = evaluator(values)
    return np.where(np.isnan(found), np.inf, found)


def _filling(frame: Frame, box: Box) -> Frame:
    """The frame that fills a box and shows another one at least."""
    density = min(box.width / (2 * frame.half[0]), box.height / (2 * frame.half[1]))
    return Frame(frame.centre, (0.5 * box.width / density, 0.5 * box.height / density), density)


def _disc(picture: Pixels, x: float, y: float, radius: float) -> None:
    """A disc with a dark rim, its edge smooth."""
    if not (np.isfinite(x) and np.isfinite(y)):
        return
    reach = radius + 2
    left, top = max(int(x - reach), 0), max(int(y - reach), 0)
    part = picture[top : max(int(y + reach) + 1, 0), left : max(int(x + reach) + 1, 0)]
    rows, columns = np.mgrid[: part.shape[0], : part.shape[1]]
    distance = np.hypot(columns + left + 0.5 - x, rows + top + 0.5 - y)
    inside, rim = (np.clip(size - distance + 0.5, 0, 1)[..., None] for size in (radius - 1.0, radius + 0.3))
    mixed = part * (1 - rim) + 255.0 * inside * np.array(ANCHOR)
    mixed += (1 - inside) * rim * 15.0
    part[:] = np.clip(mixed, 0, 255).astype(np.uint8)


def _write(pixels: Pixels, box: Box, words: str, size: int, ink: str) -> None:
    """A line of text in the middle of a box."""
    from PIL import Image, ImageDraw

    part = Image.fromarray(pixels[box.top : box.top + box.height])
    draw = ImageDraw.Draw(part)
    draw.text((pixels.shape[1] / 2, box.height / 2), words, fill=ink, font=_font(size), anchor="mm")
    pixels[box.top : box.top + box.height] = np.asarray(part)


@lru_cache(maxsize=8)
def _font(size: int):  # type: ignore[no-untyped-def]
    from matplotlib.font_manager import findfont
    from PIL import ImageFont

    return ImageFont.truetype(findfont("DejaVu Sans"), size)


