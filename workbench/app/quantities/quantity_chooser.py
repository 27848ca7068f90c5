"""Choosing what a view shows: a pattern, a quantity, or a formula of one's own."""

from __future__ import annotations

from collections.abc import Mapping

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QSizePolicy, QWidget

from workbench.app.quantities.formula_dialog import FormulaDialog
from workbench.app.quantities.quantity_book import QuantityBook

FORMULA = "?"
"""Data of the line that asks for a formula; no id has it."""


class QuantityChooser(QComboBox):
    """A list of all quantities of the book, after the patterns in `styles` (id -> label); `chosen` carries the id."""

    chosen = Signal(str)

    def __init__(
        self,
        book: QuantityBook,
        current: str,
        styles: Mapping[str, str] | None = None,
        parent: QWidget | None = None,
    ) -> None:
        super().__init__(parent)
        self._book = book
        self._styles = dict(styles or {})
        self.current = current
        self.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.setMinimumContentsLength(10)
        self.setMaxVisibleItems(30)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.activated.connect(self._activated)
        book.listed.connect(self.fill)
        self.fill()

    def fill(self) -> None:
        """List what there is now; the choice stays."""
        self.blockSignals(True)
        self.clear()
        for id, label in self._styles.items():
            self.addItem(label, id)
        group = "" if self._styles else None
        for quantity in self._book.quantities:
            if group is not None and quantity.group != group:
                self.insertSeparator(self.count())
            group = quantity.group
            self.addItem(quantity.title, quantity.id)
            self.setItemData(self.count() - 1, quantity.formula, Qt.ItemDataRole.ToolTipRole)
        self.insertSeparator(self.count())
        self.addItem("Formula…", FORMULA)
        self.blockSignals(False)
        self.show_choice(self.current)
        self.view().setMinimumWidth(self.view().sizeHintForColumn(0) + 24)

    def show_choice(self, id: str) -> None:
        """Show what is chosen, without telling anyone; what is no longer offered stands there as an empty line."""
        self.current = id
        self.setCurrentIndex(self.findData(id))
        self.setToolTip(str(self.currentData(Qt.ItemDataRole.ToolTipRole) or ""))

    def _activated(self, row: int) -> None:
        id = str(self.itemData(row))
        if id == FORMULA:
            self.show_choice(self.current)
            dialog = FormulaDialog(self._book, self.window())
            dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
            dialog.taken.connect(self._choose)
            dialog.open()
        elif id != self.current:
            self._choose(id)

    def _choose(self, id: str) -> None:
        self.show_choice(id)
        self.chosen.emit(id)
