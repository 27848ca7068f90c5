"""The one dialog about faults: a sentence, details, and what can be done."""

from __future__ import annotations

from collections.abc import Hashable

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QFontDatabase
from PySide6.QtWidgets import (
    QApplication,
    QDialog,
    QHBoxLayout,
    QLabel,
    QPlainTextEdit,
    QPushButton,
    QStyle,
    QVBoxLayout,
    QWidget,
)

from workbench.app.faults.fault import Fault, report_text

HEADING = "Something went wrong that should not"
ADVICE = (
    "The window may go on as if nothing had been, or behave oddly from here on. Your map is as it was; to be safe, save "
    "the session now. Nothing is sent anywhere: Copy takes the details along, for whoever may mend it."
)


class FaultDialog(QDialog):
    """Lists faults by where they came from; one that comes again is counted. It stops nothing behind it."""

    save_wanted = Signal()
    close_wanted = Signal()

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("faults")
        self.setWindowTitle("Distortion Workbench: a fault")
        self.setModal(False)
        self.resize(680, 420)
        self._faults: dict[Hashable, tuple[Fault, int]] = {}
        picture = QLabel(self)
        picture.setPixmap(self.style().standardIcon(QStyle.StandardPixmap.SP_MessageBoxWarning).pixmap(40, 40))
        heading = QLabel(f"<b>{HEADING}</b>", self)
        self.sentence = QLabel(self)
        self.sentence.setTextFormat(Qt.TextFormat.PlainText)
        self.sentence.setWordWrap(True)
        self.sentence.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        advice = QLabel(ADVICE, self)
        advice.setWordWrap(True)
        words = QVBoxLayout()
        for label in (heading, self.sentence, advice):
            words.addWidget(label)
        top = QHBoxLayout()
        top.setSpacing(12)
        top.addWidget(picture, 0, Qt.AlignmentFlag.AlignTop)
        top.addLayout(words, 1)
        self.details = QPlainTextEdit(self)
        self.details.setReadOnly(True)
        self.details.setFont(QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont))
        self.details.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self.copy_button = QPushButton("Copy", self)
        self.copy_button.setToolTip("Copy the details")
        self.save_button = QPushButton("Save session and go on", self)
        self.go_on_button = QPushButton("Go on", self)
        self.close_button = QPushButton("Close the program", self)
        self.copy_button.clicked.connect(lambda: QApplication.clipboard().setText(self.text))
        self.save_button.clicked.connect(self._save)
        self.go_on_button.clicked.connect(self.close)
        self.close_button.clicked.connect(self._close_all)
        self.save_button.setDefault(True)
        buttons = QHBoxLayout()
        buttons.addWidget(self.copy_button)
        buttons.addStretch(1)
        for button in (self.close_button, self.go_on_button, self.save_button):
            buttons.addWidget(button)
        layout = QVBoxLayout(self)
        layout.addLayout(top)
        layout.addWidget(self.details, 1)
        layout.addLayout(buttons)

    @property
    def text(self) -> str:
        """What Copy takes along."""
        return report_text(self._faults)

    def add(self, fault: Fault) -> None:
        """Show one more."""
        first, count = self._faults.get(fault.key, (fault, 0))
        self._faults[fault.key] = first, count + 1
        newest = f"{fault.sentence}  × {count + 1}" if count else fault.sentence
        others = len(self._faults) - 1
        self.sentence.setText(newest + (f"\nand {others} other{'s' * (others > 1)}, see below" if others else ""))
        place = self.details.verticalScrollBar().value()
        self.details.setPlainText(self.text)
        self.details.verticalScrollBar().setValue(place)

    def _save(self) -> None:
        self.close()
        self.save_wanted.emit()

    def _close_all(self) -> None:
        self.close()
        self.close_wanted.emit()
