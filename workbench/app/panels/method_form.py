"""A form made from a method's parameters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QCheckBox, QComboBox, QFormLayout, QLabel, QLineEdit, QSizePolicy, QSpinBox, QWidget

from workbench.app.panels.parameter_row import bounds_of
from workbench.core.errors import WorkbenchError
from workbench.core.method import Parameter

LARGE = 2_000_000_000


class MethodForm(QWidget):
    """One line a parameter; `changed` carries the values that differ from the defaults."""

    changed = Signal(dict)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._layout = QFormLayout(self)
        self._layout.setContentsMargins(0, 0, 0, 0)
        self._layout.setFieldGrowthPolicy(QFormLayout.FieldGrowthPolicy.AllNonFixedFieldsGrow)
        self._layout.setRowWrapPolicy(QFormLayout.RowWrapPolicy.WrapLongRows)
        self._parameters: tuple[Parameter, ...] = ()
        self._values: dict[str, Any] = {}
        self.fields: dict[str, QWidget] = {}
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)

    def show_parameters(self, parameters: Sequence[Parameter], values: dict[str, Any] | None = None) -> None:
        """Build the form for another method."""
        while self._layout.rowCount():
            self._layout.removeRow(0)
        self._parameters = tuple(parameters)
        self._values = dict(values or {})
        self.fields = {}
        for item in self._parameters:
            field = self._field(item, self._values.get(item.name, item.default))
            label = QLabel(item.name.replace("_", " "), self)
            for widget in (label, field):
                widget.setToolTip(_tip(item))
            label.setBuddy(field)
            self._layout.addRow(label, field)
            self.fields[item.name] = field
        self.setVisible(bool(self._parameters))

    @property
    def values(self) -> dict[str, Any]:
        return dict(self._values)

    def _field(self, item: Parameter, value: Any) -> QWidget:
        if item.choices:
            box = QComboBox(self)
            box.addItems(list(item.choices))
            box.setCurrentText(str(value))
            box.currentTextChanged.connect(lambda text, p=item: self._take(p, text))
            return box
        if item.type is bool:
            check = QCheckBox(self)
            check.setChecked(bool(value))
            check.toggled.connect(lambda on, p=item: self._take(p, on))
            return check
        if item.type is int:
            spin = QSpinBox(self)
            spin.setRange(
                int(item.minimum) if item.minimum is not None else -LARGE,
                int(item.maximum) if item.maximum is not None else LARGE,
            )
            spin.setValue(int(value))
            spin.setKeyboardTracking(False)
            spin.valueChanged.connect(lambda number, p=item: self._take(p, number))
            return spin
        # a line of text takes any number of digits and any exponent, which a spin box does not
        line = QLineEdit(f"{value:g}" if item.type is float else str(value), self)
        line.editingFinished.connect(lambda p=item, source=line: self._take(p, source.text(), source))
        return line

    def _take(self, item: Parameter, value: Any, line: QLineEdit | None = None) -> None:
        try:
            checked = item.check(value)
        except WorkbenchError as error:
            if line is not None:
                line.setToolTip(error.sentence)
                line.setStyleSheet("QLineEdit { border: 1px solid #d6332a; }")
            return
        if line is not None:
            line.setStyleSheet("")
            line.setToolTip(_tip(item))
        before = dict(self._values)
        if checked == item.default:
            self._values.pop(item.name, None)
        else:
            self._values[item.name] = checked
        if self._values != before:
            self.changed.emit(dict(self._values))


def _tip(item: Parameter) -> str:
    return f"{item.description or item.name}{bounds_of(item)}"
