"""Choosing a solver or an initializer, with its source and its form."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QLabel, QVBoxLayout, QWidget

from workbench.app.panels.method_form import MethodForm
from workbench.core.method import Method


class MethodBox(QWidget):
    """List of methods; `chosen` carries the id and the values that differ from the defaults."""

    chosen = Signal(str, dict)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._methods: dict[str, type[Method]] = {}
        self._current = ""
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(4)
        self.combo = QComboBox(self)
        self.combo.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.combo.setMinimumContentsLength(12)
        self.combo.activated.connect(self._activated)
        self.source = QLabel(self)
        self.source.setWordWrap(True)
        self.source.setObjectName("citation")
        self.form = MethodForm(self)
        self.form.changed.connect(lambda values: self.chosen.emit(self._current, values))
        for widget in (self.combo, self.source, self.form):
            layout.addWidget(widget)

    def show_choices(self, methods: Mapping[str, type[Method]], kind: str) -> None:
        """Fill the list with what serves a kind of map."""
        fitting = {id: method for id, method in methods.items() if not kind or kind in method.kinds}
        self._methods = dict(sorted(fitting.items(), key=lambda item: item[1].label.lower()))
        self.combo.blockSignals(True)
        self.combo.clear()
        for id, method in self._methods.items():
            self.combo.addItem(method.label, id)
            tip = " ".join((method.__doc__ or "").split("\n\n")[0].split())
            self.combo.setItemData(self.combo.count() - 1, tip, Qt.ItemDataRole.ToolTipRole)
        self.combo.blockSignals(False)

    def show_choice(self, id: str, values: Mapping[str, Any]) -> None:
        """Show what is in force, without telling anyone."""
        is_same = id == self._current and self.form.values == dict(values)
        self._current = id
        row = self.combo.findData(id)
        self.combo.setCurrentIndex(row)
        method = self._methods.get(id)
        self.source.setText(method.citation if method is not None else "")
        self.source.setVisible(bool(self.source.text()))
        if not is_same or not self.form.fields:
            self.form.show_parameters(method.parameters() if method is not None else (), dict(values))

    def _activated(self, row: int) -> None:
        id = self.combo.itemData(row)
        if id and id != self._current:
            self.chosen.emit(id, {})
