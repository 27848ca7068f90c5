"""Keys that mean something while a drag is under way, whoever has the focus."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QApplication

AXES = {Qt.Key.Key_X: "x", Qt.Key.Key_Y: "y", Qt.Key.Key_Z: "z"}
KEYS = (*AXES, Qt.Key.Key_N, Qt.Key.Key_Escape)


class HoldKeys(QObject):
    """X, Y, Z lock an axis, with Shift the plane across it; N locks the normal; Esc takes the drag back."""

    axis_pressed = Signal(str, bool)
    normal_pressed = Signal()
    cancelled = Signal()

    def listen(self, wanted: bool) -> None:
        """Take these keys from everyone else, or leave them to them again."""
        application = QApplication.instance()
        if application is not None:
            application.removeEventFilter(self)
            if wanted:
                application.installEventFilter(self)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        if event.type() not in (QEvent.Type.ShortcutOverride, QEvent.Type.KeyPress) or not isinstance(event, QKeyEvent):
            return False
        key = Qt.Key(event.key())
        if key not in KEYS:
            return False
        event.accept()  # whoever was to have it, a window or a widget, does not see it any more
        if event.type() == QEvent.Type.KeyPress and not event.isAutoRepeat():
            if key in AXES:
                self.axis_pressed.emit(AXES[key], bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier))
            elif key == Qt.Key.Key_N:
                self.normal_pressed.emit()
            else:
                self.cancelled.emit()
        return True
