"""What the window can be used without at first is made when the first map is there, a piece at a time."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterator

from PySide6 import QtCore, QtGui, QtWidgets
from PySide6.QtCore import QObject, QTimer, Signal, SignalInstance

PATIENCE = 3000
"""Milliseconds that the parts wait for the first map."""
FIRST = 120
"""Milliseconds from the first map to the first piece: the map is to be seen before."""
BETWEEN = 4
"""Milliseconds from one piece to the next, for the mouse and for what is to be drawn."""
TYPES = 40
"""Of Qt, in a piece."""
BESIDES = ("PySide6.QtSvg", "PySide6.QtTest", "PySide6.QtOpenGLWidgets", "xml.etree.ElementTree", "pydoc", "pyqtgraph")
"""What plots need: first what pyqtgraph imports, so that its own turn is short."""


class LateParts(QObject):
    """Makes `parts`, each a call, in their order, what they need imported before; `finished` tells that all are there."""

    finished = Signal()

    def __init__(self, parts: tuple[Callable[[], object], ...], parent: QObject) -> None:
        super().__init__(parent)
        self._pieces = self._all_pieces(parts)
        self._has_begun = False
        self._timer = QTimer(self)
        self._timer.setInterval(BETWEEN)
        self._timer.timeout.connect(self._go_on)

    def start_after(self, first_map: SignalInstance) -> None:
        """Begin when there is a first map, or none comes."""
        first_map.connect(self._begin)
        QTimer.singleShot(PATIENCE, self, self._begin)

    def finish(self) -> None:
        """Make all that is left now."""
        self._has_begun = True
        for _ in self._pieces:
            pass

    def stop(self) -> None:
        """The window ends."""
        self._pieces = iter(())
        self._timer.stop()

    def _begin(self) -> None:
        if not self._has_begun:
            self._has_begun = True
            QTimer.singleShot(FIRST, self._timer, self._timer.start)

    def _go_on(self) -> None:
        if next(self._pieces, None) is None:
            self._timer.stop()

    def _all_pieces(self, parts: tuple[Callable[[], object], ...]) -> Iterator[bool]:
        """Each step does a little."""
        # pyqtgraph touches every class of Qt when it is imported, and each is made when it is first touched
        for module in (QtCore, QtGui, QtWidgets):
            names = dir(module)
            for first in range(0, len(names), TYPES):
                for name in names[first : first + TYPES]:
                    getattr(module, name)
                yield True
        for name in BESIDES:
            importlib.import_module(name)
            yield True
        for make in parts:
            make()
            yield True
        self.finished.emit()
