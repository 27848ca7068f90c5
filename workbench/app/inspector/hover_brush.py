"""The simplex under the pointer in a view is marked everywhere, while the inspector shows the simplices as points."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import QObject, Qt, QTimer
from PySide6.QtGui import QMouseEvent

from workbench.app.simplex_brush import SimplexBrush
from workbench.app.views.mesh_view import MeshView

ORIGIN = "hover"
PAUSE = 40
"""Milliseconds between two looks at what lies under the pointer."""


class HoverBrush(QObject):
    """Brushes one simplex at a time; what was brushed on purpose is left alone."""

    def __init__(self, brush: SimplexBrush, views: Sequence[MeshView], is_wanted: Callable[[], bool]) -> None:
        super().__init__(brush)
        self._brush = brush
        self._is_wanted = is_wanted
        self._under: tuple[MeshView, tuple[float, float]] | None = None
        self._timer = QTimer(self)
        self._timer.setSingleShot(True)
        self._timer.setInterval(PAUSE)
        self._timer.timeout.connect(self._look)
        for view in views:
            self.add(view)

    def add(self, view: MeshView) -> None:
        """Look at what lies under the pointer in one more view."""
        view.overlay.moved.connect(lambda event: self._move(view, event))
        view.overlay.left.connect(self._leave)
        view.destroyed.connect(self._leave)

    def stop(self) -> None:
        self._timer.stop()

    def _move(self, view: MeshView, event: QMouseEvent) -> None:
        if event.buttons() != Qt.MouseButton.NoButton or not self._is_wanted():
            return
        self._under = (view, (event.position().x(), event.position().y()))
        if not self._timer.isActive():
            self._timer.start()

    def _leave(self) -> None:
        self._under = None
        if self._brush.origin == ORIGIN:
            self._brush.clear()

    def _look(self) -> None:
        if self._under is None or self._brush.origin not in ("", ORIGIN):
            return
        view, pixel = self._under
        simplex = view.simplex_at(pixel)
        self._brush.brush([simplex] if simplex >= 0 else [], ORIGIN)
