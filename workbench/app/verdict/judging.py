"""The window's part of a verdict: opening its list, and bringing a place that was chosen in it before the eye."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import QObject

from workbench.core.arrays import Integers

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow
    from workbench.app.verdict.verdict_window import VerdictWindow

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
            from workbench.app.verdict.verdict_window import VerdictWindow

            self.list = VerdictWindow(self._window.document, self._window)
            self.list.shown.connect(self._show)
            self.list.alone_wanted.connect(lambda alone: self._window.volume.choose(only_marked=alone))
            self.list.destroyed.connect(self._closed)
            self.list.show()
        self.list.raise_()
        self.list.ask()

    def walk(self, step: int) -> None:
        """To the next place of the list, or the one before; without a list to the next inverted simplex.

        Where none is inverted the map is judged: there may be other places.
        """
        if self.list is not None:
            self.list.walk(step)
        elif not self._walk_inverted(step):
            self.ask()

    def _walk_inverted(self, step: int) -> bool:
        document, brush = self._window.document, self._window.brush
        inverted = np.empty(0, np.int64) if document.shown is None else np.flatnonzero(document.shown.inverted)
        if not len(inverted) or document.mesh is None:
            return False
        last = int(brush.simplices[0]) if brush.origin == ORIGIN else -1
        place = int(np.searchsorted(inverted, last, side="right" if step > 0 else "left")) - (step < 0)
        simplex = int(inverted[place % len(inverted)])
        show_place(self._window, simplex, ORIGIN)
        number = f"{place % len(inverted) + 1:,} of {len(inverted):,}"
        self._window.status.say(f"Inverted {document.mesh.simplex_noun()} {simplex}, {number}; Ctrl+J tells more of the map.")
        return True

    def close(self) -> None:
        if self.list is not None:
            self.list.close()

    def _closed(self, _: Any = None) -> None:
        self.list = None

    def _show(self, vertices: Integers, simplices: Integers) -> None:
        show_places(self._window, vertices, simplices, ORIGIN)


def show_places(window: MainWindow, vertices: Integers, simplices: Integers, origin: str) -> None:
    """Mark simplices (k,) everywhere, and bring vertices (v,) before the eye in source and target."""
    window.brush.brush(simplices, origin)
    for pane in (window.source, window.target):
        pane.view.look_at(vertices, AROUND)


def show_place(window: MainWindow, simplex: int, origin: str) -> None:
    """Mark one simplex and bring it before the eye."""
    assert window.document.mesh is not None
    show_places(window, window.document.mesh.simplices[simplex], np.array([simplex]), origin)
