"""Choosing a distortion: one of the list, or a formula that is checked while it is typed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from PySide6.QtCore import Qt, QTimer, Signal
from PySide6.QtWidgets import QComboBox, QLabel, QVBoxLayout, QWidget

from workbench.app.panels.method_form import MethodForm
from workbench.core.distortion import Distortion
from workbench.core.errors import FormulaError, WorkbenchError

PAUSE = 250
"""Milliseconds of rest after a key before a formula is checked."""


class DistortionBox(QWidget):
    """Editable list of distortions with the formula, the source and a form below; `chosen` carries text and values."""

    chosen = Signal(str, dict)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._known: dict[str, Distortion] = {}
        self._current = ""
        self._rest = QTimer(self)
        self._rest.setSingleShot(True)
        self._rest.setInterval(PAUSE)
        self._rest.timeout.connect(self._check)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(4)
        self.combo = QComboBox(self)
        self.combo.setEditable(True)
        self.combo.setInsertPolicy(QComboBox.InsertPolicy.NoInsert)
        self.combo.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.combo.setMinimumContentsLength(12)
        self.combo.setToolTip("Choose one, or type a formula such as sum(sigma^2 + 1/sigma^2) and press Enter.")
        self.combo.activated.connect(self._activated)
        edit, completer = self.combo.lineEdit(), self.combo.completer()
        assert edit is not None and completer is not None
        completer.setCaseSensitivity(Qt.CaseSensitivity.CaseInsensitive)
        self._edit = edit
        edit.textEdited.connect(lambda _: self._rest.start())
        edit.returnPressed.connect(self.accept_text)
        self.formula = QLabel(self)
        self.formula.setWordWrap(True)
        self.formula.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.source = QLabel(self)
        self.source.setWordWrap(True)
        self.source.setObjectName("citation")
        self.error = QLabel(self)
        self.error.setWordWrap(True)
        self.error.setObjectName("form-error")
        self.error.hide()
        self.form = MethodForm(self)
        self.form.changed.connect(self._values_changed)
        for widget in (self.combo, self.error, self.formula, self.source, self.form):
            layout.addWidget(widget)

    def show_choices(self, distortions: Mapping[str, Distortion], kind: str) -> None:
        """Fill the list with what serves a kind of map."""
        self._known = dict(distortions)
        self.combo.blockSignals(True)
        self.combo.clear()
        for item in self._known.values():
            if not kind or kind in item.kinds:
                self.combo.addItem(_title(item), item.id)
                tip = item.description or item.formula
                self.combo.setItemData(self.combo.count() - 1, tip, Qt.ItemDataRole.ToolTipRole)
        self.combo.blockSignals(False)
        self.show_choice(self._current, self.form.values)

    def show_choice(self, text: str, values: Mapping[str, Any]) -> None:
        """Show what is in force, without telling anyone."""
        is_same = text == self._current and self.form.values == dict(values)
        self._current = text
        row = self.combo.findData(text)
        if row >= 0:
            self.combo.setCurrentIndex(row)
        elif not self._edit.hasFocus():
            self.combo.setCurrentIndex(-1)
            self._edit.setText(text)
        self._edit.setCursorPosition(0)
        item = self._resolved(text, values)
        if item is None:
            return
        self.formula.setText(f"D = {item.formula}")
        self.source.setText(item.citation)
        self.source.setVisible(bool(item.citation))
        self.error.hide()
        if not is_same or not self.form.fields:
            self.form.show_parameters(item.parameters, dict(item.values))

    def _resolved(self, text: str, values: Mapping[str, Any]) -> Distortion | None:
        if not self._known:
            return None
        try:
            return Distortion.resolve(text, values)
        except WorkbenchError as error:
            self._show_error(error)
            return None

    def _show_error(self, error: WorkbenchError) -> None:
        self.error.setText(error.sentence)
        self.error.show()
        if isinstance(error, FormulaError) and self._edit.hasFocus() and self._rest_is_over():
            self.error.setText(f"{error.sentence} (column {error.position + 1})")

    def _rest_is_over(self) -> bool:
        return not self._rest.isActive()

    def _activated(self, row: int) -> None:
        id = self.combo.itemData(row)
        if id and id != self._current:
            self.chosen.emit(id, {})

    def _check(self) -> None:
        """While typing: say what is wrong, and nothing more."""
        text = self._edit.text().strip()
        if not text or self._id_of_title(text):
            self.error.hide()
            return
        item = self._resolved(text, {})
        if item is not None:
            self.error.hide()
            self.formula.setText(f"D = {item.formula}")

    def _id_of_title(self, text: str) -> str:
        row = self.combo.findText(text)
        return str(self.combo.itemData(row)) if row >= 0 else ""

    def accept_text(self) -> None:
        """Enter: take the typed formula, where it is one."""
        self._rest.stop()
        text = self._edit.text().strip()
        id = self._id_of_title(text) or text
        if id and id != self._current and self._resolved(id, {}) is not None:
            self.chosen.emit(id, {})

    def _values_changed(self, values: dict[str, Any]) -> None:
        self.chosen.emit(self._current, values)


def _title(item: Distortion) -> str:
    """Long name and short name, where it has one."""
    return f"{item.label} ({item.short})" if item.short and item.short not in item.label else item.label
