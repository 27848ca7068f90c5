"""A line that shows long work, with a button that ends it."""

from __future__ import annotations

from PySide6.QtCore import QTimer, Signal
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QProgressBar, QPushButton, QWidget

from workbench.app.focus_back import give_focus_back

DELAY = 350
"""Milliseconds before work is called long: shorter work leaves no flicker."""


class ProgressLine(QFrame):
    """Sentence, bar and Cancel; comes up by itself when work lasts."""

    cancelled = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("progress-line")
        layout = QHBoxLayout(self)
        layout.setContentsMargins(12, 4, 8, 4)
        self.label = QLabel(self)
        self.label.setWordWrap(True)
        self.bar = QProgressBar(self)
        self.bar.setTextVisible(False)
        self.bar.setFixedSize(180, 12)
        self.cancel_button = QPushButton("Cancel", self)
        self.cancel_button.clicked.connect(self._cancel)
        layout.addWidget(self.label, 1)
        layout.addWidget(self.bar)
        layout.addWidget(self.cancel_button)
        self._delay = QTimer(self)
        self._delay.setSingleShot(True)
        self._delay.setInterval(DELAY)
        self._delay.timeout.connect(self.show)
        self.hide()

    def begin(self, sentence: str, fraction: float = -1.0) -> None:
        """Work goes on; `fraction` in [0, 1], negative where it is not known."""
        self.label.setText(sentence)
        if fraction < 0:
            self.bar.setRange(0, 0)
        else:
            self.bar.setRange(0, 1000)
            self.bar.setValue(round(1000 * min(fraction, 1.0)))
        if not self.isVisible() and not self._delay.isActive():
            self._delay.start()

    def end(self) -> None:
        self._delay.stop()
        give_focus_back(self)
        self.hide()

    def _cancel(self) -> None:
        self.end()
        self.cancelled.emit()
