"""The time axis of a race: a slider that moves all views back and forth, and the way back to now."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QCheckBox, QComboBox, QHBoxLayout, QLabel, QPushButton, QSlider, QWidget

from workbench.app.race.race_model import RaceModel
from workbench.engine.race_messages import Axis

TICKS = 2000
NAMES: dict[Axis, str] = {"iteration": "iterations", "seconds": "seconds"}


class Timeline(QWidget):
    """Axis, slider, where it stands, and the scales of the curves."""

    axis_chosen = Signal(str)
    scale_chosen = Signal(str, bool)

    def __init__(self, model: RaceModel, parent: QWidget) -> None:
        super().__init__(parent)
        self._model = model
        layout = QHBoxLayout(self)
        layout.setContentsMargins(8, 3, 8, 3)
        layout.setSpacing(8)
        self.axis = QComboBox(self)
        for axis, name in NAMES.items():
            self.axis.addItem(name, axis)
        self.axis.setToolTip("What curves and slider go over")
        self.slider = QSlider(Qt.Orientation.Horizontal, self)
        self.slider.setRange(0, TICKS)
        self.slider.setValue(TICKS)
        self.slider.setToolTip(
            "Moves all views back and forth in time; the race goes on meanwhile.\n"
            "Keys left and right: by one iteration, with Shift by ten"
        )
        self.place = QLabel(self)
        self.place.setMinimumWidth(self.fontMetrics().horizontalAdvance("iteration 00000") + 6)
        self.live = QPushButton("Live", self)
        self.live.setCheckable(True)
        self.live.setChecked(True)
        self.live.setToolTip("Follow the newest maps (L)")
        layout.addWidget(QLabel("over", self))
        layout.addWidget(self.axis)
        layout.addWidget(self.slider, 1)
        layout.addWidget(self.place)
        layout.addWidget(self.live)
        self.scales: dict[str, QCheckBox] = {}
        for side, text in (("x", "log x"), ("y", "log y")):
            box = self.scales[side] = QCheckBox(text, self)
            box.setChecked(side == "y")
            box.toggled.connect(lambda on, s=side: self.scale_chosen.emit(s, on))
            layout.addWidget(box)
        self.slider.valueChanged.connect(self._moved)
        self.live.clicked.connect(lambda _: model.go_live())
        self.axis.currentIndexChanged.connect(self._axis_changed)
        model.told.connect(lambda _: self.show_place())
        model.seek_changed.connect(self.show_place)
        model.started.connect(self.show_place)
        self.show_place()

    @property
    def chosen_axis(self) -> Axis:
        return "seconds" if self.axis.currentData() == "seconds" else "iteration"

    def move(self, count: int) -> None:
        """So many iterations forth, or back where negative; of the seconds as many hundredths."""
        axis, end = self.chosen_axis, self._model.end_of(self.chosen_axis)
        place = (end if self._model.is_live else self._model.seek.place) + count * (1.0 if axis == "iteration" else 0.01 * end)
        if place >= end:
            self._model.go_live()
        else:
            self._model.seek_to(axis, max(round(place) if axis == "iteration" else place, 0))

    def _axis_changed(self) -> None:
        self._model.go_live()
        self.axis_chosen.emit(self.chosen_axis)
        self.show_place()

    def _moved(self, tick: int) -> None:
        end = self._model.end_of(self.chosen_axis)
        place = end * tick / TICKS
        if tick == TICKS:
            self._model.go_live()
        else:
            self._model.seek_to(self.chosen_axis, round(place) if self.chosen_axis == "iteration" else place)

    def show_place(self) -> None:
        """Bring slider and words in line with what is shown: the axis may have grown."""
        axis, seek = self.chosen_axis, self._model.seek
        end = self._model.end_of(axis)
        place = end if self._model.is_live else min(seek.place, end)
        self.live.setChecked(self._model.is_live)
        self.place.setText(f"iteration {place:.0f}" if axis == "iteration" else f"{place:.2f} s")
        if not self.slider.isSliderDown():
            self.slider.blockSignals(True)
            self.slider.setValue(TICKS if self._model.is_live else round(TICKS * place / end) if end else 0)
            self.slider.blockSignals(False)
