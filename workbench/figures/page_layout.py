"""Where the parts of a figure stand on its page, in mm from the upper left corner."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

MM_OF_POINT = 25.4 / 72
GAP = 3.0
"""Between columns and between rows, mm."""
MARGIN = 1.0
TALLEST = 1.25
"""Height of a picture, as a part of its width, that it has at the most."""
CHART = 0.66
"""Height of a chart, as a part of its width, in a row without pictures."""
LEAST_HEIGHT = 8.0
LINE = 1.25
"""Height of a line of text, in font sizes."""
INSET, ASIDE = 3.5, 0.6
"""Room at the left of a chart for its numbers and words, and at its right, in lines."""
BAR = 2.2
"""Thickness of a colour bar, mm."""
BAR_LENGTH = 0.86
"""Of the width of its panel."""
LONGEST_BAR = 80.0


@dataclass(frozen=True)
class Cell:
    """What a panel needs: `aspect` is the height of its picture over its width, 0 where it has none.

    `caption` and `words` are lines of text above, and below a colour bar or a chart. `has_axes`: a chart with numbers and
    words along two sides. `is_bar`: nothing but a colour bar.
    """

    span: int = 1
    aspect: float = 0.0
    caption: int = 0
    words: int = 1
    has_bar: bool = False
    has_axes: bool = False
    is_bar: bool = False


@dataclass(frozen=True)
class Box:
    """A rectangle: left edge, upper edge, width, height, mm."""

    left: float
    top: float
    width: float
    height: float


@dataclass(frozen=True)
class Place:
    """Where a panel stands: all of it with its caption, its picture or chart, its colour bar."""

    whole: Box
    inside: Box
    bar: Box | None = None

    @property
    def reach(self) -> float:
        """From the left edge of the panel to the right one of its chart, mm."""
        return self.inside.left + self.inside.width - self.whole.left


@dataclass(frozen=True)
class PageLayout:
    """`places` of the panels in their order; the page is `width` by `height` mm, `top` of it for a title."""

    width: float
    height: float
    places: tuple[Place, ...]


def lay_out(cells: Sequence[Cell], width: float, columns: int, font_size: float, has_title: bool = False) -> PageLayout:
    """Panels row by row, each as many columns wide as it spans; a row is as high as its highest picture asks for.

    `width` in mm, `font_size` in points.
    """
    line = LINE * font_size * MM_OF_POINT
    column = panel_width(width, columns)
    top = MARGIN + (1.6 * line if has_title else 0.0)
    places: list[Place] = []
    for numbers in rows_of([cell.span for cell in cells], columns):
        row = [cells[number] for number in numbers]
        lines = max(cell.caption for cell in row)
        heading = (lines + 0.25) * line if lines else 0.0
        widths = [panel_width(width, columns, cell.span) for cell in row]
        inner = _inner_height(row, widths, line)
        below = max((_below(cell, line) for cell in row), default=0.0)
        used = 0
        for cell, wide in zip(row, widths, strict=True):
            left = MARGIN + used * (column + GAP)
            used += cell.span
            places.append(_place(cell, Box(left, top, wide, heading + inner + below), heading, inner, line))
        top += heading + inner + below + GAP
    return PageLayout(width, max(top - GAP, 0.0) + MARGIN, tuple(places))


def panel_width(width: float, columns: int, span: int = 1) -> float:
    """Of a panel on a page so wide, mm."""
    column = (width - 2 * MARGIN - (columns - 1) * GAP) / columns
    return span * column + (span - 1) * GAP


def bar_length(width: float) -> float:
    """Of the colour bar of a panel so wide, mm."""
    return min(BAR_LENGTH * width, LONGEST_BAR)


def chart_reach(width: float, font_size: float) -> float:
    """From the left edge of a panel so wide to the right one of its chart, mm."""
    return width - ASIDE * LINE * font_size * MM_OF_POINT


def rows_of(spans: Sequence[int], columns: int) -> list[list[int]]:
    """Numbers of the panels of each row."""
    rows: list[list[int]] = []
    free = 0
    for number, span in enumerate(spans):
        if span > free:
            rows.append([])
            free = columns
        rows[-1].append(number)
        free -= span
    return rows


def _inner_height(row: Sequence[Cell], widths: Sequence[float], line: float) -> float:
    """Height of pictures and charts of a row; 0 where it has colour bars alone."""
    pictures = [min(cell.aspect, TALLEST) * wide for cell, wide in zip(row, widths, strict=True) if cell.aspect > 0]
    charts = [CHART * wide for cell, wide in zip(row, widths, strict=True) if cell.has_axes]
    if pictures:
        return max(LEAST_HEIGHT, *pictures, *(min(height, 7 * line) for height in charts))
    return max(min(charts), 8 * line) if charts else 0.0


def _below(cell: Cell, line: float) -> float:
    """What a panel needs below its picture: numbers and words of a chart or of a colour bar."""
    more = (cell.words - 1) * line
    if cell.has_axes:
        return 2.6 * line + more
    return BAR + 2.5 * line + more + (0.5 * line if not cell.is_bar else 0.0) if cell.has_bar or cell.is_bar else 0.0


def _place(cell: Cell, whole: Box, heading: float, inner: float, line: float) -> Place:
    top = whole.top + heading
    inset = INSET * line if cell.has_axes else 0.0
    inside = Box(whole.left + inset, top, max(whole.width - inset - (ASIDE * line if inset else 0.0), 1.0), inner)
    if not (cell.has_bar or cell.is_bar):
        return Place(whole, inside)
    length = bar_length(whole.width)
    bar_top = top + inner + (0.0 if cell.is_bar else 0.5 * line)
    return Place(whole, inside, Box(whole.left + 0.5 * (whole.width - length), bar_top, length, BAR))
