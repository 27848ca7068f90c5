"""What the mouse does in every view: zoom, pan, turn."""

from __future__ import annotations

from PySide6.QtCore import QObject, QPointF, Qt
from PySide6.QtGui import QMouseEvent, QWheelEvent

from workbench.app.views.camera import Pixel
from workbench.app.views.mesh_view import MeshView


class NavigationTool(QObject):
    """Wheel zooms at the pointer, middle drag pans, left drag on the background turns a surface in space."""

    def __init__(self, view: MeshView) -> None:
        super().__init__(view)
        self.view = view
        self._last: QPointF | None = None
        self._mode = ""
        overlay = view.overlay
        overlay.pressed.connect(self.press)
        overlay.moved.connect(self.move)
        overlay.released.connect(self.release)
        overlay.double_clicked.connect(self.double_click)
        overlay.wheeled.connect(self.wheel)
        overlay.left.connect(self.leave)

    @property
    def can_rotate(self) -> bool:
        return self.view.geometry_shown is not None and not self.view.geometry_shown.is_flat

    def press(self, event: QMouseEvent) -> None:
        if event.button() == Qt.MouseButton.MiddleButton:
            self._begin("pan", event)
        elif event.button() == Qt.MouseButton.LeftButton:
            self._begin("rotate" if self.can_rotate else "pan", event)

    def _begin(self, mode: str, event: QMouseEvent) -> None:
        self._mode = mode
        self._last = event.position()

    def move(self, event: QMouseEvent) -> None:
        if self._last is None or self.view.geometry_shown is None:
            return
        step = event.position() - self._last
        self._last = event.position()
        size = self.view.size_in_pixels
        if self._mode == "pan":
            self.view.set_camera(self.view.camera.panned(step.x(), step.y(), size))
        elif self._mode == "rotate":
            self.view.set_camera(self.view.camera.rotated(step.x(), step.y(), size))

    def release(self, event: QMouseEvent) -> None:
        self._last = None
        self._mode = ""

    def double_click(self, event: QMouseEvent) -> None:
        if not self.view.is_over_mesh(pixel_of(event)):
            self.view.fit()

    def wheel(self, event: QWheelEvent) -> None:
        if self.view.geometry_shown is None:
            return
        turns = event.angleDelta().y() / 120.0
        where = event.position()
        self.view.set_camera(self.view.camera.zoomed(1.2**turns, (where.x(), where.y()), self.view.size_in_pixels))

    def leave(self) -> None:
        pass


def pixel_of(event: QMouseEvent) -> Pixel:
    """Where the pointer is, in pixels of the widget."""
    return event.position().x(), event.position().y()
