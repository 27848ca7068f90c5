"""How the pattern lies: its size, its turn, whether in the map or in the source, and the picture."""

from __future__ import annotations

import math
from pathlib import Path

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import (
    QComboBox,
    QDialog,
    QDoubleSpinBox,
    QFormLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QSlider,
    QVBoxLayout,
    QWidget,
)

from workbench.app.texturing.texturing import LARGEST, PatternLayout, Texturing

STEPS = 100
PLACES = {
    "the map, fitted to it": {"of_source": False, "of_unit": False},
    "the map, pictures by u and v from 0 to 1": {"of_source": False, "of_unit": True},
    "the source": {"of_source": True, "of_unit": False},
}


class PatternDialog(QDialog):
    """Every change is seen at once; `picture_wanted` asks for a file."""

    picture_wanted = Signal()

    def __init__(self, texturing: Texturing, parent: QWidget) -> None:
        super().__init__(parent)
        self.setWindowTitle("Pattern")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._texturing = texturing
        self.size_slider = QSlider(Qt.Orientation.Horizontal, self)
        self.size_slider.setRange(0, STEPS)
        self.size_slider.setToolTip("Size of a tile, or of the picture; in the middle it is the usual one")
        self.size_slider.valueChanged.connect(lambda value: texturing.choose(size=size_at(value / STEPS)))
        self.degrees = QDoubleSpinBox(self)
        self.degrees.setRange(-360.0, 360.0)
        self.degrees.setSingleStep(5.0)
        self.degrees.setDecimals(1)
        self.degrees.setSuffix("°")
        self.degrees.setToolTip("By how much the pattern is turned, counter-clockwise")
        self.degrees.valueChanged.connect(lambda value: texturing.choose(degrees=value))
        self.place = QComboBox(self)
        self.place.addItems(list(PLACES))
        self.place.setToolTip(
            "Where the pattern is even; the other view shows what the map makes of it. Surfaces in space have it in the map."
        )
        self.place.activated.connect(lambda _: texturing.choose(**PLACES[self.place.currentText()]))
        self.picture = QLabel("", self)
        choose = QPushButton("Choose…", self)
        choose.setToolTip("A PNG or JPEG; it can also be dropped on a view")
        choose.setAutoDefault(False)
        choose.clicked.connect(lambda _=False: self.picture_wanted.emit())
        row = QHBoxLayout()
        row.addWidget(self.picture, 1)
        row.addWidget(choose)
        form = QFormLayout()
        form.addRow("Size", self.size_slider)
        form.addRow("Turned by", self.degrees)
        form.addRow("Even in", self.place)
        form.addRow("Picture", row)
        reset = QPushButton("Usual", self)
        reset.setToolTip("The usual size, not turned, even in the map")
        reset.setAutoDefault(False)
        reset.clicked.connect(lambda _=False: texturing.choose(size=1.0, degrees=0.0, of_source=False, of_unit=False))
        layout = QVBoxLayout(self)
        layout.addLayout(form)
        layout.addWidget(reset, 0, Qt.AlignmentFlag.AlignRight)
        self.setMinimumWidth(340)
        texturing.changed.connect(self.show_layout)
        self.show_layout()

    def show_layout(self) -> None:
        """Take up what is chosen, wherever that was done."""
        layout = self._texturing.layout
        with QSignalBlocker(self.size_slider), QSignalBlocker(self.degrees), QSignalBlocker(self.place):
            self.size_slider.setValue(round(STEPS * share_of(layout.size)))
            self.degrees.setValue(layout.degrees)
            self.place.setCurrentIndex(place_of(layout))
        self.picture.setText(Path(layout.picture).name if self._texturing.has_picture else "none yet")
        self.picture.setToolTip(layout.picture)


def place_of(layout: PatternLayout) -> int:
    """The row of the choice of where a pattern is even."""
    return 2 if layout.of_source else int(layout.of_unit)


def size_at(share: float) -> float:
    """The factor at a part of the slider; equal ways are equal factors, and its middle is exactly 1."""
    return LARGEST ** (2.0 * share - 1.0)


def share_of(size: float) -> float:
    """Where a factor stands on the slider."""
    return 0.5 + 0.5 * math.log(size) / math.log(LARGEST)
