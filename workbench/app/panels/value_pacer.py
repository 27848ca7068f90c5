"""Values that follow a moving slider: as fast as maps come, never faster; the newest wins."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QObject, QTimer

LEAST_PAUSE = 0.033
"""Seconds between two values."""
LONGEST_WAIT = 3.0
"""Seconds after which the next value goes out though no map has come since the last one."""


class ValuePacer(QObject):
    """Each value interrupts the solver's step: the next one waits until a map under the last one is there.

    Without that a hand that moves steadily would keep every step from its end, where steps last.
    """

    def __init__(self, send: Callable[[dict[str, Any]], None], parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._send = send
        self._waiting: dict[str, Any] | None = None
        self._sent_at = 0.0
        self._is_answered = True
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(self._send_waiting)

    @property
    def is_waiting(self) -> bool:
        """Whether there is a value that has not been sent yet."""
        return self._waiting is not None

    def offer(self, values: dict[str, Any], rests: bool) -> None:
        """`rests`: the hand is done, and the value goes out at once."""
        self._waiting = values
        if rests:
            self._send_waiting()
        else:
            self._schedule()

    def answered(self) -> None:
        """A map has come."""
        if not self._is_answered:
            self._is_answered = True
            if self.is_waiting:
                self._schedule()

    def forget(self) -> None:
        """Drop what waits."""
        self._waiting = None
        self._timer.stop()

    def _schedule(self) -> None:
        pause = LEAST_PAUSE if self._is_answered else LONGEST_WAIT
        rest = self._sent_at + pause - time.monotonic()
        if rest <= 0:
            self._send_waiting()
        elif not self._timer.isActive() or rest * 1000 < self._timer.remainingTime():
            self._timer.start(max(1, round(1000 * rest)))

    def _send_waiting(self) -> None:
        values, self._waiting = self._waiting, None
        self._timer.stop()
        if values is not None:
            self._sent_at = time.monotonic()
            self._is_answered = False
            self._send(values)
