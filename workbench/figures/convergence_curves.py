"""Convergence of several solvers: energy, relative error, gradient norm and inverted simplices over iterations and seconds."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from workbench.core.arrays import Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure
    from matplotlib.legend import Legend

    from workbench.engine.race import Race

COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#e69f00", "#56b4e9")
"""Okabe and Ito 2008, without their yellow: they differ for every eye."""
DASHES = ("-", "--", "-.", (0, (1, 1.2)), (0, (5, 1, 1, 1, 1, 1)))
MARKS = ("o", "s", "^", "D", "v", "P", "X")
PANEL = (3.5, 1.9)
"""Width and height of a panel, inches."""
MOST_LINEAR = 20.0
"""Inverted simplices up to which their axis is not logarithmic."""
QUANTITIES = {
    "energy": "energy",
    "relative_error": "relative error to the best",
    "gradient_norm": "gradient norm",
    "inverted": "inverted",
}
LETTERS = 112
"""Of a row of the legend, about ten of them for each of its lines."""


@dataclass(frozen=True, eq=False)
class Curve:
    """The history of one contestant; every array is (rows,).

    `relative_error` is NaN where the anchors lag; `switches` are rows at which something was switched;
    `is_constant` marks a map from elsewhere, which has one row and no time.
    """

    label: str
    iteration: Floats
    seconds: Floats
    energy: Floats
    relative_error: Floats
    gradient_norm: Floats
    inverted: Floats
    switches: tuple[int, ...] = ()
    is_constant: bool = False


def curves_of(race: Race) -> list[Curve]:
    """The histories of a race as it stands."""
    return [
        Curve(
            label=racer.label,
            iteration=np.array([row.iteration for row in racer.rows], dtype=float),
            seconds=np.array([row.seconds for row in racer.rows]),
            energy=np.array([row.energy for row in racer.rows]),
            relative_error=race.relative_errors(racer),
            gradient_norm=np.array([row.gradient_norm for row in racer.rows]),
            inverted=np.array([row.inverted for row in racer.rows], dtype=float),
            switches=tuple(marker.index for marker in racer.markers),
            is_constant=racer.solver is None,
        )
        for racer in race.racers
    ]


def convergence_curves(curves: Sequence[Curve], title: str = "") -> Figure:
    """The figure: a row of panels a quantity, left over iterations, right over seconds; logarithmic axes, one legend below.

    A row of zeros alone (no simplex is ever inverted) is drawn, too: it is a result.
    """
    from matplotlib.figure import Figure

    fitting = max(LETTERS // (max((len(curve.label) for curve in curves), default=0) + 10), 1)
    legend_rows = -(-len(curves) // fitting)
    columns = -(-len(curves) // max(legend_rows, 1))  # rows of the legend alike in length
    figure = Figure(figsize=(2 * PANEL[0], len(QUANTITIES) * PANEL[1] + 0.5 + 0.2 * legend_rows), layout="constrained")
    heights = [1.0, 1.0, 1.0, 1.0 if any(curve.inverted.any() for curve in curves) else 0.35]
    panels = figure.subplots(
        len(QUANTITIES), 2, sharex="col", sharey="row", squeeze=False, gridspec_kw={"height_ratios": heights}
    )
    for row, (name, words) in zip(panels, QUANTITIES.items(), strict=True):
        for panel, axis in zip(row, ("iteration", "seconds"), strict=True):
            _draw(panel, name, axis, curves)
        row[0].set_ylabel(words, fontsize=8)
    panels[-1][0].set_xlabel("iterations", fontsize=8)
    panels[-1][1].set_xlabel("seconds", fontsize=8)
    handles, labels = panels[0][0].get_legend_handles_labels()
    without_mathematics(
        figure.legend(handles, labels, loc="outside lower center", ncols=columns, frameon=False, fontsize=8, handlelength=3.2)
    )
    if title:
        figure.suptitle(title, fontsize=10, parse_math=False)
    return figure


def without_mathematics(legend: Legend) -> None:
    """Words between dollar signs in a legend, as names of files may have them, are drawn as they stand."""
    for text in legend.get_texts():
        text.set_parse_math(False)


def _draw(panel: Axes, name: str, axis: str, curves: Sequence[Curve]) -> None:
    finite = []
    for index, curve in enumerate(curves):
        x, y = getattr(curve, axis), getattr(curve, name)
        style: dict[str, Any] = {
            "color": COLOURS[index % len(COLOURS)],
            "linestyle": DASHES[index % len(DASHES)],
            "linewidth": 1.3,
            "label": curve.label,
        }
        shown = np.where(np.isfinite(y) & ((y > 0) | (name == "inverted")), y, np.nan)
        finite.append(shown[np.isfinite(shown)])
        if curve.is_constant:
            panel.axhline(shown[-1], **style)
            continue
        mark = MARKS[index % len(MARKS)]
        panel.plot(x, shown, marker=mark, ms=3, markevery=_few(len(x)), **style)
        switches = list(curve.switches)
        panel.plot(x[switches], shown[switches], "|", color=style["color"], ms=12, mew=1.5)
    _scale(panel, name, axis, np.concatenate(finite) if finite else np.empty(0), curves)
    panel.grid(True, color="#dddddd", linewidth=0.6)
    panel.tick_params(labelsize=7, which="both")
    panel.spines[["top", "right"]].set_visible(False)


def _plain_ticks(axis: Axis, values: Sequence[float]) -> None:
    """Numbers in full on a logarithmic axis that spans little: 2, 5, 10, 20 instead of powers of ten."""
    from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

    axis.set_minor_formatter(NullFormatter())
    if values and min(values) >= 1e-4 and max(values) < min(1e5, 300 * min(values)):
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)) if max(values) > 6 * min(values) else MaxNLocator(5))
        axis.set_major_formatter("{x:g}")


def _few(count: int) -> list[int]:
    """Some rows at even distances on a logarithmic axis, the first and the last among them."""
    steps = np.unique(np.rint(np.geomspace(1, max(count, 1), 8)).astype(int) - 1)
    return [int(step) for step in steps]


def _scale(panel: Axes, name: str, axis: str, values: Floats, curves: Sequence[Curve]) -> None:
    if axis == "iteration":
        panel.set_xscale("symlog", linthresh=1.0, linscale=0.4)
        panel.set_xlim(left=0.0)
        panel.xaxis.set_major_formatter("{x:g}")
    elif any((curve.seconds > 0).any() for curve in curves):
        panel.set_xscale("log", nonpositive="mask")
        _plain_ticks(panel.xaxis, [x for curve in curves for x in curve.seconds.tolist() if x > 0])
    if name == "inverted":
        most = max(1.0, float(values.max(initial=0.0)))
        if most > MOST_LINEAR:
            panel.set_yscale("symlog", linthresh=1.0, linscale=0.5)
        panel.set_ylim(-0.07 * min(most, MOST_LINEAR), 1.1 * most)
        panel.yaxis.set_major_formatter("{x:g}")
        panel.yaxis.get_major_locator().set_params(**({"integer": True} if most <= MOST_LINEAR else {}))
    elif len(values):
        panel.set_yscale("log", nonpositive="mask")
        if float(values.max()) <= 1.05 * float(values.min()):  # rounding is no curve
            panel.set_ylim(0.9 * float(values.min()), 1.1 * float(values.max()))
        _plain_ticks(panel.yaxis, values.tolist())
    else:
        panel.text(0.5, 0.5, "nothing finite above 0", ha="center", va="center", transform=panel.transAxes, fontsize=8)
