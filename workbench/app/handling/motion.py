"""What the hand does to the anchors that it holds."""

from __future__ import annotations

from typing import Protocol

from workbench.core.arrays import Floats


class Motion(Protocol):
    """A map of places from where the anchors were taken up, that can be gone in parts."""

    def of(self, points: Floats, part: Floats | float = 1.0) -> Floats:
        """(k, d) where points (k, d) are afterwards; `part` of the motion that each makes, one number or (k,)."""
        ...

    def part(self, part: float) -> Motion:
        """The way to it: 0 is where it begins, 1 the whole of it."""
        ...

    @property
    def turn(self) -> Floats:
        """(3,) axis times radians; 0 where nothing turns."""
        ...

    @property
    def angle(self) -> float:
        """Radians of the turn, more than a whole one where it goes round more than once."""
        ...
