"""Keys that go to one listener for a while, whoever has the focus."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QApplication


class KeyTrap(QObject):
    """Takes the keys that `wants` names from everyone else and gives them to `take`; subclasses say both."""

    def listen(self, wanted: bool) -> None:
        """Take these keys from everyone else, or leave them to them again."""
        application = QApplication.instance()
        if application is not None:
            application.removeEventFilter(self)
            if wanted:
                application.installEventFilter(self)

    def wants(self, event: QKeyEvent) -> bool:
        """Whether this key is for the listener."""
        raise NotImplementedError

    def take(self, event: QKeyEvent) -> None:
        """Do what the key stands for."""
        raise NotImplementedError

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() not in (QEvent.Type.ShortcutOverride, QEvent.Type.KeyPress) or not isinstance(event, QKeyEvent):
            return False
        if not self.wants(event):
            return False
        event.accept()  # whoever was to have it, a window or a widget, does not see it any more
        if event.type() == QEvent.Type.KeyPress:
            self.take(event)
        return True
