"""Playing the time line as it was, quicker or slower."""

from __future__ import annotations

import time

from PySide6.QtCore import QObject, QTimer, Signal

from workbench.app.timeline.looking_back import LookingBack
from workbench.session.moments import MomentRecord

BEAT = 30
"""Milliseconds between two pictures at least."""
LONGEST_BEAT = 0.2
"""Seconds that one beat stands for at most: a window that was held up does not leap."""


class Player(QObject):
    """Moves what is shown on with the clock; `changed` tells that it plays, or has stopped."""

    changed = Signal()

    def __init__(self, record: MomentRecord, looking: LookingBack) -> None:
        super().__init__(looking)
        self._record, self._looking = record, looking
        self.speed = 1.0
        self._place = self._last = 0.0
        self._timer = QTimer(self)
        self._timer.setInterval(BEAT)
        self._timer.timeout.connect(self._beat)

    @property
    def is_playing(self) -> bool:
        return self._timer.isActive()

    def toggle(self) -> None:
        """Play on from what is shown, from the beginning where that is the newest map; or pause."""
        if self.is_playing:
            self.stop()
        elif len(self._record) > 1:
            self._place = 0.0 if self._looking.is_live else self._record[self._looking.index].time
            self._last = time.perf_counter()
            self._looking.show(self._record.at(self._place))
            self._timer.start()
            self.changed.emit()

    def stop(self) -> None:
        if self.is_playing:
            self._timer.stop()
            self.changed.emit()

    def _beat(self) -> None:
        now = time.perf_counter()
        self._place += self.speed * min(now - self._last, LONGEST_BEAT)
        self._last = now
        if self._looking.is_live or not len(self._record):
            self.stop()
        elif self._place >= self._record.end:
            self.stop()
            self._looking.go_live()
        else:
            self._looking.show(self._record.at(self._place))
