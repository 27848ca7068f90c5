"""Keys that mean something while a drag is under way, whoever has the focus."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QWidget

from workbench.app.handling.key_trap import KeyTrap

AXES = {Qt.Key.Key_X: "x", Qt.Key.Key_Y: "y", Qt.Key.Key_Z: "z"}
KEYS = (*AXES, Qt.Key.Key_N, Qt.Key.Key_Escape)
DEEDS = {Qt.Key.Key_G: "move", Qt.Key.Key_R: "turn", Qt.Key.Key_S: "scale"}
DONE = (Qt.Key.Key_Return, Qt.Key.Key_Enter, Qt.Key.Key_Space)
NUMBERS = "0123456789.,-"
FREE_KEYS = (*DEEDS, *DONE, Qt.Key.Key_Backspace, Qt.Key.Key_Tab)


class HoldKeys(KeyTrap):
    """X, Y, Z lock an axis, with Shift the plane across it; N locks the normal; Esc takes the drag back.

    While no button is held, numbers can be typed, Enter ends, and G, R, S do another thing instead.
    """

    axis_pressed = Signal(str, bool)
    normal_pressed = Signal()
    cancelled = Signal()
    typed = Signal(str)
    """A character of a number; empty: the last one goes; a tab: the next number"""
    confirmed = Signal()
    deed_pressed = Signal(str)

    def __init__(self, parent: QObject, own: QWidget) -> None:
        super().__init__(parent)
        self._own = own
        self.is_free = False

    def wants(self, event: QKeyEvent) -> bool:
        key = Qt.Key(event.key())
        if key in KEYS:
            return True
        is_plain = not event.modifiers() & (Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier)
        return self.is_free and is_plain and (key in FREE_KEYS or (bool(event.text()) and event.text() in NUMBERS))

    def take(self, event: QKeyEvent) -> None:
        key = Qt.Key(event.key())
        if key == Qt.Key.Key_Backspace:
            self.typed.emit("")
        elif event.isAutoRepeat():
            return
        elif key in AXES:
            self.axis_pressed.emit(AXES[key], bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier))
        elif key == Qt.Key.Key_N:
            self.normal_pressed.emit()
        elif key == Qt.Key.Key_Escape:
            self.cancelled.emit()
        elif key in DEEDS:
            self.deed_pressed.emit(DEEDS[key])
        elif key in DONE:
            self.confirmed.emit()
        else:
            self.typed.emit("\t" if key == Qt.Key.Key_Tab else event.text())

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        is_press = event.type() == QEvent.Type.MouseButtonPress
        if self.is_free and is_press and isinstance(watched, QWidget) and watched is not self._own:
            self.confirmed.emit()  # the hand has gone on to something else
            return isinstance(watched, type(self._own))  # in another view the click means no more than that
        return super().eventFilter(watched, event)
