"""The log that outlives the window: a file of limited size, and what Python says when the process is ended by a fault."""

from __future__ import annotations

import contextlib
import faulthandler
import logging
import os
from logging.handlers import RotatingFileHandler
from pathlib import Path
from typing import TextIO

import platformdirs

LARGEST = 1_000_000
"""Bytes of a log; the newest and two older ones are kept."""
FORM = "%(asctime)s %(levelname)s %(name)s: %(message)s"
LOG, FAULT = "window.log", "fault-"
MOST_TOLD = 20_000
"""Characters of what a fault left that are told."""


CHATTY = ("fontTools", "matplotlib", "PIL", "numba")
"""Loggers of libraries whose notes are nobody's concern here."""


def hush_libraries() -> None:
    """Of libraries that tell much, only warnings are heard."""
    for name in CHATTY:
        logging.getLogger(name).setLevel(logging.WARNING)


def log_folder() -> Path:
    """Where logs are kept: the user's folder for states of programs."""
    return Path(platformdirs.user_state_path("distortion-workbench", appauthor=False)) / "log"


def log_path() -> Path:
    """The newest log."""
    return log_folder() / LOG


class _PrivateFile(RotatingFileHandler):
    """A log whose own failures (a full disc) are nobody's concern: it must never end what it tells of."""

    def handleError(self, record: logging.LogRecord) -> None:  # noqa: N802
        pass


def open_log(folder: Path | None = None) -> logging.Handler | None:
    """A handler that writes to the log; None where there is no place for it."""
    folder = folder or log_folder()
    try:
        folder.mkdir(parents=True, exist_ok=True)
        handler = _PrivateFile(folder / LOG, maxBytes=LARGEST, backupCount=2, encoding="utf-8")
    except OSError:
        return None
    handler.setFormatter(logging.Formatter(FORM))
    handler.setLevel(logging.INFO)  # sentences of the status line come and go
    return handler


class FaultWatch:
    """Where Python writes what it was doing when a fault of a library ends the process (a segmentation fault, an abort)."""

    def __init__(self, folder: Path | None = None) -> None:
        self._folder = folder or log_folder()
        self._path = self._folder / f"{FAULT}{os.getpid()}.txt"
        self._file: TextIO | None = None

    def begin(self, *, takes_left: bool = True) -> str:
        """Watch from now on; returns what processes left that ended by a fault, empty where none did.

        Without `takes_left` that is left for another one to tell.
        """
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            told = self._take_left() if takes_left else ""
            self._file = open(self._path, "w", encoding="utf-8")  # noqa: SIM115  it stays open as long as the process
        except OSError:
            return ""
        faulthandler.enable(self._file, all_threads=True)
        return told

    def end(self) -> None:
        """The process ends by itself."""
        file, self._file = self._file, None
        if file is not None:
            faulthandler.disable()
            file.close()
            with contextlib.suppress(OSError):
                self._path.unlink()

    def _take_left(self) -> str:
        told = []
        for path in sorted(self._folder.glob(f"{FAULT}*.txt")):
            number = path.stem.removeprefix(FAULT)
            if number.isdigit() and not _lives(int(number)):
                with contextlib.suppress(OSError):
                    told.append(path.read_text(encoding="utf-8", errors="replace")[:MOST_TOLD])
                    path.unlink()
        return "\n".join(text for text in told if text.strip())


def _lives(process: int) -> bool:
    if process == os.getpid():
        return False  # a number that is used anew
    if os.name == "nt":
        return False  # a file that is open cannot be removed there: then it stays
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return True
