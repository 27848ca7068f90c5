"""Mean distortion against the level of refinement, a panel a distortion, a curve a scheme (Fig. 20)."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from workbench.core.refine import SCHEMES, LevelMeasures

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

STYLES = {"linear": ("#000000", "o"), "loop": ("#0072b2", "s"), "catmull-clark": ("#d55e00", "^")}
"""Colour and mark of each scheme; they differ for every eye, and in print without colour."""

PANEL = (2.6, 2.4)
"""Width and height of a panel, inches."""


def level_curves(curves: Mapping[str, Sequence[LevelMeasures]], title: str = "") -> Figure:
    """The figure.

    Parameters
    ----------
    curves : scheme -> levels     at least one scheme; all with the same measures
    """
    from matplotlib.figure import Figure

    names = list(next(iter(curves.values()))[0].measures)
    columns = min(len(names), 4)
    rows = math.ceil(len(names) / columns)
    width = max(PANEL[0] * columns, 4.2)  # the legend and the title want that much
    figure = Figure(figsize=(width, PANEL[1] * rows + 0.7), layout="constrained")
    panels = figure.subplots(rows, columns, squeeze=False).ravel()
    for panel, name in zip(panels, names, strict=False):
        _draw(panel, name, curves)
    figure.supylabel("mean over the source", fontsize=8)
    for panel in panels[len(names) :]:
        panel.set_axis_off()
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels), frameon=False)
    if title:
        figure.suptitle(title, fontsize=10, parse_math=False)
    return figure


def _draw(panel: Axes, name: str, curves: Mapping[str, Sequence[LevelMeasures]]) -> None:
    for scheme, levels in curves.items():
        colour, mark = STYLES[scheme]
        # what is infinite leaves a gap
        values = [row.measures[name] if math.isfinite(row.measures[name]) else math.nan for row in levels]
        panel.plot([row.level for row in levels], values, color=colour, marker=mark, ms=4, lw=1.3, label=SCHEMES[scheme])
    shown = [row.measures[name] for levels in curves.values() for row in levels if math.isfinite(row.measures[name])]
    if not shown:
        panel.text(0.5, 0.5, "infinite: inverted simplices", ha="center", va="center", transform=panel.transAxes)
        panel.set_yticks([])
    elif max(shown) - min(shown) <= 1e-9 * max(1e-6, *map(abs, shown)):
        # rounding is no curve: without this the axis would zoom into it
        margin = max(0.05 * abs(shown[0]), 1e-3)
        panel.set_ylim(shown[0] - margin, shown[0] + margin)
    panel.set_title(name if len(name) <= 34 else f"{name[:33]}…", fontsize=9, parse_math=False)
    panel.set_xlabel("level", fontsize=8)
    panel.tick_params(labelsize=8)
    panel.ticklabel_format(axis="y", useOffset=False)
    panel.set_xticks([row.level for row in max(curves.values(), key=len)])
    panel.grid(True, axis="y", color="#dddddd", linewidth=0.6)
    panel.spines[["top", "right"]].set_visible(False)
