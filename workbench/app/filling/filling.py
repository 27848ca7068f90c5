"""Filling a surface: from the dialog to a file on a thread, and from the file to the new document."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt, Signal

from workbench.app.background import Background
from workbench.app.filling.fill_dialog import FillDialog
from workbench.app.filling.fill_work import FillRequest, fill_into
from workbench.core.errors import WorkbenchError

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow


class Filling(QObject):
    """One dialog and one filling at a time; the mesher works in a process that ends with the window."""

    _told = Signal(str)

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._work: Background | None = None
        self._stop = threading.Event()
        self.dialog: FillDialog | None = None
        self._told.connect(self._show_progress, Qt.ConnectionType.QueuedConnection)

    def ask(self) -> None:
        """Open the dialog, with the surface that was opened last where there is one."""
        if self.dialog is not None:
            self.dialog.raise_()
            return
        dialog = FillDialog(self._surface(), self._window.settings.folder, self._window)
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.fill_wanted.connect(self._fill)
        dialog.cancelled.connect(self._stop.set)
        dialog.closed.connect(self._forget_dialog)
        self.dialog = dialog
        dialog.open()

    def _surface(self) -> str:
        document = self._window.document
        source = document.asked_source
        is_solid = document.loaded is not None and document.loaded.kind != "parameterize" and source == document.session.source
        return "" if is_solid else source

    def _forget_dialog(self) -> None:
        self.dialog = None

    def wait(self) -> None:
        """End the mesher, and let the thread end before the window does."""
        self._stop.set()
        if self._work is not None:
            self._work.wait()

    def _fill(self, request: FillRequest) -> None:
        if self._work is not None:
            return
        window, generation = self._window, self._window.document.generation
        window.settings.folder = str(Path(request.path).parent)
        self._stop.clear()
        work = Background(lambda: fill_into(request, self._stop.is_set, self._told.emit), self)

        def done(sentence: str) -> None:
            self._end()
            if self.dialog is not None:
                self.dialog.is_busy = False
                self.dialog.close()
            window.status.say(sentence)
            if window.document.generation == generation:
                window.open(str(request.path))

        def fail(error: Exception) -> None:
            self._end()
            if self.dialog is None:
                return
            is_ours = isinstance(error, WorkbenchError)
            self.dialog.show_error(error.sentence if is_ours else f"{type(error).__name__}: {error}")

        work.finished.connect(done)
        work.failed.connect(fail)
        self._work = work
        work.start()

    def _end(self) -> None:
        assert self._work is not None
        self._work.deleteLater()
        self._work = None

    def _show_progress(self, sentence: str) -> None:
        if self.dialog is not None:
            self.dialog.show_progress(sentence)
