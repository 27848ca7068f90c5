"""Two contestants against each other: flipped in place, or as a difference."""

from __future__ import annotations

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QHBoxLayout, QLabel, QPushButton, QWidget

from workbench.app.quantities.quantity_book import QuantityBook
from workbench.app.quantities.quantity_chooser import QuantityChooser
from workbench.app.race.race_model import RaceModel

MODES = {
    "own": "each by itself",
    "displacement": "displacement from A",
    "difference": "difference of it to A",
}


class CompareBar(QWidget):
    """Quantity, mode, A and B; `flipped` tells whether the two stand in each other's place."""

    mode_chosen = Signal(str, int)
    flipped = Signal(int, int, bool)

    def __init__(self, model: RaceModel, book: QuantityBook, quantity: str, parent: QWidget) -> None:
        super().__init__(parent)
        self._model = model
        self._is_held = False
        layout = QHBoxLayout(self)
        layout.setContentsMargins(8, 3, 8, 3)
        layout.setSpacing(6)
        self.chooser = QuantityChooser(book, quantity, parent=self)
        self.chooser.setMinimumContentsLength(22)
        self.mode = QComboBox(self)
        for id, text in MODES.items():
            self.mode.addItem(text, id)
        self.first, self.second = QComboBox(self), QComboBox(self)
        for box in (self.first, self.second):
            box.setSizeAdjustPolicy(QComboBox.SizeAdjustPolicy.AdjustToMinimumContentsLengthWithIcon)
            box.setMinimumContentsLength(12)
            box.currentIndexChanged.connect(lambda _: self._changed())
        self.mode.currentIndexChanged.connect(lambda _: self._changed())
        self.mode.setToolTip("Colours of the views: the quantity on each map, or how each map differs from that of A")
        self.flip_button = QPushButton("Flip", self)
        self.flip_button.setCheckable(True)
        self.flip_button.setToolTip("A and B change places (X); hold Y for a moment's look")
        self.flip_button.toggled.connect(lambda _: self._flip())
        for widget in (QLabel("Colour by", self), self.chooser, self.mode):
            layout.addWidget(widget)
        layout.addStretch(1)
        for widget in (QLabel("A", self), self.first, QLabel("B", self), self.second, self.flip_button):
            layout.addWidget(widget)
        self.list_contestants()

    def list_contestants(self) -> None:
        """Others take part now."""
        labels = [record.label for record in self._model.records]
        for place, box in enumerate((self.first, self.second)):
            box.blockSignals(True)
            box.clear()
            box.addItems(labels)
            box.setCurrentIndex(min(place, len(labels) - 1))
            for row, label in enumerate(labels):
                box.setItemData(row, label, Qt.ItemDataRole.ToolTipRole)
            box.blockSignals(False)
        self.flip_button.setChecked(False)
        self._changed()

    @property
    def boxes(self) -> tuple[QComboBox, ...]:
        return self.chooser, self.mode, self.first, self.second

    @property
    def pair(self) -> tuple[int, int]:
        return max(self.first.currentIndex(), 0), max(self.second.currentIndex(), 0)

    @property
    def is_flipped(self) -> bool:
        return self.flip_button.isChecked() != self._is_held

    def hold(self, is_held: bool) -> None:
        """While a key is held the two stand the other way round."""
        if is_held != self._is_held:
            self._is_held = is_held
            self._flip()

    def _changed(self) -> None:
        self.mode_chosen.emit(str(self.mode.currentData()), self.pair[0])
        self._flip()

    def _flip(self) -> None:
        first, second = self.pair
        self.flipped.emit(first, second, self.is_flipped and first != second)
