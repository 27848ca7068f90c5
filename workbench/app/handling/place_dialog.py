"""Anchors by numbers: where their centre is to be, and how far they are to turn."""

from __future__ import annotations

import math

import numpy as np
from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QDialog, QDialogButtonBox, QFormLayout, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from workbench.app.handling.rigid_motion import RigidMotion
from workbench.app.panels.number_box import NumberBox
from workbench.core.arrays import Floats, Integers


class PlaceDialog(QDialog):
    """Coordinates of one anchor, or of the centre of a group, and a turn of the group about an axis through it.

    `motion_wanted(motion)` : from where the anchors are now
    """

    motion_wanted = Signal(object)

    def __init__(self, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self._centre: Floats = np.zeros(3)
        self._shown: list[str] = []
        layout = QVBoxLayout(self)
        form = QFormLayout()
        layout.addLayout(form)
        self.places = [NumberBox(self) for _ in "xyz"]
        self._labels = [QLabel(name, self) for name in "xyz"]
        for label, box in zip(self._labels, self.places, strict=True):
            box.setMinimumWidth(140)
            form.addRow(label, box)
        self.angle = NumberBox(self)
        self.angle.setSuffix("°")
        self.angle.step = lambda value, count: value + 15.0 * count
        self.angle.setToolTip("More than 360° goes round more than once; the map follows all the way.")
        self.axis = QComboBox(self)
        for name in "xyz":
            self.axis.addItem(f"about {name}", name)
        self._turn = QWidget(self)
        row = QHBoxLayout(self._turn)
        row.setContentsMargins(0, 0, 0, 0)
        row.addWidget(self.angle, 1)
        row.addWidget(self.axis)
        self._turn_label = QLabel("turn by", self)
        form.addRow(self._turn_label, self._turn)
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Apply | QDialogButtonBox.StandardButton.Close, self)
        apply = buttons.button(QDialogButtonBox.StandardButton.Apply)
        apply.setDefault(True)
        apply.clicked.connect(self.apply)
        buttons.rejected.connect(self.reject)
        layout.addWidget(buttons)

    def show_anchors(self, vertices: Integers, targets: Floats) -> None:
        """Show these (k,) with their targets (k, d)."""
        count, d = targets.shape
        self.setWindowTitle(f"Place {count} anchors" if count > 1 else f"Place vertex {vertices[0]}")
        self._centre = np.zeros(3)
        self._centre[:d] = targets.mean(axis=0)
        for row, (label, box) in enumerate(zip(self._labels, self.places, strict=True)):
            box.setValue(float(self._centre[row]))
            label.setText(f"centre {'xyz'[row]}" if count > 1 else "xyz"[row])
            label.setVisible(row < d)
            box.setVisible(row < d)
        self._shown = [box.text() for box in self.places]
        self.angle.setValue(0.0)
        for widget in (self._turn_label, self._turn):
            widget.setVisible(count > 1)
        self.axis.setVisible(d == 3)
        if d == 2:
            self.axis.setCurrentIndex(2)
        self.adjustSize()

    def apply(self) -> None:
        """Ask for the motion; boxes that nobody touched move nothing, though they show fewer digits than there are."""
        boxes = zip(self.places, self._shown, self._centre.tolist(), strict=True)
        shift = np.array([box.value() - was if box.text() != shown else 0.0 for box, shown, was in boxes])
        axis = np.eye(3)[self.axis.currentIndex()]
        self.motion_wanted.emit(RigidMotion(shift, math.radians(self.angle.value()) * axis, self._centre))
