"""The status bar: what is happening, in words and numbers."""

from __future__ import annotations

import math

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtWidgets import QLabel, QStatusBar, QWidget

FIELDS = (
    ("state", "State", 8),
    ("iteration", "Iteration", 14),
    ("rate", "Iterations a second", 8),
    ("mean", "Mean distortion: energy over total rest measure", 14),
    ("inverted", "Inverted simplices", 11),
    ("delay", "From a move of the hand to the picture that holds it", 10),
)


class ElidedLabel(QLabel):
    """A label that ends in an ellipsis where there is no room; the whole text is its tool tip."""

    def setText(self, text: str) -> None:
        if text != self.text():
            super().setText(text)
            self.setToolTip(text)

    def minimumSizeHint(self):  # type: ignore[no-untyped-def]
        hint = super().minimumSizeHint()
        hint.setWidth(40)
        return hint

    def paintEvent(self, event: QPaintEvent) -> None:
        painter = QPainter(self)
        text = self.fontMetrics().elidedText(self.text(), Qt.TextElideMode.ElideRight, self.width())
        painter.setPen(self.palette().windowText().color())
        painter.drawText(self.rect(), Qt.AlignmentFlag.AlignVCenter | Qt.AlignmentFlag.AlignLeft, text)
        painter.end()


class StatusLine(QStatusBar):
    """Sentence to the left, numbers to the right; all of fixed width, so that nothing jumps."""

    said = Signal(str)
    """A sentence that is not the one before."""

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.sentence = ElidedLabel(self)
        self.addWidget(self.sentence, 1)
        self.fields: dict[str, QLabel] = {}
        for name, tip, characters in FIELDS:
            label = QLabel(self)
            label.setToolTip(tip)
            label.setAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
            label.setMinimumWidth(self.fontMetrics().horizontalAdvance("0") * characters + 12)
            self.addPermanentWidget(label)
            self.fields[name] = label

    def say(self, sentence: str) -> None:
        if sentence != self.sentence.text():
            self.sentence.setText(sentence)
            self.said.emit(sentence)

    def show_field(self, name: str, text: str) -> None:
        label = self.fields[name]
        if label.text() != text:
            label.setText(text)

    def show_tip(self, name: str, text: str) -> None:
        label = self.fields[name]
        if label.toolTip() != text:
            label.setToolTip(text)

    def show_number(self, name: str, value: float, form: str) -> None:
        """`form` is a format with one place, left empty where the number is not finite."""
        self.show_field(name, form.format(value) if math.isfinite(value) else form.format(math.inf).replace("inf", "∞"))

    def clear_numbers(self) -> None:
        for label in self.fields.values():
            label.setText("")
