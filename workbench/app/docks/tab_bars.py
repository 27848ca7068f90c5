"""The bars of tabs between docks that lie behind each other: those that the window's layout has left behind are hidden."""

from __future__ import annotations

from collections.abc import Iterator

from PySide6.QtCore import QEvent, QObject, Qt
from PySide6.QtWidgets import QApplication, QDockWidget, QMainWindow, QTabBar

from workbench.app.one_shot import one_shot

SETTLED = 300
"""Milliseconds after which docks that move stand where they will."""


class TabBars(QObject):
    """Hides the bars of a window that stand for no docks any more.

    Where docks are laid behind each other one after another, Qt makes a bar each time and leaves the earlier ones, which then
    lie over whatever is there.
    """

    def __init__(self, window: QMainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._soon = one_shot(self, 0, self.hide_strays)
        self._later = one_shot(self, SETTLED, self.hide_strays)
        window.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() == QEvent.Type.LayoutRequest:
            self._soon.start()
            self._later.start()
        return False

    def hide_strays(self) -> None:
        """Hide every bar whose docks do not lie behind each other; while a hand drags a dock, later."""
        if QApplication.mouseButtons() != Qt.MouseButton.NoButton:
            self._later.start()
            return
        for bar in self.strays():
            bar.hide()

    def strays(self) -> Iterator[QTabBar]:
        """The bars to be seen that are no group's."""
        groups = [_shown_behind(self._window, dock) for dock in self._window.findChildren(QDockWidget)]
        for bar in self._window.findChildren(QTabBar, options=Qt.FindChildOption.FindDirectChildrenOnly):
            if bar.isVisible() and sorted(bar.tabText(tab) for tab in range(bar.count())) not in groups:
                yield bar


def _shown_behind(window: QMainWindow, dock: QDockWidget) -> list[str]:
    """The titles of a dock and of those behind it, as far as they are shown; they are the words on the tabs of their bar."""
    group = [dock, *window.tabifiedDockWidgets(dock)]
    return sorted(each.windowTitle() for each in group if not each.isHidden())
