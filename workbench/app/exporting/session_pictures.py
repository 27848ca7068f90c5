"""Pictures of the window that carry the session they show."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QBuffer, QIODevice
from PySide6.QtGui import QImage

from workbench.core.errors import WorkbenchError
from workbench.engine.session_file import PICTURE

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

Binder = Callable[[bytes], bytes]


def session_binder(window: MainWindow, path: str | Path) -> Binder:
    """What puts the session of this moment into a PNG for `path`, on any thread; other formats stay as they are.

    So does everything where the preferences say so, or where nothing is open.
    """
    desk = window.sessions.desk
    if Path(path).suffix.lower() != PICTURE or not window.preferring.preferences["carry_session"] or not desk.has_something:
        return lambda picture: picture
    return desk.binder(path)


def png_of(image: QImage) -> bytes:
    """The bytes of a PNG. Raises `WorkbenchError` where the picture is empty."""
    buffer = QBuffer()
    buffer.open(QIODevice.OpenModeFlag.WriteOnly)
    if not image.save(buffer, "PNG"):
        raise WorkbenchError("There is nothing to make a picture of; open a mesh, and a view of it, first.")
    return bytes(buffer.data().data())
