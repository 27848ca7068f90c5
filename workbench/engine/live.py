"""Colours and histogram of the newest map, without holding back the map itself."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.jacobians import Elements
from workbench.core.quality import LiveMeasures, live_measures

DUTY = 0.2
"""Part of the time that colours may take while maps keep coming."""
CHEAP = 0.002
"""Seconds; colours that cost less are made for every map."""


class LiveColours:
    """Measures for the maps of one mesh; on large meshes a moving map carries those of a map some milliseconds older."""

    def __init__(self, elements: Elements) -> None:
        self._elements = elements
        self._kept: LiveMeasures | None = None
        self._made_at = 0.0
        self._cost = 0.0

    def of(self, positions: Floats, *, inverted: int, moving: bool) -> LiveMeasures:
        """What to show with this map: exact unless it is `moving` and colours are dear; `inverted` is exact always."""
        if not moving or inverted or self._kept is None or self._cost <= CHEAP:
            return self._make(positions)
        return replace(self._kept, inverted=np.zeros(len(self._elements.simplices), dtype=bool))

    def catch_up(self, positions: Floats) -> None:
        """After the map is on its way: make its colours for the next one, if it is time to."""
        if self._cost > CHEAP and time.perf_counter() - self._made_at >= self._cost / DUTY:
            self._make(positions)

    def _make(self, positions: Floats) -> LiveMeasures:
        begin = time.perf_counter()
        self._kept = live_measures(self._elements, positions)
        self._made_at = time.perf_counter()
        self._cost = self._made_at - begin
        return self._kept
