"""The parameters of a distortion, a slider each."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QSizePolicy, QVBoxLayout, QWidget

from workbench.app.panels.parameter_range import ParameterRange
from workbench.app.panels.parameter_row import ParameterRow
from workbench.core.method import Parameter

WIDEST_LABEL = 64
"""Pixels."""


class ParameterSliders(QWidget):
    """`moved` carries every value and whether the hand rests. Ranges are remembered by name from formula to formula."""

    moved = Signal(dict, bool)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self._layout = QVBoxLayout(self)
        self._layout.setContentsMargins(0, 2, 0, 0)
        self._layout.setSpacing(2)
        self._parameters: tuple[Parameter, ...] = ()
        self._free: frozenset[str] = frozenset()
        self._ranges: dict[str, ParameterRange] = {}
        self.rows: dict[str, ParameterRow] = {}
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)
        self.hide()

    @property
    def values(self) -> dict[str, float]:
        return {name: row.value for name, row in self.rows.items()}

    @property
    def ranges(self) -> dict[str, ParameterRange]:
        return {name: row.range for name, row in self.rows.items()}

    @property
    def is_held(self) -> bool:
        """Whether the mouse has one of the sliders."""
        return any(row.is_held for row in self.rows.values())

    def show_parameters(self, parameters: Sequence[Parameter], values: Mapping[str, float], free: Collection[str] = ()) -> None:
        """Show values; rows are made anew only where the parameters are others. `free` ones have no bounds but the range's."""
        if tuple(parameters) != self._parameters or frozenset(free) != self._free:
            self._make_rows(tuple(parameters), values, frozenset(free))
        for name, row in self.rows.items():
            if row.value != values[name]:
                row.show_value(values[name])
        self.setVisible(bool(self.rows))

    def _make_rows(self, parameters: tuple[Parameter, ...], values: Mapping[str, float], free: frozenset[str]) -> None:
        self._remember()
        for row in self.rows.values():
            self._layout.removeWidget(row)
            row.hide()
            row.deleteLater()
        self._parameters, self._free, self.rows = parameters, free, {}
        for item in parameters:
            value = values[item.name]
            range = ParameterRange.of(item, value)
            if item.name in free and item.name in self._ranges:
                range = self._ranges[item.name].with_value(value)
            row = ParameterRow(item, value, range, item.name not in free, self)
            row.moved.connect(lambda _, rests: self.moved.emit(self.values, rests))
            row.range_changed.connect(self._remember)
            self._layout.addWidget(row)
            self.rows[item.name] = row
        widest = max((row.label.sizeHint().width() for row in self.rows.values()), default=0)
        for row in self.rows.values():
            row.set_label_width(min(widest, WIDEST_LABEL))

    def _remember(self) -> None:
        self._ranges |= self.ranges
