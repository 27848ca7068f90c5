"""The window's part of a verdict: opening its list, and bringing a place that was chosen in it before the eye."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject

from workbench.app.verdict.verdict_window import VerdictWindow
from workbench.core.arrays import Integers

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

ORIGIN = "verdict"
"""Name under which places are brushed."""
AROUND = 5.0
"""How much more than a place is shown of what is round it."""


class Judging(QObject):
    """One list at a time; places are marked in every view, and zoomed to in the two large ones."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self.list: VerdictWindow | None = None

    def ask(self) -> None:
        """Judge the present map, in a list of its own window."""
        if self._window.document.mesh is None:
            return
        if self.list is None:
            self.list = VerdictWindow(self._window.document, self._window)
            self.list.shown.connect(self._show)
            self.list.alone_wanted.connect(lambda alone: self._window.volume.choose(only_marked=alone))
            self.list.destroyed.connect(self._closed)
            self.list.show()
        self.list.raise_()
        self.list.ask()

    def walk(self, step: int) -> None:
        """To the next place that is to blame, or the one before."""
        if self.list is None:
            self.ask()
        else:
            self.list.walk(step)

    def close(self) -> None:
        if self.list is not None:
            self.list.close()

    def _closed(self, _: Any = None) -> None:
        self.list = None

    def _show(self, vertices: Integers, simplices: Integers) -> None:
        self._window.brush.brush(simplices, ORIGIN)
        for pane in (self._window.source, self._window.target):
            pane.view.look_at(vertices, AROUND)
