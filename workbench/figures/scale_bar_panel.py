"""A scale bar in a panel: a round length in its lower right corner, right across the line of sight."""

from __future__ import annotations

from typing import TYPE_CHECKING

from workbench.core.round_length import round_length
from workbench.figures.mesh_pictures import Frame

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LONGEST = 0.3
"""Of the width of the panel, at the most."""
ASIDE = 0.02
"""From the edge of the panel, as a part of its shorter side."""
TICK = 0.35
"""Height of the ends of the bar, in heights of the text."""
LINE, RIM = 0.8, 2.2
"""Widths of the bar, and of what keeps it apart from a map, points, at 8 points of text."""
WORDS = 6.5
"""Size of the text, points, at 8 points of text."""


def draw_scale_bar(axes: Axes, frame: Frame, size: float, ink: str, paper: str) -> None:
    """Draw the bar in the units of the panel; `size` is a factor of text and lines, `paper` is behind it."""
    left, right, bottom, top = frame.extent
    length = round_length(LONGEST * (right - left))
    if length <= 0.0:
        return
    aside = ASIDE * min(right - left, top - bottom)
    height = axes.get_window_extent().height / axes.figure.dpi * 72  # of the panel, points
    tick = TICK * WORDS * size * (top - bottom) / height
    end, low = right - aside, bottom + aside
    begin = end - length
    for colour, width in ((paper, RIM), (ink, LINE)):
        axes.plot(
            [begin, begin, end, end], [low + tick, low, low, low + tick], color=colour, linewidth=width * size,
            solid_capstyle="butt", solid_joinstyle="miter", zorder=8, gid="scale-bar",
        )  # fmt: skip
    words = axes.annotate(
        f"{length:.6g}", (0.5 * (begin + end), low), (0, 0.45 * WORDS * size), textcoords="offset points", ha="center",
        va="bottom", fontsize=WORDS * size, color=ink, zorder=9, annotation_clip=False,
        bbox={"facecolor": paper, "alpha": 0.75, "linewidth": 0, "boxstyle": "square,pad=0.12"},
    )  # fmt: skip
    words.set_parse_math(False)
