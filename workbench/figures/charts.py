"""Charts of a figure: colour bars, histograms, curves; text is drawn as it stands, never as mathematics."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.signature import Signature, heights_on_axis
from workbench.figures.colour_scale import LOGARITHMIC
from workbench.figures.convergence_curves import COLOURS, DASHES, MARKS, without_mathematics
from workbench.figures.recipe import QUANTITIES
from workbench.figures.text_fit import fit_lines, fit_text, text_width

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure

    from workbench.figures.figure_maps import FigureMap

TICKS = 5
"""Numbers beside a colour bar, at the most."""
FIELDS = {"energy": "energy", "gradient-norm": "gradient_norm", "inverted": "inverted"}
LABEL = 0.95
"""Size of words beside axes, in that of the text."""
BEYOND_BAR = 1.14
"""Width of the words below, as a part of that of a colour bar."""
MOST_MARKED = 30
"""Steps of a curve up to which each has its mark."""


def draw_bar(axes: Axes, paint: ScalarMappable, label: str, font_size: float, most_lines: int = 1) -> None:
    """A horizontal colour bar with its words below; an arrow at the end beyond which there are values."""
    from matplotlib.colors import LogNorm

    figure = axes.figure
    bar: Any = figure.colorbar(paint, cax=axes, orientation="horizontal", extend="max", extendfrac=0.03)
    bar.solids.set_rasterized(False)
    bar.solids.set_edgecolor("face")  # no hairlines between its parts
    low, high = float(bar.vmin), float(bar.vmax)
    spans_much = low > 0 and high > LOGARITHMIC * low
    is_logarithmic = spans_much and isinstance(paint.norm, LogNorm)
    places, labels = fitting_ticks(low, high, _width(axes), 0.85 * font_size, is_logarithmic=is_logarithmic)
    bar.set_ticks(places, labels=labels)
    bar.minorticks_off()
    bar.outline.set_linewidth(0.4)
    axes.tick_params(labelsize=0.85 * font_size, length=0.3 * font_size, width=0.4, pad=0.15 * font_size)
    words, size = fit_lines(label, BEYOND_BAR * _width(axes), LABEL * font_size, most_lines)
    axes.set_xlabel(words, fontsize=size, labelpad=0.2 * font_size, parse_math=False)


def tick_places(low: float, high: float, *, is_logarithmic: bool) -> list[float]:
    """Up to `TICKS` round numbers between two, in ascending order; the two themselves where fewer than two are round."""
    from matplotlib.ticker import MaxNLocator

    if is_logarithmic:
        powers = range(int(np.floor(np.log10(low))), int(np.ceil(np.log10(high))) + 1)
        found = [digit * 10.0**power for power in powers for digit in (1, 2, 5)]
        if sum(low <= place <= high for place in found) > TICKS:
            found = [10.0**power for power in powers]
    else:
        found = [float(place) for place in MaxNLocator(TICKS - 1, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high)]
    slack = 1e-9 * (high - low)
    inside = [place for place in found if low - slack <= place <= high + slack]
    step = -(-len(inside) // TICKS) if inside else 1
    return inside[::step] if len(inside) >= 2 else [low, high]


def fitting_ticks(
    low: float, high: float, width: float, font_size: float, *, is_logarithmic: bool
) -> tuple[list[float], list[str]]:
    """Places and words of `tick_places`, as many of them as keep apart along `width` mm."""
    places = tick_places(low, high, is_logarithmic=is_logarithmic)
    labels = [f"{place:.6g}" for place in places]
    while len(places) > 1 and text_width("  ".join(labels), font_size) > width:
        places, labels = places[::2], labels[::2]
    return places, labels


def draw_histograms(
    axes: Axes,
    items: Sequence[Signature],
    edges: Floats,
    label: str,
    font_size: float,
    *,
    room: float,
    is_logarithmic: bool,
    tallest: float,
    paint: ScalarMappable | None = None,
) -> None:
    """Normalised histograms over common bins, in the colours of a colour bar where there is one map and one bar.

    `room` is the width of the panel, mm; `tallest` the density up to which the axis reaches.
    """
    heights = [heights_on_axis(item, edges, logarithmic=is_logarithmic) for item in items]
    if len(items) == 1:
        colours = COLOURS[0] if paint is None else paint.to_rgba(np.clip(0.5 * (edges[1:] + edges[:-1]), *paint.get_clim()))
        axes.bar(edges[:-1], heights[0], np.diff(edges), align="edge", color=colours, linewidth=0)
        axes.stairs(heights[0], edges, color="#303030", linewidth=0.05 * font_size)
    else:
        for index, (item, height) in enumerate(zip(items, heights, strict=True)):
            colour = COLOURS[index % len(COLOURS)]
            axes.stairs(height, edges, color=colour, alpha=0.18, fill=True)
            axes.stairs(height, edges, color=colour, linewidth=0.14 * font_size, label=item.name)
        _legend(axes, font_size)
    if is_logarithmic:
        axes.set_xscale("log")
        axes.minorticks_off()
    low, high = float(edges[0]), float(edges[-1])
    places, labels = fitting_ticks(low, high, _width(axes), 0.85 * font_size, is_logarithmic=is_logarithmic)
    axes.set_xticks(places, labels=labels)
    axes.set(xlim=(edges[0], edges[-1]), ylim=(0.0, 1.05 * tallest))
    _words(axes, label, "density per decade" if is_logarithmic else "density", font_size, room)


def draw_curves(axes: Axes, maps: Sequence[FigureMap], quantity: str, font_size: float, room: float) -> None:
    """A quantity over the iterations, a curve a map; `room` is the width of the panel, mm."""
    least, most = np.inf, 0.0
    for index, item in enumerate(maps):
        x = [row.iteration for row in item.rows]
        y = np.array([getattr(row, FIELDS[quantity]) for row in item.rows], dtype=float)
        y[~np.isfinite(y)] = np.nan
        shown = y[y > 0]
        least, most = min(least, *shown, np.inf), max(most, *shown, 0.0)
        mark = MARKS[index % len(MARKS)]
        axes.plot(
            x, y, color=COLOURS[index % len(COLOURS)], linestyle=DASHES[index % len(DASHES)], marker=mark,
            markevery=max(1, len(x) // MOST_MARKED), ms=0.3 * font_size, linewidth=0.13 * font_size, label=item.title,
        )  # fmt: skip
    if quantity != "inverted" and most > LOGARITHMIC * least:
        axes.set_yscale("log")
        axes.minorticks_off()
    if len(maps) > 1:
        _legend(axes, font_size)
    axes.locator_params(axis="x", nbins=TICKS, integer=True)
    _words(axes, "iterations", QUANTITIES[quantity], font_size, room)


def _legend(axes: Axes, font_size: float) -> None:
    without_mathematics(
        axes.legend(fontsize=0.85 * font_size, frameon=False, handlelength=1.8, borderaxespad=0.2, labelspacing=0.25)
    )


def _label_below(axes: Axes, words: str, font_size: float, room: float) -> None:
    """Words in `room` mm that end where the axes do, if they do not fit below the axes themselves."""
    own = _width(axes)
    words, fitted = fit_lines(words, max(room, own), LABEL * font_size)
    label = axes.set_xlabel(words, fontsize=fitted, labelpad=0.2 * font_size, parse_math=False)
    widest = max(text_width(line, fitted) for line in words.split("\n"))
    if widest > own:
        label.set_x(1 - 0.5 * widest / own)


def _width(axes: Axes) -> float:
    """Of axes, mm."""
    return float(axes.get_position().width * _page_of(axes).get_figwidth() * 25.4)


def _page_of(axes: Axes) -> Figure:
    page: Any = axes.figure  # there are no figures within figures here
    return page


def _words(axes: Axes, below: str, left: str, font_size: float, room: float) -> None:
    _label_below(axes, below, font_size, room)
    height = axes.get_position().height * _page_of(axes).get_figheight() * 25.4
    left, size = fit_text(left, height, LABEL * font_size)
    axes.set_ylabel(left, fontsize=size, labelpad=0.3 * font_size, parse_math=False)
    axes.tick_params(labelsize=0.85 * font_size, length=0.3 * font_size, width=0.4, pad=0.2 * font_size)
    axes.spines[["top", "right"]].set_visible(False)
    if axes.get_yscale() == "linear":
        axes.locator_params(axis="y", nbins=5)
    axes.spines[["left", "bottom"]].set_linewidth(0.5)
    axes.patch.set_alpha(0.0)
