"""Finding the methods beside the window: their imports would hold up the first picture."""

from __future__ import annotations

from contextlib import suppress
from typing import Any

from PySide6.QtCore import QObject, QTimer, Signal, SignalInstance

from workbench.app.background import Background
from workbench.core.errors import WorkbenchError

PATIENCE = 1600
"""Milliseconds that the methods wait for the first map: both take the interpreter, and a map shows more than a list."""
PAUSE = 1500
"""Milliseconds from the list of methods to the work on their formulas."""


class MethodFinder(QObject):
    """`found` carries the registry; afterwards the kernel of pictures and formulas for tetrahedra are made ready."""

    found = Signal(object)
    failed = Signal(object)

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._search = Background(find_methods, self)
        self._search.finished.connect(self._take)
        self._search.failed.connect(self.failed)
        self._has_begun = False
        self._preparation: Background | None = None

    def start_after(self, first_map: SignalInstance) -> None:
        """Look for them when there is a first map, or none comes."""
        first_map.connect(self.begin)
        QTimer.singleShot(PATIENCE, self, self.begin)

    def begin(self) -> None:
        """Look for them now."""
        if not self._has_begun:
            self._has_begun = True
            QTimer.singleShot(0, self, self._search.start)

    def _take(self, registry: Any) -> None:
        self._preparation = Background(lambda: prepare_for_larger(registry), self)
        self._preparation.failed.connect(self.failed)
        QTimer.singleShot(PAUSE, self, self._preparation.start)
        self.found.emit(registry)


def find_methods() -> Any:
    """Every method that there is now."""
    from workbench.core.registry import registry

    found = registry()
    for item in found.distortions.values():
        with suppress(WorkbenchError):  # what is to be known of them when they are listed is worked out here
            item.compiled(2)
    return found


def prepare_for_larger(registry: Any) -> None:
    """What would hold up the window once when a larger mesh or a solid is opened."""
    from workbench.app.views.flat_picture import compile_pictures

    compile_pictures()
    prepare_formulas(registry)


def prepare_formulas(registry: Any) -> None:
    """Differentiate every formula for three singular values; one that was done already costs nothing."""
    for item in registry.distortions.values():
        with suppress(WorkbenchError):  # one of the plane only
            item.compiled(3)
