"""What the pages of the inspector have in common: they work only while they are to be seen."""

from __future__ import annotations

from PySide6.QtGui import QShowEvent
from PySide6.QtWidgets import QWidget

from workbench.app.appearance.theme import LIGHT, Theme
from workbench.app.inspector.subject import Subject


class Page(QWidget):
    """A page about the subject; `refresh` is called when it changed, at once or when the page is shown next."""

    def __init__(self, subject: Subject, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.subject = subject
        self.theme: Theme = LIGHT
        self._is_stale = True
        subject.changed.connect(self.touch)

    def refresh(self) -> None:
        """Bring the page in line with the subject."""
        raise NotImplementedError

    def wait(self) -> None:
        """Let threads end before the window does."""

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self.touch()

    def touch(self) -> None:
        """Something that the page shows changed."""
        self._is_stale = True
        if self.isVisible():
            self._refresh()

    def showEvent(self, event: QShowEvent) -> None:
        super().showEvent(event)
        if self._is_stale:
            self._refresh()

    def _refresh(self) -> None:
        self._is_stale = False
        self.refresh()
