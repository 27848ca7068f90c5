"""A mesh that sessions can name, and patience with what is written."""

from __future__ import annotations

from pathlib import Path

from pytestqt.qtbot import QtBot

from workbench.app.main_window import MainWindow


def mesh_file(folder: Path) -> Path:
    """A file that the fake engine takes for its grid."""
    path = folder / "grid.obj"
    path.write_text("v 0 0 0\n")
    return path


def wait_for_desk(window: MainWindow, qtbot: QtBot) -> None:
    qtbot.waitUntil(lambda: not window.sessions.desk.is_busy)
