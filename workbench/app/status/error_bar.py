"""A bar that says what went wrong and what to do, without stopping anything."""

from __future__ import annotations

import logging
import time
from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QPlainTextEdit,
    QPushButton,
    QToolButton,
    QVBoxLayout,
    QWidget,
)

from workbench.app.appearance.theme import Theme
from workbench.app.focus_back import give_focus_back

FIX_LABELS = {
    "reorient": "Reorient consistently",
    "largest": "Keep the largest component",
    "unreferenced": "Remove unreferenced vertices",
    "seams": "Cut along the texture seams",
    "cut": "Cut open to a disc",
    "linearise": "Make the elements linear",
    "tets": "Read its faces as tetrahedra",
}


EITHER = ("seams", "cut")
"""Fixes of which one is enough."""
MOST_BESIDE = 2
"""Buttons for fixes that stand beside the sentence; more would leave it a column of single words, and go below."""
READ = 4.0
"""Seconds in which a sentence is read."""


class ErrorBar(QFrame):
    """One message at a time: sentence, buttons for fixes, details that fold out; the same again is counted."""

    fix_wanted = Signal(object)
    """Names of the fixes to apply, in order."""
    told = Signal(int, str, str)
    """A message was shown: its level as in Python's logging, the sentence, the details."""

    def __init__(self, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setObjectName("error-bar")
        outer = QVBoxLayout(self)
        outer.setContentsMargins(12, 7, 8, 7)
        outer.setSpacing(6)
        line = QHBoxLayout()
        line.setSpacing(8)
        self.sentence = QLabel(self)
        self.sentence.setWordWrap(True)
        self.sentence.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        line.addWidget(self.sentence, 1)
        self.count = QLabel(self)
        self.count.setContentsMargins(0, 4, 0, 0)
        self.count.setToolTip("So often has this been told")
        line.addWidget(self.count, 0, Qt.AlignmentFlag.AlignTop)
        self._times, self._shown_at = 0, 0.0
        self._beside = QHBoxLayout()
        line.addLayout(self._beside)
        self.details_button = QToolButton(self)
        self.details_button.setText("Details")
        self.details_button.setCheckable(True)
        self.details_button.toggled.connect(self._show_details)
        line.addWidget(self.details_button, 0, Qt.AlignmentFlag.AlignTop)
        self.close_button = QToolButton(self)
        self.close_button.setText("✕")
        self.close_button.setToolTip("Dismiss")
        self.close_button.setAutoRaise(True)
        self.close_button.clicked.connect(self.dismiss)
        line.addWidget(self.close_button, 0, Qt.AlignmentFlag.AlignTop)
        outer.addLayout(line)
        self._below = QHBoxLayout()
        self._below.addStretch(1)
        outer.addLayout(self._below)
        self.details = QPlainTextEdit(self)
        self.details.setReadOnly(True)
        self.details.setMaximumHeight(160)
        self.details.hide()
        outer.addWidget(self.details)
        self.fix_buttons: list[QPushButton] = []
        self.set_theme(theme)
        self.hide()

    def set_theme(self, theme: Theme) -> None:
        self.setStyleSheet(
            f"#error-bar {{ background: {theme.warning}; border: 1px solid {theme.border}; border-radius: 6px; }}"
            f"#error-bar[is-error=true] {{ border: 1px solid {'#ff8a80' if theme.is_dark else '#b3261e'}; }}"
            f"#error-bar QLabel {{ color: {theme.warning_text}; }}"
        )

    def show_message(self, sentence: str, fixes: Sequence[str] = (), details: str = "", level: int = logging.WARNING) -> None:
        """Put a message in the place of the one before."""
        is_again = not self.isHidden() and sentence == self.sentence.text()
        self._times = self._times + 1 if is_again else 1
        self.count.setText(f"× {self._times}")
        self.count.setVisible(self._times > 1)
        self.sentence.setText(sentence)
        self.setProperty("is-error", level >= logging.ERROR)
        self.style().polish(self)
        self.told.emit(level, sentence, details)
        for button in self.fix_buttons:
            for row in (self._beside, self._below):
                row.removeWidget(button)
            button.hide()
            button.deleteLater()
        self.fix_buttons = []
        choices = {FIX_LABELS.get(name, name.capitalize()): (name,) for name in fixes}
        if len(fixes) > 1 and tuple(fixes) != EITHER:
            choices["Do all of these"] = tuple(fixes)
        row = self._beside if len(choices) <= MOST_BESIDE else self._below
        for text, names in choices.items():
            self._add_button(row, text, names)
        self.details.setPlainText(details)
        self.details_button.setVisible(bool(details))
        self.details_button.setChecked(self.details_button.isChecked() and is_again and bool(details))
        self._shown_at = time.monotonic()
        self.show()

    def _add_button(self, row: QHBoxLayout, text: str, names: tuple[str, ...]) -> None:
        button = QPushButton(text, self)
        button.clicked.connect(lambda _=False, chosen=names: self._choose(chosen))
        row.addWidget(button, 0, Qt.AlignmentFlag.AlignTop)
        self.fix_buttons.append(button)

    def _choose(self, names: tuple[str, ...]) -> None:
        self.dismiss()
        self.fix_wanted.emit(names)

    def _show_details(self, wanted: bool) -> None:
        self.details.setVisible(wanted)

    def pass_by(self, after: float = READ) -> None:
        """Whoever goes on has read it: what offers nothing, and has been there for `after` seconds, goes."""
        if not self.fix_buttons and not self.details.toPlainText() and time.monotonic() - self._shown_at >= after:
            self.dismiss()

    def dismiss(self) -> None:
        give_focus_back(self)
        self.details.hide()
        self.hide()
