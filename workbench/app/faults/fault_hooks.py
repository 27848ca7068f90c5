"""Where Python and Qt turn when nobody caught an exception."""

from __future__ import annotations

import logging
import sys
import threading
from collections.abc import Callable
from typing import Any

from PySide6.QtCore import QMessageLogContext, QObject, Qt, QtMsgType, Signal, qInstallMessageHandler

logger = logging.getLogger("workbench.fault")
LEVELS = {
    QtMsgType.QtDebugMsg: logging.DEBUG,
    QtMsgType.QtInfoMsg: logging.INFO,
    QtMsgType.QtWarningMsg: logging.WARNING,
    QtMsgType.QtCriticalMsg: logging.ERROR,
    QtMsgType.QtFatalMsg: logging.CRITICAL,
}


class FaultHooks(QObject):
    """While installed: `raised` carries an exception and the name of its thread (empty: the window's), in the GUI thread.

    It is logged first, so that it is in the file even where the window cannot show it any more.
    """

    raised = Signal(object, str)
    _arrived = Signal(object, str)

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        # queued: a fault while something is painted must not open a dialog in the middle of it
        self._arrived.connect(self.raised, Qt.ConnectionType.QueuedConnection)
        self._restore: list[Callable[[], Any]] = []

    def install(self, *, with_qt: bool = True) -> None:
        """Take over; `remove` gives back what was there. `with_qt`: Qt's own messages go to the log, too."""
        excepthook, thread_hook = sys.excepthook, threading.excepthook
        self._restore = [
            lambda: setattr(sys, "excepthook", excepthook),
            lambda: setattr(threading, "excepthook", thread_hook),
        ]
        sys.excepthook = lambda kind, error, trace: self._take(error, "")
        threading.excepthook = lambda fault: self._take(fault.exc_value, fault.thread.name if fault.thread else "unknown")
        if with_qt:
            before = qInstallMessageHandler(tell_message)
            self._restore.append(lambda: qInstallMessageHandler(before))

    def remove(self) -> None:
        """Give back what was there."""
        for restore in self._restore:
            restore()
        self._restore = []

    def _take(self, error: BaseException | None, where: str) -> None:
        if error is None or isinstance(error, SystemExit):
            return
        sys.__excepthook__(type(error), error, error.__traceback__)  # for whoever started it in a terminal
        if isinstance(error, KeyboardInterrupt):
            return
        logger.error("%s: %s", type(error).__name__, error, exc_info=error)
        try:
            self._arrived.emit(error, where)
        except RuntimeError:
            pass  # the window is gone


def tell_message(kind: QtMsgType, context: QMessageLogContext, text: str) -> None:
    """Log what Qt says; after a fatal message it ends the process, and the file has it."""
    logging.getLogger(f"qt.{context.category or 'default'}").log(LEVELS.get(kind, logging.WARNING), "%s", text)
