"""One parameter: a name, a slider, a number, and its range to be edited below."""

from __future__ import annotations

from PySide6.QtCore import QEvent, QObject, Qt, Signal
from PySide6.QtWidgets import QCheckBox, QGridLayout, QHBoxLayout, QLabel, QLineEdit, QSlider, QToolButton, QWidget

from workbench.app.panels.number_box import LARGE, NumberBox
from workbench.app.panels.parameter_range import ParameterRange
from workbench.core.method import Parameter


class ParameterRow(QWidget):
    """`moved` carries the value, and whether the hand has come to rest (the slider is let go, a number is typed)."""

    moved = Signal(float, bool)
    range_changed = Signal()

    def __init__(
        self, parameter: Parameter, value: float, range: ParameterRange, is_bound: bool, parent: QWidget | None = None
    ) -> None:
        """`is_bound`: the declared least and largest value hold, and the range stays within them."""
        super().__init__(parent)
        self.parameter, self.range, self._is_bound = parameter, range, is_bound
        self.label = QLabel(self.name, self)
        self.slider = QSlider(Qt.Orientation.Horizontal, self)
        self.slider.setMinimumWidth(44)
        self.slider.setPageStep(50)
        self.number = NumberBox(self)
        self.number.setFixedWidth(80)
        self.number.setDecimals(0 if range.is_whole else 15)
        if is_bound:
            low, high = parameter.minimum, parameter.maximum
            self.number.setRange(-LARGE if low is None else low, LARGE if high is None else high)
        self.range_button = QToolButton(self)
        self.range_button.setText("…")
        self.range_button.setCheckable(True)
        self.range_button.setAutoRaise(True)
        self.range_button.setFixedWidth(20)
        self.range_button.setToolTip("The range of the slider")
        self.range_line = self._make_range_line()
        layout = QGridLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setHorizontalSpacing(5)
        layout.setVerticalSpacing(2)
        for column, widget in enumerate((self.label, self.slider, self.number, self.range_button)):
            layout.addWidget(widget, 0, column)
        layout.addWidget(self.range_line, 1, 0, 1, 4)
        layout.setColumnStretch(1, 1)
        self.label.setBuddy(self.number)
        self.setToolTip(_tip(parameter, is_bound))
        self._apply_range()
        self.show_value(value)
        for widget in (self.slider, self.number):
            widget.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
            widget.installEventFilter(self)
        self.slider.valueChanged.connect(self._slid)
        self.slider.sliderReleased.connect(lambda: self.moved.emit(self.value, True))
        self.number.valueChanged.connect(self._typed)
        self.range_button.toggled.connect(self.range_line.setVisible)

    def _make_range_line(self) -> QWidget:
        line = QWidget(self)
        self.low, self.high, self.log = QLineEdit(line), QLineEdit(line), QCheckBox("log", line)
        self.log.setToolTip("Logarithmic: for ranges of several powers of ten")
        layout = QHBoxLayout(line)
        layout.setContentsMargins(12, 0, 0, 3)
        layout.setSpacing(4)
        for widget in (QLabel("from", line), self.low, QLabel("to", line), self.high, self.log):
            layout.addWidget(widget)
        for edit in (self.low, self.high):
            edit.setMinimumWidth(40)
            edit.editingFinished.connect(self._take_range)
        self.log.toggled.connect(lambda _: self._take_range())
        line.hide()
        return line

    def set_label_width(self, width: int) -> None:
        """Of so many pixels; a longer name is cut, and whole in the tool tip."""
        self.label.setFixedWidth(width)
        self.label.setText(self.label.fontMetrics().elidedText(self.name, Qt.TextElideMode.ElideRight, width))

    @property
    def name(self) -> str:
        return self.parameter.name.replace("_", " ")

    @property
    def value(self) -> float:
        return self.number.value()

    @property
    def is_held(self) -> bool:
        """Whether the mouse has the slider."""
        return self.slider.isSliderDown()

    def show_value(self, value: float) -> None:
        """Without telling anyone."""
        if not self._is_bound and not self.range.low <= value <= self.range.high:
            self.range = self.range.with_value(value)
            self._apply_range()
        for widget in (self.slider, self.number):
            widget.blockSignals(True)
        self.slider.setValue(self.range.tick_of(value))
        self.number.setValue(value)
        for widget in (self.slider, self.number):
            widget.blockSignals(False)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:
        """A wheel that scrolls the panel changes no value on its way."""
        if event.type() == QEvent.Type.Wheel and isinstance(watched, QWidget) and not watched.hasFocus():
            event.ignore()
            return True
        return False

    # ------------------------------------------------------------------------------------------

    def _slid(self, tick: int) -> None:
        value = self.range.value_at(tick)
        self.number.blockSignals(True)
        self.number.setValue(value)
        self.number.blockSignals(False)
        self.moved.emit(self.value, not self.is_held)

    def _typed(self, value: float) -> None:
        self.show_value(value)
        self.moved.emit(self.value, True)

    def _apply_range(self) -> None:
        range = self.range
        self.slider.blockSignals(True)
        self.slider.setRange(0, range.ticks)
        self.slider.blockSignals(False)
        self.slider.setSingleStep(1 if range.is_whole else 10)
        self.number.step = range.step_from
        for edit, end in ((self.low, range.low), (self.high, range.high)):
            edit.setText(f"{end:.6g}")
        self.log.blockSignals(True)
        self.log.setChecked(range.is_log)
        self.log.blockSignals(False)
        self.log.setVisible(not range.is_whole)

    def _take_range(self) -> None:
        try:
            low, high = float(self.low.text()), float(self.high.text())
            if self._is_bound:
                low = max(low, low if self.parameter.minimum is None else self.parameter.minimum)
                high = min(high, high if self.parameter.maximum is None else self.parameter.maximum)
            if self.range.is_whole:
                low, high = float(round(low)), float(round(high))
            chosen = ParameterRange(low, high, self.log.isChecked() and not self.range.is_whole, self.range.is_whole)
        except (ValueError, OverflowError):
            self._apply_range()  # what was typed is no range: the old one stands there again
            return
        if chosen == self.range:
            return
        self.range = chosen
        self._apply_range()
        value = min(max(self.value, low), high)
        if value != self.value:
            self.number.setValue(value)
        else:
            self.show_value(value)
        self.range_changed.emit()


def _tip(item: Parameter, is_bound: bool) -> str:
    return f"{item.name}: {item.description or 'parameter'}{bounds_of(item) if is_bound else ''}"


def bounds_of(item: Parameter) -> str:
    """Between which values a parameter lies, in brackets behind what it is; empty where it has no bounds."""
    ends = (("at least", item.minimum), ("at most", item.maximum))
    bounds = [f"{words} {end:g}" for words, end in ends if end is not None]
    return f" ({', '.join(bounds)})" if bounds else ""
