"""Rates and delays as the status bar shows them."""

from __future__ import annotations

import statistics
import time
from collections import deque


class DragMeter:
    """Milliseconds from a move of the hand to the picture that holds it."""

    def __init__(self) -> None:
        self._sent: deque[tuple[int, float]] = deque()
        self._delays: deque[float] = deque(maxlen=400)

    def sent(self, serial: int, at: float | None = None) -> None:
        """An anchor command left; `at` is the time of the mouse's event (`time.perf_counter`)."""
        self._sent.append((serial, time.perf_counter() if at is None else at))

    def drawn(self, serial: int) -> None:
        """A map that has taken up `serial` (and all before it) is on its way to the screen."""
        now = time.perf_counter()
        while self._sent and self._sent[0][0] <= serial:
            self._delays.append(1e3 * (now - self._sent.popleft()[1]))

    def forget(self) -> None:
        self._sent.clear()
        self._delays.clear()

    @property
    def recent(self) -> float | None:
        """Median of the last twenty delays in milliseconds."""
        return statistics.median(list(self._delays)[-20:]) if self._delays else None

    @property
    def delays(self) -> list[float]:
        """The last 400 delays in milliseconds."""
        return list(self._delays)


class RateMeter:
    """Iterations a second over the last second or so."""

    def __init__(self, window: float = 1.0) -> None:
        self._window = window
        self._seen: deque[tuple[float, int]] = deque()

    def take(self, count: int, at: float | None = None) -> None:
        """`count` more iterations were reported at time `at`."""
        now = time.perf_counter() if at is None else at
        self._seen.append((now, count))
        while self._seen and now - self._seen[0][0] > self._window:
            self._seen.popleft()

    def forget(self) -> None:
        self._seen.clear()

    def rate(self, at: float | None = None) -> float:
        now = time.perf_counter() if at is None else at
        total = sum(count for when, count in self._seen if now - when <= self._window)
        return total / self._window
