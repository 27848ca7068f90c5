"""From Python's logging, on any thread, to the window."""

from __future__ import annotations

import logging
import traceback

from PySide6.QtCore import QObject, Qt, Signal

from workbench.app.notices.notice import Notice, level_of
from workbench.engine.log_file import hush_libraries

DETAILS = "details"
"""Name of what a record may carry beside its text: lines for whoever wants to know more."""
LONGEST = 20_000
"""Characters of one text that are kept."""


class LogBridge(QObject):
    """`told` carries a `Notice` in the GUI thread, for every record of every logger."""

    told = Signal(object)
    _arrived = Signal(object)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self._arrived.connect(self.told, Qt.ConnectionType.QueuedConnection)
        self._handler = _Handler(self._arrived)
        self._level = logging.WARNING
        self._is_installed = False

    def install(self) -> None:
        """Listen from now on, to notes as well as to warnings; of our own loggers to details, too."""
        hush_libraries()
        root = logging.getLogger()
        self._level, self._is_installed = root.level, True
        root.setLevel(min(root.level, logging.INFO))
        logging.getLogger("workbench").setLevel(logging.DEBUG)
        root.addHandler(self._handler)

    def remove(self) -> None:
        """Listen no longer."""
        if self._is_installed:
            self._is_installed = False
            logging.getLogger().removeHandler(self._handler)
            logging.getLogger().setLevel(self._level)
            logging.getLogger("workbench").setLevel(logging.NOTSET)


class _Handler(logging.Handler):
    def __init__(self, arrived: object) -> None:
        super().__init__()
        self._arrived = arrived

    def emit(self, record: logging.LogRecord) -> None:
        try:
            text = record.getMessage()
        except Exception:  # arguments that do not fit the text: a fault of the caller, who shall not fall over it
            text = str(record.msg)
        details = str(getattr(record, DETAILS, ""))
        if record.exc_info:
            details += "".join(traceback.format_exception(*record.exc_info))
        notice = Notice(level_of(record.levelno), text[:LONGEST], record.name, details[:LONGEST], record.created)
        try:
            self._arrived.emit(notice)  # type: ignore[attr-defined]
        except RuntimeError:
            pass  # the window was closed meanwhile
