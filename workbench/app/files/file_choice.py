"""Asking for files and folders that are there; the next question begins where the last one ended."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QFileDialog, QWidget

from workbench.app.settings import Settings

Mode = QFileDialog.FileMode
ENDINGS = "*.obj *.off *.ply *.stl *.mesh *.meshb *.msh *.vtk *.vtu *.npz *.mat"
MESH_FILTERS = f"Meshes and cases ({ENDINGS});;All files (*)"
MAP_FILTERS = f"Maps of this mesh ({ENDINGS});;All files (*)"


def ask_file(
    parent: QWidget,
    title: str,
    filters: str,
    take: Callable[[str], object],
    *,
    place: str = "",
    leave: Callable[[], object] | None = None,
) -> None:
    """Open a file dialog without stopping the event loop; `take` gets the path of the file.

    It begins in the folder `place`, or else where the window of `parent` was used last; `leave` is called where nothing is
    chosen.
    """
    dialog = _dialog(parent, title, filters, Mode.ExistingFile, place)
    dialog.fileSelected.connect(take)
    if leave is not None:
        dialog.rejected.connect(leave)
    dialog.open()


def ask_files(parent: QWidget, title: str, filters: str, take: Callable[[list[str]], object]) -> None:
    """The same for several files at once."""
    dialog = _dialog(parent, title, filters, Mode.ExistingFiles)
    dialog.filesSelected.connect(take)
    dialog.open()


def ask_folder(parent: QWidget, title: str, take: Callable[[str], object]) -> None:
    """The same for a folder, in which files will be written."""
    dialog = _dialog(parent, title, "", Mode.Directory)
    dialog.setOption(QFileDialog.Option.ShowDirsOnly)
    dialog.fileSelected.connect(take)
    dialog.open()


def last_folder(parent: QWidget) -> str:
    """The folder that the window of a widget was used with last; empty where there is none, or it has gone."""
    settings = _settings_of(parent)
    return settings.folder if settings is not None and Path(settings.folder).is_dir() else ""


def remember_folder(parent: QWidget, path: str) -> None:
    """That of a file, or the folder itself, is where the next question begins."""
    settings, chosen = _settings_of(parent), Path(path)
    if settings is not None:
        settings.folder = str(chosen if chosen.is_dir() else chosen.parent)


def _dialog(parent: QWidget, title: str, filters: str, mode: Mode, place: str = "") -> QFileDialog:
    dialog = QFileDialog(parent, title, place or last_folder(parent), filters)
    dialog.setFileMode(mode)
    dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
    dialog.filesSelected.connect(lambda paths: remember_folder(parent, paths[0]) if paths else None)
    return dialog


def _settings_of(widget: QWidget | None) -> Settings | None:
    """Those of the main window to which a widget belongs, directly or through windows of its own."""
    while widget is not None:
        settings = getattr(widget, "settings", None)
        if isinstance(settings, Settings):
            return settings
        widget = widget.parentWidget()
    return None
