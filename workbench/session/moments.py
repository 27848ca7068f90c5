"""The maps of the last minutes, thinned out where they would take too much memory."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from workbench.core.arrays import Booleans, Floats

LIMIT = 256 * 2**20
"""Bytes of maps that are kept where nothing else is said."""
EXACT = 16
"""Newest maps that are kept to the last bit."""
LONGEST_GAP = 0.5
"""Seconds between two moments at most: where nothing moved for longer, the time line does not stretch."""
FREED = 0.1
"""Part of the limit that is freed at once."""
FRESH = 5.0
"""Seconds, added to the age of a moment, over which moments lie as close as they came."""
MOST = 20_000
"""Moments at most, however small they are."""


@dataclass(eq=False)
class Moment:
    """A map and what was known of it.

    Parameters
    ----------
    time : float               seconds of motion since the record began
    iteration : int            since the last start
    energy : float             of what was minimised then
    inverted_count : int
    solver, distortion : str   that led there
    belongings : object        what else stands beside the map, such as its anchors; never changed
    notes : list of str        what the user did next; a moment with notes is kept exactly, and is the last to go
    """

    time: float
    positions_kept: np.ndarray
    inverted_kept: bytes
    simplex_count: int
    iteration: int
    energy: float
    inverted_count: int
    solver: str = ""
    distortion: str = ""
    belongings: object = None
    notes: list[str] = field(default_factory=list)

    @property
    def positions(self) -> Floats:
        """(n, d) float64"""
        return self.positions_kept.astype(np.float64, copy=False)

    @property
    def inverted(self) -> Booleans:
        """(m,) bool: as they were before any rounding"""
        if not self.inverted_kept:
            return np.zeros(self.simplex_count, dtype=bool)
        return np.unpackbits(np.frombuffer(self.inverted_kept, np.uint8), count=self.simplex_count).astype(bool)

    @property
    def is_exact(self) -> bool:
        return self.positions_kept.dtype == np.float64

    @property
    def byte_count(self) -> int:
        return self.positions_kept.nbytes + len(self.inverted_kept)

    def round(self) -> None:
        """Keep single precision only: enough to be looked at, for half of the memory."""
        self.positions_kept = self.positions_kept.astype(np.float32)


class MomentRecord(Sequence[Moment]):
    """Moments of one mesh in the order of time, within `limit` bytes.

    The newest are kept to the last bit, and those with notes; the others in single precision. Beyond the limit those go whose
    neighbours are nearest in proportion to their age: the last seconds stay as dense as they came, an hour ago there is one
    every some seconds, and no stretch of time is forgotten before the others. When nothing else is left to go, notes do not
    help either: first their maps are rounded, then they are thinned out like the others. First and last moment stay.
    """

    def __init__(self, limit: int = LIMIT) -> None:
        self.limit = limit
        self._moments: list[Moment] = []
        self._times: list[float] = []
        self._clock = 0.0
        self._bytes = 0

    def __len__(self) -> int:
        return len(self._moments)

    def __getitem__(self, index):  # type: ignore[no-untyped-def]
        return self._moments[index]

    def __iter__(self) -> Iterator[Moment]:
        return iter(self._moments)

    @property
    def byte_count(self) -> int:
        return self._bytes

    @property
    def end(self) -> float:
        """Time of the newest moment."""
        return self._times[-1] if self._times else 0.0

    @property
    def times(self) -> Sequence[float]:
        """Of all moments, ascending."""
        return self._times

    def clear(self) -> None:
        """Another mesh."""
        self._moments.clear()
        self._times.clear()
        self._clock = 0.0
        self._bytes = 0

    # ------------------------------------------------------------------------------------------ growing

    def add(
        self,
        positions: Floats,
        inverted: Booleans,
        now: float,
        *,
        iteration: int = 0,
        energy: float = float("nan"),
        solver: str = "",
        distortion: str = "",
        belongings: object = None,
    ) -> Moment:
        """Keep a map (n, d) as it is at `now`, seconds of any clock. The array is not copied: nobody may write to it."""
        time = self.end + min(max(now - self._clock, 1e-6), LONGEST_GAP) if self._moments else 0.0
        self._clock = now
        count = int(np.count_nonzero(inverted))
        bits = np.packbits(inverted).tobytes() if count else b""
        moment = Moment(
            time, positions, bits, len(inverted), iteration, energy, count, solver, distortion, belongings
        )  # fmt: skip
        self._moments.append(moment)
        self._times.append(time)
        self._bytes += moment.byte_count
        if len(self._moments) > EXACT:
            self._round(self._moments[-1 - EXACT], even_noted=False)
        if self._bytes > self.limit or len(self._moments) > MOST:
            self.thin()
        return moment

    def note(self, text: str) -> Moment | None:
        """Say what the user does at the newest moment, which is kept exactly for that."""
        if self._moments:
            self._moments[-1].notes.append(text)
            return self._moments[-1]
        return None

    def _round(self, moment: Moment, *, even_noted: bool) -> None:
        if moment.is_exact and (even_noted or not moment.notes):
            before = moment.byte_count
            moment.round()
            self._bytes += moment.byte_count - before

    def set_limit(self, limit: int) -> None:
        """Keep within another number of bytes."""
        self.limit = limit
        self.thin()

    # ------------------------------------------------------------------------------------------ thinning

    def thin(self) -> None:
        """Let moments go until a tenth of the limit is free."""
        wanted, most = (1.0 - FREED) * self.limit, round((1.0 - FREED) * MOST)
        for even_noted in (False, True):
            if even_noted:
                for moment in self._moments[1:-1]:
                    if self._bytes <= wanted:
                        break
                    self._round(moment, even_noted=True)
            while (self._bytes > wanted or len(self._moments) > most) and self._drop_some(wanted, most, even_noted):
                pass

    def _drop_some(self, wanted: float, most: int, even_noted: bool) -> bool:
        """Let the closest go, no two neighbours at once; whether any could."""
        times = np.array(self._times)
        if len(times) < 3:
            return False
        closeness = (times[2:] - times[:-2]) / (times[-1] - times[1:-1] + FRESH)
        gone: set[int] = set()
        for place in (np.argsort(closeness, kind="stable") + 1).tolist():
            if self._bytes <= wanted and len(times) - len(gone) <= most:
                break
            moment = self._moments[place]
            if place - 1 in gone or place + 1 in gone or (moment.notes and not even_noted):
                continue
            gone.add(place)
            self._bytes -= moment.byte_count
        if gone:
            kept = [place for place in range(len(times)) if place not in gone]
            self._moments = [self._moments[place] for place in kept]
            self._times = [self._times[place] for place in kept]
        return bool(gone)

    # ------------------------------------------------------------------------------------------ finding

    def at(self, time: float) -> int:
        """Index of the moment nearest to a time. Raises `IndexError` where there is none."""
        if not self._moments:
            raise IndexError("no moments")
        after = min(bisect_left(self._times, time), len(self._times) - 1)
        if after > 0 and time - self._times[after - 1] <= self._times[after] - time:
            return after - 1
        return after

    def index_of(self, moment: Moment) -> int:
        """Where a moment stands now; the nearest in time, if it was thinned out."""
        return self.at(moment.time)
