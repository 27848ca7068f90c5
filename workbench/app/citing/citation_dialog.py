"""A bibliography to copy or to save."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtGui import QFontDatabase, QGuiApplication
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QLabel, QPlainTextEdit, QVBoxLayout, QWidget

from workbench.app.files.new_file import ask_new_file
from workbench.core.bibliography import Cited, bibtex

EXPLANATION = (
    "The survey that this program follows, and what the distortions, solvers and the start of this session are taken from: "
    "those that are chosen now, and those that led to the map."
)
FILTER = "BibTeX (*.bib)"
Buttons = QDialogButtonBox.StandardButton
Role = QDialogButtonBox.ButtonRole


class CitationDialog(QDialog):
    """What each method is taken from, then the entries, to be read and copied; `save_wanted` carries a place."""

    save_wanted = Signal(str)

    def __init__(self, methods: Sequence[Cited], folder: str, stem: str, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Cite what this session uses")
        self._place = str(Path(folder) / f"{stem}.bib")
        explanation = QLabel(EXPLANATION, self)
        explanation.setWordWrap(True)
        self.text = QPlainTextEdit(bibtex(methods), self)
        self.text.setReadOnly(True)
        self.text.setLineWrapMode(QPlainTextEdit.LineWrapMode.NoWrap)
        self.text.setFont(QFontDatabase.systemFont(QFontDatabase.SystemFont.FixedFont))
        self.text.setMinimumSize(760, 360)
        buttons = QDialogButtonBox(Buttons.Close, self)
        self.copy_button = buttons.addButton("&Copy", Role.ActionRole)
        self.copy_button.clicked.connect(self.copy)
        buttons.addButton("&Save as .bib…", Role.ActionRole).clicked.connect(self._ask_save)
        buttons.rejected.connect(self.reject)
        layout = QVBoxLayout(self)
        for part in (explanation, self.text, buttons):
            layout.addWidget(part)
        layout.setStretchFactor(self.text, 1)

    def copy(self) -> None:
        """Put the bibliography on the clipboard."""
        QGuiApplication.clipboard().setText(self.text.toPlainText())
        self.copy_button.setText("Copied")

    def _ask_save(self) -> None:
        ask_new_file(self, "Save the bibliography", self._place, FILTER, "bib", self.save_wanted.emit, overwrites=True)
