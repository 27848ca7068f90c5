"""The list of what was done: a click goes back or forth to it."""

from __future__ import annotations

from PySide6.QtCore import Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QDockWidget, QLabel, QListWidget, QListWidgetItem, QWidget

from workbench.app.actions import TITLE
from workbench.app.docks.dock_title import DockTitle
from workbench.app.sessions.undoing import Undoing

BEGINNING = "As it was opened"


class UndoDock(QDockWidget):
    """Steps from the oldest to the newest; those that are undone are pale. The words of Undo and Redo are kept here, too."""

    def __init__(self, undoing: Undoing, undo: QAction, redo: QAction, parent: QWidget | None = None) -> None:
        super().__init__("Steps", parent)
        self.setObjectName("steps")
        self.setTitleBarWidget(DockTitle(self, QLabel("Steps", self)))
        self._undoing = undoing
        self._undo, self._redo = undo, redo
        self.list = QListWidget(self)
        self.list.setFrameShape(QListWidget.Shape.NoFrame)
        self.list.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setWidget(self.list)
        self.list.itemClicked.connect(lambda item: undoing.go_to(self.list.row(item)))
        self._shown: tuple[tuple[str, ...], int] = ((), -1)
        undoing.changed.connect(self.show_steps)
        self.show_steps()

    def show_steps(self) -> None:
        """Bring the list, and the texts of Undo and Redo, in line with the history."""
        history = self._undoing.history
        shown = (history.names, history.done)
        if shown == self._shown:
            return
        self._shown = shown
        self.list.clear()
        for place, name in enumerate((BEGINNING, *history.names)):
            item = QListWidgetItem(name, self.list)
            item.setToolTip(name)
            if place > history.done:
                item.setForeground(self.palette().placeholderText())
        self.list.setCurrentRow(history.done)
        for action, verb, name in ((self._undo, "Undo", history.undo_name), (self._redo, "Redo", history.redo_name)):
            action.setProperty(TITLE, verb)
            action.setText(f"{verb} {_begun_small(name)}" if name else verb)
            action.setEnabled(bool(name))


def _begun_small(name: str) -> str:
    """As it stands after a verb: names that are all capitals, such as ARAP, stay so."""
    short = name if len(name) <= 40 else name[:39] + "…"
    return short if short[:2].isupper() else short[:1].lower() + short[1:]
