"""Typing a formula that a view shall show; it need not be one that is solved for."""

from __future__ import annotations

import re

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QFormLayout, QLabel, QLineEdit, QWidget

from workbench.app.quantities.quantity_book import QuantityBook
from workbench.core.errors import FormulaError, WorkbenchError


class FormulaDialog(QDialog):
    """Formula and parameter values; `taken` carries the id of the quantity that they become."""

    taken = Signal(str)

    def __init__(self, book: QuantityBook, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("A formula to show")
        self._book = book
        self.formula = QLineEdit(self)
        self.formula.setPlaceholderText("sigma1 - sigma2")
        self.formula.setMinimumWidth(340)
        self.values = QLineEdit(self)
        self.values.setPlaceholderText("none, or: p = 4, t = 0.5")
        self.error = QLabel("In sigma, sigma1 … sigman, det, n, and distortions by their names with underscores.", self)
        self.error.setWordWrap(True)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Ok | QDialogButtonBox.StandardButton.Cancel, self)
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        layout = QFormLayout(self)
        layout.addRow("Formula", self.formula)
        layout.addRow("Parameters", self.values)
        layout.addRow(self.error)
        layout.addRow(buttons)

    def accept(self) -> None:
        try:
            quantity = self._book.add_formula(self.formula.text(), values_in(self.values.text()))
        except WorkbenchError as error:
            place = f" (column {error.position + 1})" if isinstance(error, FormulaError) else ""
            self.error.setObjectName("form-error")
            self.error.setText(error.sentence + place)
            self.error.style().polish(self.error)
            return
        self.taken.emit(quantity.id)
        super().accept()


def values_in(text: str) -> dict[str, float]:
    """`name = value` pairs, separated by commas or semicolons. Raises `WorkbenchError`."""
    values = {}
    for part in filter(None, (part.strip() for part in re.split(r"[,;]", text))):
        name, equals, value = (piece.strip() for piece in part.partition("="))
        try:
            values[name] = float(value)
        except ValueError:
            raise WorkbenchError(f"{part!r} is not of the form name = value.") from None
        if not name.isidentifier() or not equals:
            raise WorkbenchError(f"{part!r} is not of the form name = value.")
    return values
