"""Where held anchors go that are scaled about a centre."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from workbench.core.arrays import Floats


@dataclass(frozen=True, eq=False)
class Stretch:
    """p -> centre + factors (p - centre), axis by axis; in the plane the third numbers do not count.

    `factors`, `centre` : (3,) float64
    """

    factors: Floats
    centre: Floats

    def of(self, points: Floats, part: Floats | float = 1.0) -> Floats:
        """(k, d) where points (k, d) are afterwards; `part` as for `RigidMotion.of`."""
        d, each = points.shape[1], np.broadcast_to(part, len(points))[:, None]
        return np.asarray(points + each * (self.factors[:d] - 1.0) * (points - self.centre[:d]))

    def part(self, part: float) -> Stretch:
        """The way to it: 0 is where it begins, 1 the whole of it."""
        return replace(self, factors=1.0 + part * (self.factors - 1.0))

    @property
    def turn(self) -> Floats:
        """A stretch turns nothing."""
        return np.zeros(3)

    @property
    def angle(self) -> float:
        return 0.0
