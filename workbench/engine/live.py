"""What is watched of the newest map, without holding back the map itself."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from workbench.core.arrays import Booleans, Floats
from workbench.core.errors import WorkbenchError
from workbench.core.jacobians import Elements, signed_singular_values
from workbench.core.measure import Evaluator, Measure, SingularValues

DUTY = 0.2
"""Part of the time that colours may take while maps keep coming."""
CHEAP = 0.002
"""Seconds; colours that cost less are made for every map."""
LARGEST = float(np.finfo(np.float32).max)
"""Stands for infinity, and for all that is larger."""


@dataclass(frozen=True, eq=False)
class LiveMeasures:
    """Float32 values (m,) of what is watched, by id; the inverted simplices; the singular values where they are watched."""

    fields: dict[str, Any]
    inverted: Booleans
    singular_values: Any = None


class LiveColours:
    """Measures for the maps of one mesh; on large meshes a moving map carries those of a map some milliseconds older."""

    def __init__(self, elements: Elements) -> None:
        self._elements = elements
        self._evaluators: dict[str, Evaluator] = {}
        self._with_singular_values = False
        self._kept: LiveMeasures | None = None
        self._made_at = 0.0
        self._cost = 0.0

    def watch(self, measures: tuple[Measure, ...], singular_values: bool) -> list[str]:
        """Make these from now on; returns a sentence for each that cannot be made of this mesh, and leaves it out."""
        sentences = []
        evaluators = {}
        for measure in measures:
            try:
                evaluators[measure.id] = measure.prepare(self._elements.dimension)
            except WorkbenchError as error:
                sentences.append(f"{measure.text} cannot be shown: {error.sentence}")
        self._evaluators, self._with_singular_values = evaluators, singular_values
        self._kept = None
        return sentences

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
        found = SingularValues(signed_singular_values(self._elements, positions))
        fields = {id: _single(values(found)) for id, values in self._evaluators.items()}
        self._kept = LiveMeasures(
            fields, found.inverted, found.signed.astype(np.float32) if self._with_singular_values else None
        )
        self._made_at = time.perf_counter()
        self._cost = self._made_at - begin
        return self._kept


def _single(values: Floats) -> Any:
    """(m,) float64 -> float32; what is too large stands at the end of the range."""
    return np.clip(values, -LARGEST, LARGEST).astype(np.float32)
