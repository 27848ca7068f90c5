"""One thing that was told, and how often."""

from __future__ import annotations

import logging
import time
from dataclasses import dataclass

LEVELS = {logging.DEBUG: "detail", logging.INFO: "note", logging.WARNING: "warning", logging.ERROR: "error"}
"""Levels of Python's logging -> what the list calls them."""


def level_of(number: int) -> int:
    """The level of `LEVELS` that a number of any logger belongs to."""
    return max((level for level in LEVELS if level <= number), default=logging.DEBUG)


@dataclass
class Notice:
    """`level` is one of `LEVELS`, `source` the logger's name, `at` seconds since 1970 of the newest of `count`."""

    level: int
    text: str
    source: str = ""
    details: str = ""
    at: float = 0.0
    count: int = 1

    def is_like(self, other: Notice) -> bool:
        """Whether it tells the same again."""
        return (self.level, self.text, self.source) == (other.level, other.text, other.source)

    @property
    def clock(self) -> str:
        return time.strftime("%H:%M:%S", time.localtime(self.at))

    @property
    def counted_text(self) -> str:
        return f"{self.text}  × {self.count}" if self.count > 1 else self.text

    @property
    def line(self) -> str:
        """As it is copied and saved: time, level, source, text, with the details below."""
        head = f"{self.clock}  {LEVELS[self.level]:7}  {self.source}  {self.counted_text}"
        return head if not self.details else head + "\n    " + self.details.rstrip().replace("\n", "\n    ")
