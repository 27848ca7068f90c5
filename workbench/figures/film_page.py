"""What stands still in a film: its ground, titles and colour bars, and where the pictures go."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from workbench.figures.film_shading import Pixels

if TYPE_CHECKING:
    from matplotlib.cm import ScalarMappable

GROUNDS = {"white": "#ffffff", "light": "#f3f4f6", "dark": "#15181c"}
INKS = {"white": "#1c2127", "light": "#1c2127", "dark": "#e6e9ec"}
DPI = 100
TITLE, BAR, CAPTION = 1.7, 4.0, 1.8
"""Heights of a title, of a colour bar with its words, and of the caption, in heights of the text."""


@dataclass(frozen=True)
class Box:
    """Part of the page in pixels, from its upper left corner."""

    left: int
    top: int
    width: int
    height: int


@dataclass(frozen=True, eq=False)
class Cell:
    """What goes into a part of the page: a title, and a colour bar where there is a scale; `aspect` is height by width."""

    title: str
    aspect: float
    paint: ScalarMappable | None = None
    words: str = ""


@dataclass(frozen=True, eq=False)
class FilmPage:
    """`pixels` (h, w, 3) without the pictures, the `boxes` of those, and that of the caption."""

    pixels: Pixels
    boxes: tuple[Box, ...]
    caption: Box
    font_size: int


def make_page(cells: Sequence[Cell], width: int, height: int, ground: str, has_caption: bool) -> FilmPage:
    """Lay out and draw all that does not move."""
    size = int(np.clip(round(height / 40), 10, 30))
    bottom = round(CAPTION * size) if has_caption else 0
    whole = Box(size, size // 2, width - 2 * size, height - bottom - size)
    boxes = _boxes(cells, whole, size)
    caption = Box(size, height - bottom, width - 2 * size, bottom)
    return FilmPage(_drawn(cells, boxes, width, height, ground, size), boxes, caption, size)


def _boxes(cells: Sequence[Cell], whole: Box, size: int) -> tuple[Box, ...]:
    """The number of columns in which pictures are largest; each below its title and above its bar."""
    above = round(TITLE * size) if any(cell.title for cell in cells) else 0
    below = round(BAR * size) if any(cell.paint is not None for cell in cells) else 0
    count, gap = len(cells), size
    aspect = max(cell.aspect for cell in cells)

    def inside(columns: int) -> tuple[float, float]:
        rows = -(-count // columns)
        return (whole.width - (columns - 1) * gap) / columns, (whole.height - (rows - 1) * gap) / rows - above - below

    columns = max(range(1, count + 1), key=lambda k: min(inside(k)[0], inside(k)[1] / aspect))
    wide, high = (max(int(length), 8) for length in inside(columns))
    found = []
    for index in range(count):
        row, column = divmod(index, columns)
        in_row = min(columns, count - row * columns)
        left = whole.left + (whole.width - in_row * wide - (in_row - 1) * gap) // 2 + column * (wide + gap)
        found.append(Box(left, whole.top + row * (high + above + below + gap) + above, wide, high))
    return tuple(found)


def _drawn(cells: Sequence[Cell], boxes: Sequence[Box], width: int, height: int, ground: str, size: int) -> Pixels:
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    from workbench.figures.charts import draw_bar
    from workbench.figures.text_fit import fit_text

    ink, points = INKS[ground], size * 72 / DPI
    colours = dict.fromkeys(("text.color", "axes.labelcolor", "xtick.color", "ytick.color", "axes.edgecolor"), ink)
    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        matplotlib.rcParams.update(colours)
        figure = Figure(figsize=(width / DPI, height / DPI), dpi=DPI, facecolor=GROUNDS[ground])
        canvas = FigureCanvasAgg(figure)
        for cell, box in zip(cells, boxes, strict=True):
            if cell.title:
                words, fitted = fit_text(cell.title, box.width * 25.4 / DPI, points)
                middle, y = (box.left + 0.5 * box.width) / width, 1 - (box.top - 0.75 * TITLE * size) / height
                figure.text(middle, y, words, ha="center", va="center", fontsize=fitted, parse_math=False)
            if cell.paint is not None:
                long, top = 0.7 * box.width, box.top + box.height + 0.5 * size
                place = (
                    (box.left + 0.15 * box.width) / width, 1 - (top + 0.7 * size) / height, long / width, 0.7 * size / height
                )  # fmt: skip
                draw_bar(figure.add_axes(place), cell.paint, cell.words, points)
        canvas.draw()
        pixels: Pixels = np.asarray(canvas.buffer_rgba())[..., :3].copy()
    return pixels
