"""Figures of the presets, of the map in the window: made by the command line in a process of its own."""

from __future__ import annotations

import subprocess
import sys
from contextlib import suppress
from dataclasses import replace
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject
from PySide6.QtWidgets import QMenu

from workbench.app.background import Backgrounds
from workbench.app.document.saving import SaveRequest, write
from workbench.app.files.file_choice import ask_folder
from workbench.core.errors import WorkbenchError

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

MAP = "map.npz"


class FigurePresets(QObject):
    """`workbench figure PRESET` with the source and the map as they are now; one at a time."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._works = Backgrounds(self)
        self._process: subprocess.Popen[str] | None = None

    def wait(self) -> None:
        """End what is under way before the window ends."""
        process = self._process
        if process is not None:
            with suppress(OSError):
                process.kill()
        self._works.wait()

    def fill_menu(self, menu: QMenu) -> None:
        """An entry for each preset."""
        from workbench.figures.presets import PRESETS

        menu.clear()
        menu.setToolTipsVisible(True)
        for preset in PRESETS.values():
            action = menu.addAction(f"{preset.id}…")
            action.setToolTip(f"{preset.label}, as PNG, PDF and SVG")
            action.setEnabled(self._window.document.snapshot is not None)
            action.triggered.connect(partial(self._ask, preset.id))

    def _ask(self, preset: str, _: bool = False) -> None:
        ask_folder(self._window, f"Folder for {preset}.png, .pdf and .svg", partial(self.make, preset))

    def make(self, preset: str, folder: str) -> None:
        """Make the figure; the window goes on meanwhile."""
        window, document = self._window, self._window.document
        snapshot, loaded = document.snapshot, document.loaded
        if snapshot is None or loaded is None:
            return
        if len(self._works):
            window.error_bar.show_message("The figure before is still being made; ask again in a moment.")
            return
        anchors, dimension = document.anchors, snapshot.positions.shape[1]
        request = SaveRequest(
            Path(MAP), document.session, loaded, snapshot, anchors.vertices, anchors.target_array(dimension)
        )  # fmt: skip
        window.settings.folder = folder
        window.status.say(f"Making {preset}…")
        self._works.start(
            lambda: self._run(preset, folder, request),
            lambda _: window.status.say(f"Saved {preset}.png, .pdf and .svg in {folder}."),
            self._failed,
        )

    def _run(self, preset: str, folder: str, request: SaveRequest) -> None:
        """On a thread."""
        session, kind = request.session, request.loaded.kind
        with TemporaryDirectory() as scratch:
            file = Path(scratch) / MAP
            write(replace(request, path=file))
            command = [sys.executable, "-m", "workbench", "figure", preset, "--out", folder, "--quiet"]
            command += ["--mesh", session.source, "--map", kind, "--given", f"map={file}"]
            command += [f"--fix={','.join(session.fixes)}"] if session.fixes else []
            self._process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            told = self._process.communicate()[1]
            if self._process.returncode:
                lines = told.strip().splitlines() or ["The figure was not made."]
                raise WorkbenchError(lines[-1].removeprefix("workbench: "))

    def _failed(self, error: Exception) -> None:
        if isinstance(error, WorkbenchError):
            self._window.error_bar.show_message(error.sentence)
            self._window.status.say("No figure was made.")
        else:
            self._window.reporter.show_exception(error)
