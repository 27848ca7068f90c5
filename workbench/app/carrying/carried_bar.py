"""Below the target: what the colours of a carried surface mean, and how much of the solid round it is to be seen."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QSlider, QToolButton, QVBoxLayout, QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.colouring.colour_legend import ColourLegend
from workbench.app.colouring.colour_range import ColourRange
from workbench.app.quantities.quantities import Quantity
from workbench.app.status.status_line import ElidedLabel

STEPS = 100
FIRST_OPACITY = 0.25


class CarriedBar(QWidget):
    """Name of the surface, a slider for the solid, a button to let the surface go; its colour bar below."""

    opacity_chosen = Signal(float)
    quantity_chosen = Signal(str)
    dismissed = Signal()

    def __init__(self, quantities: Sequence[Quantity], colour_range: ColourRange, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        outer = QVBoxLayout(self)
        outer.setContentsMargins(0, 0, 0, 0)
        outer.setSpacing(0)
        row = QHBoxLayout()
        row.setContentsMargins(10, 3, 6, 3)
        row.setSpacing(6)
        title = QLabel("<b>Carried</b>", self)
        title.setToolTip("A surface that goes with the solid (Fig. 8), coloured by the distortion of its own map.")
        row.addWidget(title)
        self.caption = ElidedLabel("", self)
        self.caption.setObjectName("citation")
        self.caption.setMinimumWidth(10)
        row.addWidget(self.caption, 1)
        self.chooser = QComboBox(self)
        for quantity in quantities:
            self.chooser.addItem(quantity.title, quantity.id)
            self.chooser.setItemData(self.chooser.count() - 1, quantity.formula, Qt.ItemDataRole.ToolTipRole)
        self.chooser.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
        self.chooser.setMinimumContentsLength(16)
        self.chooser.setMinimumWidth(80)  # in a small window it gives way
        self.chooser.setToolTip("What the colours of the carried surface stand for")
        self.chooser.currentIndexChanged.connect(lambda _: self.quantity_chosen.emit(self.chooser.currentData()))
        row.addWidget(self.chooser)
        row.addWidget(QLabel("Solid", self))
        self.opacity = QSlider(Qt.Orientation.Horizontal, self)
        self.opacity.setToolTip("How much of the solid is to be seen round the surface.")
        self.opacity.setRange(0, STEPS)
        self.opacity.setValue(round(FIRST_OPACITY * STEPS))
        self.opacity.setMinimumWidth(30)
        self.opacity.setMaximumWidth(90)
        self.opacity.valueChanged.connect(lambda value: self.opacity_chosen.emit(value / STEPS))
        row.addWidget(self.opacity)
        close = QToolButton(self)
        close.setText("✕")
        close.setToolTip("Let the surface go")
        close.setAutoRaise(True)
        close.clicked.connect(self.dismissed)
        row.addWidget(close)
        outer.addLayout(row)
        self.legend = ColourLegend(colour_range, self)
        outer.addWidget(self.legend)
        self.hide()

    def set_theme(self, theme: Theme) -> None:
        self.legend.set_theme(theme)
