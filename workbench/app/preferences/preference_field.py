"""The widget in which one preference is chosen."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from PySide6.QtCore import QEvent, QObject
from PySide6.QtWidgets import QCheckBox, QComboBox, QDoubleSpinBox, QSpinBox, QWidget

from workbench.app.preferences.catalogue import Preference

LEAST_WIDTH = 210


class PreferenceField(QObject):
    """Shows a value and tells of another one by `chosen`; `widget` goes into a form."""

    def __init__(self, preference: Preference, chosen: Callable[[Any], None], parent: QWidget) -> None:
        super().__init__(parent)
        self.preference = preference
        self.widget = self._make(chosen, parent)
        self.widget.setObjectName(f"preference-{preference.name}")
        self.widget.setToolTip(preference.parameter.description)
        self.widget.installEventFilter(self)

    def _make(self, chosen: Callable[[Any], None], parent: QWidget) -> QWidget:
        parameter = self.preference.parameter
        if parameter.type is bool:
            tick = QCheckBox(parent)
            tick.toggled.connect(chosen)
            return tick
        if parameter.type is str:
            box = QComboBox(parent)
            box.setMaxVisibleItems(24)
            box.setMinimumWidth(LEAST_WIDTH)
            self._fill(box, self.preference.words)
            box.activated.connect(lambda row: chosen(box.itemData(row)))
            return box
        spin: QSpinBox | QDoubleSpinBox
        low, high = parameter.minimum, parameter.maximum
        assert low is not None and high is not None
        if parameter.type is int:
            spin = QSpinBox(parent)
            spin.setRange(int(low), int(high))
            spin.setSingleStep(int(self.preference.step))
            spin.setGroupSeparatorShown(True)
        else:
            spin = QDoubleSpinBox(parent)
            spin.setDecimals(1)
            spin.setRange(low, high)
            spin.setSingleStep(self.preference.step)
        spin.setSuffix(self.preference.unit)
        spin.setSpecialValueText(self.preference.least)
        spin.setMinimumWidth(LEAST_WIDTH)
        spin.setKeyboardTracking(False)
        spin.valueChanged.connect(chosen)
        return spin

    def offer(self, words: Mapping[str, str]) -> None:
        """Offer other choices: the methods were found."""
        assert isinstance(self.widget, QComboBox)
        value = self.widget.currentData()
        self._fill(self.widget, words)
        self.show(value)

    @staticmethod
    def _fill(box: QComboBox, words: Mapping[str, str]) -> None:
        box.clear()
        for id, text in words.items():
            box.addItem(text, id)

    def show(self, value: Any) -> None:
        """Show what is in force, without telling anyone."""
        widget = self.widget
        widget.blockSignals(True)
        if isinstance(widget, QCheckBox):
            widget.setChecked(value)
        elif isinstance(widget, QComboBox):
            if widget.findData(value) < 0:
                widget.addItem(str(value), value)
            widget.setCurrentIndex(widget.findData(value))
        elif isinstance(widget, QSpinBox | QDoubleSpinBox):
            widget.setValue(value)
        widget.blockSignals(False)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """A wheel that scrolls the page changes no value on its way."""
        if event.type() == QEvent.Type.Wheel and not self.widget.hasFocus():
            event.ignore()
            return True
        return False
