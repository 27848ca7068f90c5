"""A film of maps of one mesh: every frame in the same place, on the same scales."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.errors import WorkbenchError
from workbench.core.mesh import Mesh
from workbench.figures.colour_scale import INVERTED
from workbench.figures.composer import measure_of, paint_of, title_of
from workbench.figures.figure_maps import FigureMap
from workbench.figures.film_overlay import draw_overlay, has_overlay
from workbench.figures.film_page import GROUNDS, INKS, Box, Cell, FilmPage, make_page
from workbench.figures.film_shading import Paint, Pixels, draw_triangles
from workbench.figures.mesh_panel import PLAIN_COLOUR, WIRE_COLOUR, Scene, colours_of, scene_of
from workbench.figures.mesh_pictures import FINER, Frame, frame_round, shades
from workbench.figures.picture_sampling import fitting
from workbench.figures.recipe import PLAIN, TEXTURES, Panel
from workbench.figures.solid_panel import takes_away, veiled
from workbench.figures.texture_panel import picture_of, texture_places

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
WIRES = {True: (0.62, 0.70, 0.78), False: WIRE_COLOUR}
"""Colours of wires that show no measure, on dark and on light grounds."""
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
    cuts : (c, 2) int64           edges that a fix opened, drawn with the seams
    """

    panels: tuple[Panel, ...]
    width: int = 960
    height: int = 720
    rate: float = 25.0
    ground: str = "white"
    has_captions: bool = True
    repeats: bool = True
    cuts: Integers = field(default_factory=lambda: np.empty((0, 2), np.int64), repr=False, compare=False)

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
        self._first = FigureMap("", mesh, stills[0].positions(), np.empty(0, np.int64), cuts=film.cuts)
        for panel in film.panels:
            scene_of(self._first, panel)  # makes what all frames share
        self._pictures = [picture_of(panel) for panel in film.panels]
        self._fitted: dict[int, Floats] = {}
        frames = self._frames(stills, look)
        self._paints = self._fitted_paints(stills, look)
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
        if index not in self._paints or not panel.bar:
            return Cell(panel.caption.strip(), aspect)
        return Cell(panel.caption.strip(), aspect, self._paints[index], title_of(measure_of(panel)))

    # ------------------------------------------------------------------------------------------ what all frames share

    def _map(self, still: Still) -> FigureMap:
        return self._first.moved(still.positions(), np.array(still.anchors, dtype=np.int64))

    def _frames(self, stills: Iterable[Still], look: Callable[[], None]) -> list[Frame]:
        """About all of the motion, one of each panel."""
        panels = self.film.panels
        lows: list[Floats] = [np.full(2, np.inf) for _ in panels]
        highs: list[Floats] = [np.full(2, -np.inf) for _ in panels]
        for number, still in enumerate(stills):
            look()
            moved = self._first.moved(still.positions(), np.empty(0, np.int64))
            for index, panel in enumerate(panels):
                if panel.kind == "source" and number:
                    continue
                # without a cut: all of a solid counts, and the picture stands still whatever is looked at of it
                places = scene_of(moved, replace(panel, look=None)).points[:, :2]
                lows[index] = np.minimum(lows[index], [column.min() for column in places.T])
                highs[index] = np.maximum(highs[index], [column.max() for column in places.T])
        return [frame_round(np.stack(ends)) for ends in zip(lows, highs, strict=True)]

    def _fitted_paints(self, stills: Sequence[Still], look: Callable[[], None]) -> dict[int, ScalarMappable]:
        """Of each panel that shows a measure; where the colours are not given they are fitted to frames all over the film."""
        coloured = [index for index, panel in enumerate(self.film.panels) if panel.has_measure]
        found: dict[int, list[Floats]] = {index: [] for index in coloured}
        for row in np.unique(np.linspace(0, len(stills) - 1, SAMPLED).astype(int)) if coloured else []:
            look()
            moved = self._map(stills[row])
            for index in coloured:
                found[index].append(moved.values(measure_of(self.film.panels[index]))[~moved.singular_values.inverted])
        return {index: paint_of([self.film.panels[index]], parts) for index, parts in found.items()}

    # ------------------------------------------------------------------------------------------ frames

    def draw(self, still: Still) -> Pixels:
        """(height, width, 3) uint8"""
        moved, pixels = self._map(still), self.page.pixels.copy()
        for index, box in enumerate(self.page.boxes):
            part = pixels[box.top : box.top + box.height, box.left : box.left + box.width]
            picture = np.ascontiguousarray(part)
            self._draw_panel(index, moved, picture)
            part[:] = picture
        if self.film.has_captions and still.caption:
            _write(pixels, self.page.caption, still.caption, self.page.font_size, INKS[self.film.ground])
        return pixels

    def _draw_panel(self, index: int, moved: FigureMap, picture: Pixels) -> None:
        frame, panel = self._frames_of[index], self.film.panels[index]
        scene = scene_of(moved, panel)
        left, _, bottom, _ = frame.extent
        pixels = np.column_stack([(scene.points[:, :2] - [left, bottom]) * frame.density, scene.points[:, 2:]])
        if not panel.wires:
            draw_triangles(pixels, scene.skin.triangles, scene.inverted.astype(np.int64), self._paint(index, scene), picture)
        if takes_away(scene):
            solid = np.concatenate([picture / 255.0, np.ones((*picture.shape[:2], 1))], axis=2)
            picture[:] = np.rint(255.0 * veiled(solid, scene, frame)[..., :3]).astype(np.uint8)
        if has_overlay(panel):
            colours = self._colours(index, scene, WIRES[self.is_dark])
            ground = self.film.ground
            draw_overlay(scene, frame, colours, picture, self.page.font_size, INKS[ground], GROUNDS[ground])
        if panel.anchors and len(moved.anchors):
            radius = ANCHOR_SIZE * self.page.font_size * (0.5 if len(moved.anchors) > MANY else 1.0)
            for x, y in pixels[moved.anchors, :2].tolist():
                _disc(picture, x, len(picture) - y, radius)

    def _paint(self, index: int, scene: Scene) -> Paint:
        panel = self.film.panels[index]
        if panel.is_textured:
            paint = self._texture(index, scene)
        else:
            paint = Paint(self._colours(index, scene, self._plain), np.empty((0, 2)))
        if panel.edges:
            paint = replace(paint, edge=EDGES[self.is_dark], strength=PLAIN_EDGES if panel.colour == PLAIN else OTHER_EDGES)
        if scene.is_flat:
            return paint
        return replace(paint, colours=paint.colours * shades(scene.points, scene.skin)[:, None])

    def _colours(self, index: int, scene: Scene, plain: tuple[float, float, float]) -> Floats:
        """(k, 3) of the visible triangles where no texture lies on them."""
        panel = scene.panel
        values = scene.map.values(measure_of(panel))[scene.skin.simplex] if panel.has_measure else None
        return colours_of(scene, self._paints.get(index), values, plain)

    def _texture(self, index: int, scene: Scene) -> Paint:
        white, places = np.ones((len(scene.skin.triangles), 3)), texture_places(scene)
        picture = self._pictures[index]
        if picture is None:
            return Paint(white, places, TEXTURES.index(scene.panel.colour))
        if index not in self._fitted:  # once: a picture that is made smaller here and not there would flicker
            density = FINER * self._frames_of[index].density
            self._fitted[index] = fitting(picture, places, scene.points * density, scene.skin.triangles)
        return Paint(white, places[:, :2], picture=self._fitted[index])


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
