"""The maps of a run, as many as fit: so that one can go back in time."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass

from workbench.core.arrays import Floats


@dataclass(frozen=True, eq=False)
class Frame:
    """A map that was kept: row `index` of the history, with its iteration and its seconds."""

    index: int
    iteration: int
    seconds: float
    positions: Floats


class MapStore:
    """Maps in the order they came, bounded by bytes and thinned evenly: when full, every second one goes.

    The first and the last map are always kept, and those of the iterations that are `pinned`.

    Parameters
    ----------
    limit : int            bytes; pinned maps, the first and the last may go beyond it
    pinned : iterable      iterations
    """

    def __init__(self, limit: int, pinned: Iterable[int] = ()) -> None:
        self._limit = limit
        self._pinned = frozenset(pinned)
        self._frames: list[Frame] = []
        self._stride = 1
        self._bytes = 0

    def __len__(self) -> int:
        return len(self._frames)

    @property
    def frames(self) -> tuple[Frame, ...]:
        """What is kept, oldest first."""
        return tuple(self._frames)

    @property
    def byte_count(self) -> int:
        return self._bytes

    def add(self, frame: Frame) -> None:
        """Keep a map; `index` rises from one to the next."""
        if self._frames and not self._stays(self._frames[-1]):  # it was kept for being the last alone
            self._bytes -= self._frames.pop().positions.nbytes
        self._frames.append(frame)
        self._bytes += frame.positions.nbytes
        while self._bytes > self._limit and self._stride < frame.index:
            self._stride *= 2
            self._frames = [f for f in self._frames if self._stays(f) or f is frame]
            self._bytes = sum(f.positions.nbytes for f in self._frames)

    def _stays(self, frame: Frame) -> bool:
        return frame.index % self._stride == 0 or frame.iteration in self._pinned

    def at_seconds(self, seconds: float) -> Frame:
        """The newest map that is kept and not younger than `seconds`; the first where there is none."""
        return self._frames[max(0, bisect_right(self._frames, seconds, key=lambda f: f.seconds) - 1)]

    def at_iteration(self, iteration: float) -> Frame:
        """The newest map that is kept and not beyond `iteration`; the first where there is none."""
        return self._frames[max(0, bisect_right(self._frames, iteration, key=lambda f: f.iteration) - 1)]
