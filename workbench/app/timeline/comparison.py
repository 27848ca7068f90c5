"""How two moments differ: maps, values of a quantity on both, displacement."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from workbench.app.race.difference import aligned, displacements
from workbench.app.timeline.looking_back import Measurer, measured
from workbench.app.timeline.recorder import anchors_of
from workbench.core.arrays import Booleans, Floats
from workbench.core.measure import Measure
from workbench.session.moments import Moment


@dataclass(frozen=True, eq=False)
class Comparison:
    """Two moments of one mesh, `first` and `second`, and what a quantity is on them.

    Parameters
    ----------
    maps : two (n, d)              the second is turned onto the first where too few anchors hold it
    values : two (m,) float32
    inverted : two (m,) bool
    distances : (m,) float32       how far corners lie apart on the average, as a part of the diameter of the source
    largest : float                of the distances of vertices, in the same unit
    """

    first: Moment
    second: Moment
    maps: tuple[Floats, Floats]
    values: tuple[np.ndarray, np.ndarray]
    inverted: tuple[Booleans, Booleans]
    distances: np.ndarray
    largest: float

    @property
    def difference(self) -> np.ndarray:
        """(m,) of the values, second less first; NaN where both are infinite."""
        with np.errstate(invalid="ignore", over="ignore"):
            return self.values[1] - self.values[0]

    @property
    def sentence(self) -> str:
        """The numbers in words."""
        a, b = self.first, self.second
        change = f" ({100 * (b.energy / a.energy - 1):+.3g} %)" if np.isfinite([a.energy, b.energy]).all() and a.energy else ""
        told = f"E of A {a.energy:.6g}, of B {b.energy:.6g}{change}"
        if a.distortion != b.distortion:
            told += f"; A minimised {a.distortion}, B {b.distortion}"
        counts = f"; inverted {a.inverted_count} and {b.inverted_count}" if a.inverted_count or b.inverted_count else ""
        return f"{told}. Largest displacement {100 * self.largest:.3g} % of the diameter of the source{counts}."


def compare(measurer: Measurer, first: Moment, second: Moment, measure: Measure, *, is_held: bool) -> Comparison:
    """Measure two moments; for a thread. `is_held`: place and direction of the maps mean something also without anchors."""
    one, other = first.positions, second.positions
    if not is_held and min(len(anchors_of(first).vertices), len(anchors_of(second).vertices)) < 2:
        other = aligned(other, one)
    values = [measurer.singular_values(moment) for moment in (first, second)]
    diameter = measurer.mesh.diameter
    return Comparison(
        first,
        second,
        (one, other),
        (measured(measure, values[0]), measured(measure, values[1])),
        (first.inverted, second.inverted),
        (displacements(other, one, measurer.mesh.simplices) / diameter).astype(np.float32),
        float(np.linalg.norm(other - one, axis=1).max()) / diameter,
    )
