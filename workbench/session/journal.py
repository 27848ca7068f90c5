"""How a map came to be: stretches of plain iteration that can be repeated."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Literal

from workbench.core.arrays import Floats
from workbench.session.session import Session

Origin = Literal["start", "previous", "map"]
"""Where a leg begins: at the start that the choices make, where the leg before ended, or at a map that is recorded."""
LONGEST = 2048
"""Legs that are kept."""


@dataclass(frozen=True, eq=False)
class Leg:
    """So many iterations of one solver on one problem.

    Parameters
    ----------
    choices : Session        distortion, solver, anchors and the like that were in force
    origin : str             see `Origin`
    positions : (n, d)       float64, where it began; None where it goes on from the leg before
    iterations : int         steps taken
    number, begin : int      its number in the engine, and the iteration at which it began
    """

    choices: Session
    origin: Origin
    positions: Floats | None = None
    iterations: int = 0
    number: int = 0
    begin: int = 0


class Journal:
    """The legs of a window, oldest first. What a hand did in between is in the positions with which the next one begins."""

    def __init__(self, legs: Iterable[Leg] = ()) -> None:
        self._legs = list(legs)

    def __len__(self) -> int:
        return len(self._legs)

    def clear(self) -> None:
        self._legs.clear()

    def add(self, leg: Leg) -> None:
        """A leg has begun; the one before it, where it goes on from there, has ended at this iteration."""
        if leg.origin == "previous":
            if not self._legs:
                return  # what it goes on from is not known any longer
            last = self._legs[-1]
            self._legs[-1] = replace(last, iterations=leg.begin - last.begin)
        else:
            self._legs.clear()
        self._legs.append(leg)
        if len(self._legs) > LONGEST:
            self._forget_oldest()

    def _forget_oldest(self) -> None:
        """Up to the next leg that can stand at the head."""
        heads = [i for i, leg in enumerate(self._legs) if i and leg.positions is not None]
        if heads:
            head = heads[0] if len(heads) == 1 else heads[len(heads) // 2]
            self._legs = [replace(self._legs[head], origin="map"), *self._legs[head + 1 :]]

    def way_to(self, number: int, iteration: int) -> tuple[Leg, ...]:
        """The legs that lead to the map which leg `number` had at `iteration`; none where that is not known."""
        place = next((i for i, leg in enumerate(self._legs) if leg.number == number), -1)
        if place < 0 or iteration < self._legs[place].begin:
            return ()
        last = self._legs[place]
        return (*self._legs[:place], replace(last, iterations=iteration - last.begin))
