"""Colour tables: a perceptually uniform map, and NaN for inverted simplices."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from vtkmodules.vtkCommonCore import vtkLookupTable

from workbench.app.appearance.theme import INVERTED, Colour
from workbench.app.views import drawing_style
from workbench.app.views.colour_tables import colour_table
from workbench.figures.colour_scale import CLIPPED_ABOVE, CLIPPED_BELOW

if TYPE_CHECKING:
    from workbench.app.colouring.colour_range import ColourRange

TRIMMED = 34
"""Entries left out at the pale end, which would be lost on a white background."""


def distortion_colours() -> NDArray[np.float64]:
    """Colours (k, 3) in [0, 1] from no distortion to much, pale to strong: as a rule pale blue over violet to red.

    Perceptually uniform (Kovesi 2015, CET-L19). They have no yellow, which stands for inverted simplices.
    """
    return _from_pale(drawing_style.colour_map)


@lru_cache(maxsize=4)
def _from_pale(name: str) -> NDArray[np.float64]:
    table = colour_table(name)
    if table[0].sum() < table[-1].sum():
        table = table[::-1]
    return table[TRIMMED:]


@lru_cache(maxsize=1)
def diverging_colours() -> NDArray[np.float64]:
    """Colours (k, 3) in [0, 1] from blue (less) over a pale middle to red (more).

    Perceptually uniform on both sides (Kovesi 2015, CET-D1); no yellow in it either.
    """
    return colour_table("CET_D1")


def lookup_table(
    colours: NDArray[np.float64], low: float, high: float, *, logarithmic: bool = False, clipped: bool = False
) -> vtkLookupTable:
    """A VTK table of `colours` (k, 3) over [low, high]; NaN is drawn in the colour of inverted simplices.

    `logarithmic`: equal factors have equal steps of colour; `low` is positive then. `clipped`: what lies beyond the ends
    has two colours of its own.
    """
    table = vtkLookupTable()
    if logarithmic:
        table.SetScaleToLog10()
    table.SetNumberOfTableValues(len(colours))
    for row, colour in enumerate(colours):
        table.SetTableValue(row, (*(float(c) for c in colour), 1.0))
    table.SetRange(low, high)
    table.SetNanColor(*INVERTED, 1.0)
    if clipped:
        table.SetBelowRangeColor(*CLIPPED_BELOW, 1.0)
        table.SetAboveRangeColor(*CLIPPED_ABOVE, 1.0)
        table.UseBelowRangeColorOn()
        table.UseAboveRangeColorOn()
    return table


def table_of(colour_range: ColourRange) -> vtkLookupTable:
    """The VTK table of a range as it is now."""
    low, high = colour_range.low, colour_range.high
    ways = {"logarithmic": colour_range.is_logarithmic, "clipped": colour_range.is_clipped}
    return lookup_table(colour_range.colours(), low, high, **ways)


def single_colour(colour: Colour) -> vtkLookupTable:
    """A table that shows every number in one colour and NaN as inverted."""
    return lookup_table(np.array([colour, colour]), 0.0, 1.0)
