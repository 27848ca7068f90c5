"""The window of the sheet: to be searched, copied and printed."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QMarginsF, Qt
from PySide6.QtGui import QPageLayout, QPageSize, QPdfWriter, QTextDocument
from PySide6.QtWidgets import (
    QApplication,
    QDialog,
    QDialogButtonBox,
    QLabel,
    QLineEdit,
    QTextBrowser,
    QVBoxLayout,
    QWidget,
)

from workbench.app.files.new_file import ask_new_file
from workbench.app.shortcuts.sheet import Sheet, as_html, as_text, filtered

NAME = "keys.pdf"
MARGIN = 15.0
"""Millimetres round the page."""


class SheetWindow(QDialog):
    """Shows what fits the words that are typed; Copy and PDF take what is shown."""

    def __init__(self, sheet: Sheet, folder: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle("Keys and mouse")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._sheet, self._folder = sheet, folder
        self.line = QLineEdit(self)
        self.line.setPlaceholderText("A key, or what it does")
        self.line.setClearButtonEnabled(True)
        self.line.textChanged.connect(self._show)
        self.page = QTextBrowser(self)
        self.note = QLabel(self)
        buttons = QDialogButtonBox(self)
        for text, tip, deed in (
            ("Copy", "What is shown, as lines with tabs", self.copy),
            ("Save as PDF…", "What is shown, as pages to print", self._ask_file),
        ):
            button = buttons.addButton(text, QDialogButtonBox.ButtonRole.ActionRole)
            button.setToolTip(tip)
            button.setAutoDefault(False)
            button.clicked.connect(deed)
        buttons.addButton(QDialogButtonBox.StandardButton.Close).setAutoDefault(False)
        buttons.rejected.connect(self.reject)
        layout = QVBoxLayout(self)
        for widget in (self.line, self.page, self.note, buttons):
            layout.addWidget(widget)
        self.resize(720, 640)
        self._show("")
        self.line.setFocus()

    @property
    def shown(self) -> Sheet:
        """What fits the words that are typed."""
        return filtered(self._sheet, self.line.text())

    def _show(self, _: str) -> None:
        self.page.setHtml(as_html(self.shown) or "<p>Nothing fits.</p>")

    def copy(self) -> None:
        """Put what is shown on the clipboard."""
        QApplication.clipboard().setText(as_text(self.shown))
        self.note.setText("Copied.")

    def _ask_file(self) -> None:
        place = str(Path(self._folder) / NAME)
        ask_new_file(self, "Save the sheet", place, "PDF (*.pdf)", "pdf", self.save, overwrites=True)

    def save(self, path: str) -> None:
        """Write what is shown as pages, black on white whatever the theme."""
        writer = QPdfWriter(path)
        writer.setTitle("Distortion Workbench: keys and mouse")
        margins = QMarginsF(MARGIN, MARGIN, MARGIN, MARGIN)
        writer.setPageLayout(
            QPageLayout(
                QPageSize(QPageSize.PageSizeId.A4), QPageLayout.Orientation.Portrait, margins, QPageLayout.Unit.Millimeter
            )
        )
        document = QTextDocument()
        document.setHtml(f'<body style="color: black; font-size: 9pt">{as_html(self.shown)}</body>')
        try:
            with Path(path).open("ab"):  # the writer itself does not say whether it could
                pass
            document.print_(writer)
        except OSError as error:
            self.note.setText(f"{Path(path).name} could not be written ({error.strerror}); choose another folder.")
            return
        self.note.setText(f"Saved {path}.")
