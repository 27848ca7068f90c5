"""The last good state, kept every few seconds, and offered at the next start where the window did not end by itself."""

from __future__ import annotations

import os
import secrets
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from platformdirs import user_data_path
from PySide6.QtCore import QLockFile, QObject, Qt, QTimer
from PySide6.QtWidgets import QMessageBox

from workbench.app.sessions.session_desk import Found
from workbench.app.status.reporter import source_name
from workbench.core.errors import WorkbenchError
from workbench.engine.session_file import ENDING, read_session, source_trouble

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

INTERVAL = 4000
"""Milliseconds between two looks at whether there is something to keep: at most ten seconds are lost."""
LAST = "last" + ENDING
"""Name of what was not saved when the window was closed."""


@dataclass(frozen=True)
class Left:
    """What a window left behind that did not end by itself."""

    path: Path
    lock: QLockFile

    def discard(self) -> None:
        """Forget it."""
        self.path.unlink(missing_ok=True)
        self.lock.unlock()


def recovery_folder() -> Path:
    """Where states are kept."""
    return user_data_path("distortion-workbench", appauthor=False) / "recovery"


class Autosave(QObject):
    """Writes to a file of its own, beside a lock that ends with the process: so the next start knows that it was left."""

    def __init__(self, window: MainWindow, folder: Path | None = None) -> None:
        super().__init__(window)
        self._window = window
        self._desk = window.sessions.desk
        self._folder = folder or recovery_folder()
        self._lock: QLockFile | None = None
        self.path = self._folder / f"{int(time.time())}-{secrets.token_hex(4)}{ENDING}"
        self._kept: tuple[object, ...] = ()
        self._offered: list[Left] = []
        self._is_wanted = True
        self._timer = QTimer(self)
        self._timer.setInterval(INTERVAL)
        self._timer.timeout.connect(self.keep)
        self._timer.timeout.connect(self._keep_looks)
        self._looks: dict[str, object] = {}
        window.document.changing.connect(self._keep_before_opening)

    def start(self) -> None:
        """Keep states from now on, and offer what was left behind."""
        with suppress(OSError):
            self._folder.mkdir(parents=True, exist_ok=True)
            self.offer()
            self._lock = _locked(self.path)
        if self._lock is None:
            self._window.error_bar.show_message(
                f"Work is not kept against a crash: the folder {self._folder} cannot be written. Save often."
            )
        elif self._is_wanted:
            self._timer.start()

    def set_interval(self, seconds: int) -> None:
        """Look every so many seconds whether there is something to keep; 0: never."""
        self._is_wanted = seconds > 0
        self._timer.setInterval(1000 * seconds if seconds else INTERVAL)
        if not self._is_wanted:
            self._timer.stop()
        elif self._lock is not None:
            self._timer.start()

    def keep(self) -> None:
        """Write the state as it is now, if it is another one and there is something that could be lost."""
        document, desk = self._window.document, self._desk
        if not desk.is_modified or not desk.has_something or desk.is_busy or document.snapshot is None:
            return
        now = (document.session, document.anchors, document.snapshot.number, document.generation)
        if now != self._kept:
            self._kept = now
            desk.save(str(self.path), is_copy=True)

    def _keep_looks(self) -> None:
        """Where panels lie and what views show is for the next start, however this window ends."""
        window = self._window
        window.layouts.keep_if_changed()
        looks = window.view_memory.state()
        if looks != self._looks:
            self._looks = looks
            window.settings.save_views(looks)

    def _keep_before_opening(self, name: str, key: str) -> None:
        """What was not saved gives way to another mesh: undo leads back to it, and so does the last session."""
        if self._lock is not None and name.startswith("Open") and self._desk.is_modified and self._desk.has_something:
            self._desk.save(str(self._folder / LAST), is_copy=True)

    def end(self) -> None:
        """The window ends by itself: nothing was lost. What has no file is kept as the last session."""
        self._timer.stop()
        desk = self._desk
        desk.wait()
        if self._lock is None:
            return
        with suppress(OSError, WorkbenchError):
            if desk.is_modified and not desk.path and desk.has_something:
                self.keep_last()
            Left(self.path, self._lock).discard()
        for left in self._offered:
            left.lock.unlock()

    def keep_last(self) -> None:
        """Write the session of this window as the last one."""
        from workbench.engine.session_file import write_session

        write_session(self._folder / LAST, self._desk.record())

    @property
    def last(self) -> Path | None:
        """What was not saved when a window was closed last; None where there is nothing."""
        path = self._folder / LAST
        return path if path.is_file() else None

    # ------------------------------------------------------------------------------------------ recovery

    def offer(self) -> None:
        """Ask what is to be done with the newest state that a window left behind; older ones stay for the next starts."""
        for path in sorted(self._folder.glob(f"[!.]*-*{ENDING}"), reverse=True):  # a dot begins what was not written to its end
            lock = _locked(path)
            if lock is None:
                continue
            for torn in self._folder.glob(f".{path.stem}*"):
                torn.unlink(missing_ok=True)
            if self._ask(Left(path, lock)):
                return

    def _ask(self, left: Left) -> bool:
        """Whether there was something to ask about."""
        try:
            record = read_session(left.path)
            count = len(record.session.anchor_vertices)
            words = f"{source_name(record.session.source)}, {count} anchor{'s' * (count != 1)}"
        except WorkbenchError:
            left.discard()
            return False
        self._offered.append(left)
        found = Found(str(left.path), record, source_trouble(record), keeps_path=False)
        box = QMessageBox(self._window)
        box.setObjectName("recovery")
        box.setIcon(QMessageBox.Icon.Question)
        box.setWindowTitle("Work that was not saved")
        at = time.localtime(left.path.stat().st_mtime)
        is_today = at[:3] == time.localtime()[:3]
        when = time.strftime("today at %H:%M:%S" if is_today else "%d %B at %H:%M:%S", at)
        box.setText("The window did not end by itself last time.")
        left_of_it = f"{words},\nas of {when}.".replace(" ", "\u00a0")  # a line each
        box.setInformativeText(f"This is left of it:\n{left_of_it}")
        recover = box.addButton("Recover", QMessageBox.ButtonRole.AcceptRole)
        discard = box.addButton("Discard", QMessageBox.ButtonRole.DestructiveRole)
        ignore = box.addButton("Not now", QMessageBox.ButtonRole.RejectRole)
        box.setDefaultButton(recover)
        box.setEscapeButton(ignore)
        recover.clicked.connect(lambda: self._recover(left, found))
        discard.clicked.connect(left.discard)
        box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        box.open()
        return True

    def _recover(self, left: Left, found: Found) -> None:
        """Go to it; until this window has kept a state of its own, that one is its own."""
        if found.trouble:
            self._desk.mesh_wanted.emit(found)
            return
        self._desk.open(found)
        if self._lock is None:
            left.discard()
            return
        with suppress(OSError):
            os.replace(left.path, self.path)
        left.lock.unlock()


def _locked(path: Path) -> QLockFile | None:
    """The lock beside a state; None while the window that it belongs to lives."""
    lock = QLockFile(str(path.with_suffix(".lock")))
    lock.setStaleLockTime(0)
    return lock if lock.tryLock(0) else None
