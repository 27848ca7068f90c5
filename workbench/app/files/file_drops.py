"""Files that are dropped on a dialog: the same as choosing them there."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QEvent, QMimeData, QObject
from PySide6.QtGui import QDropEvent
from PySide6.QtWidgets import QWidget

from workbench.app.files.new_file import endings_of

DRAGS = (QEvent.Type.DragEnter, QEvent.Type.DragMove)


class FileDrops(QObject):
    """Takes files that a file dialog with these `filters` would show, wherever on `widget` they are let go."""

    def __init__(self, widget: QWidget, filters: str, take: Callable[[list[str]], object]) -> None:
        super().__init__(widget)
        self._endings = endings_of(filters)
        self._take = take
        for part in (widget, *widget.findChildren(QWidget)):  # fields of text would take the name for text
            part.installEventFilter(self)
        widget.setAcceptDrops(True)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() not in (*DRAGS, QEvent.Type.Drop) or not isinstance(event, QDropEvent):
            return False
        files = self._files(event.mimeData())
        if not files:
            return False
        event.acceptProposedAction()
        if event.type() == QEvent.Type.Drop:
            self._take(files)
        return True

    def _files(self, data: QMimeData) -> list[str]:
        files = [url.toLocalFile() for url in data.urls() if url.isLocalFile()]
        return [file for file in files if not self._endings or Path(file).suffix.lower() in self._endings]
