"""Where held anchors go: a turn about a centre, and a shift."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from workbench.core.arrays import Floats


def _nothing() -> Floats:
    return np.zeros(3)


@dataclass(frozen=True, eq=False)
class RigidMotion:
    """p -> centre + R (p - centre) + shift; in the plane the third coordinates are 0.

    `shift`, `centre` : (3,) float64;  `turn` : (3,) float64, axis times angle in radians, any number of turns
    """

    shift: Floats = field(default_factory=_nothing)
    turn: Floats = field(default_factory=_nothing)
    centre: Floats = field(default_factory=_nothing)

    def of(self, points: Floats, part: Floats | float = 1.0) -> Floats:
        """(k, d) where points (k, d) are afterwards; those of a motion without a turn are shifted and nothing else.

        `part` : of the motion that each point makes, one number or (k,)
        """
        d, each = points.shape[1], np.broadcast_to(part, len(points))[:, None]
        if not self.turn.any():
            return np.asarray(points + each * self.shift[:d])
        from scipy.spatial.transform import Rotation  # slow to import, and not wanted before something turns

        arms = np.zeros((len(points), 3))
        arms[:, :d] = points - self.centre[:d]
        turned = Rotation.from_rotvec(each * self.turn).apply(arms)[:, :d]
        return np.asarray(self.centre[:d] + each * self.shift[:d] + turned)

    def part(self, part: float) -> RigidMotion:
        """The way to it: 0 is where it begins, 1 the whole of it."""
        return replace(self, shift=part * self.shift, turn=part * self.turn)

    @property
    def angle(self) -> float:
        """Radians of the turn, more than a whole one where it goes round more than once."""
        return float(np.linalg.norm(self.turn))
