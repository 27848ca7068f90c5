"""Walking through simplices in an order: the worst by what is shown, or those that are inverted."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QObject

from workbench.app.quantities.quantities import Quantity
from workbench.app.verdict.judging import show_place

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow
    from workbench.engine.messages import Snapshot

ORIGIN = "worst"
"""Name under which the worst simplex is brushed."""
ORDINALS = {1: "Worst", 2: "Second worst", 3: "Third worst"}


class RankedPlaces(QObject):
    """Each walk goes on from the simplex of the last one while that is still marked; the values are those of the map now."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._rank = -1
        self._of = ""

    @property
    def quantity(self) -> Quantity:
        """What is shown: in the target, else in the source, else in the first panel that is open, else in the histogram."""
        window = self._window
        shown = [window.colouring.style_of(pane) for pane in (window.target, window.source)]
        shown += [dock.quantity for dock in window.maps if dock.isVisible()]
        id = next((id for id in shown if id in window.quantities), window.histogram.quantity)
        return window.quantities[id]

    def walk(self, step: int) -> None:
        """To the next worse simplex, or the one before; a first walk goes to the worst of all, or the least bad."""
        window, snapshot = self._window, self._window.document.shown
        if snapshot is None:
            return
        quantity = self.quantity
        values = snapshot.fields.get(quantity.field)
        if values is None:
            window.status.say(f"There are no values of {quantity.title} yet.")
            return
        order = worst_first(quantity, np.asarray(values))
        goes_on = window.brush.origin == ORIGIN and self._of == quantity.id
        self._rank = (self._rank + step if goes_on else min(step, 0)) % len(order)
        self._of = quantity.id
        simplex = int(order[self._rank])
        show_place(window, simplex, ORIGIN)
        window.status.say(self._words(snapshot, quantity, simplex, float(values[simplex])))

    def _words(self, snapshot: Snapshot, quantity: Quantity, simplex: int, value: float) -> str:
        assert self._window.document.mesh is not None
        noun = self._window.document.mesh.simplex_noun()
        rank = self._rank + 1
        place = ORDINALS.get(rank, f"Number {rank:,} from the worst")
        state = ", inverted" if snapshot.inverted[simplex] else ""
        return f"{place}: {noun} {simplex}{state}, {quantity.title} = {value:.5g}"


def worst_first(quantity: Quantity, values: NDArray[np.floating]) -> NDArray[np.int64]:
    """All simplices (m,), the worst first: the largest values, or those that are farthest from what means no distortion."""
    badness = values.astype(np.float64)
    if quantity.centre is not None and quantity.is_logarithmic and quantity.centre > 0:
        positive = badness > 0
        badness = np.where(positive, np.abs(np.log(np.where(positive, badness, 1.0) / quantity.centre)), np.inf)
    elif quantity.centre is not None:
        badness = np.abs(badness - quantity.centre)
    badness[np.isnan(badness)] = np.inf  # what is inverted has no value of some quantities
    return np.argsort(-badness, kind="stable")
