"""What loggers say in the engine process, kept until it is sent to the window."""

from __future__ import annotations

import logging
import traceback
from collections import deque

from workbench.engine.log_file import hush_libraries
from workbench.engine.messages import LogLine

MOST = 200
"""Lines that wait; of more the newest stay: a plugin that logs at each step fills no memory."""
LONGEST = 5_000
"""Characters of one text."""


class LogLines(logging.Handler):
    """Takes records of every logger, on any thread; warnings of Python's are among them."""

    def __init__(self) -> None:
        super().__init__(logging.INFO)
        self._lines: deque[LogLine] = deque(maxlen=MOST)
        hush_libraries()
        root = logging.getLogger()
        root.setLevel(logging.INFO)
        root.addHandler(self)
        logging.captureWarnings(True)

    def emit(self, record: logging.LogRecord) -> None:
        try:
            text = record.getMessage()
        except Exception:  # arguments that do not fit the text
            text = str(record.msg)
        details = "".join(traceback.format_exception(*record.exc_info)) if record.exc_info else ""
        self._lines.append(LogLine(record.levelno, record.name, text[:LONGEST], details[:LONGEST]))

    def take(self) -> list[LogLine]:
        """Those that wait, oldest first; they wait no longer."""
        taken = []
        while self._lines:
            taken.append(self._lines.popleft())
        return taken
