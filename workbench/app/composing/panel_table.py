"""The panels of a figure in a table: which, in which order, under which caption."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import (
    QAbstractItemView,
    QHBoxLayout,
    QHeaderView,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from workbench.app.composing.offers import Offer
from workbench.figures.recipe import Panel

OFFER = int(Qt.ItemDataRole.UserRole)


class PanelTable(QWidget):
    """Ticks, captions to be edited, and buttons that move a panel; `changed` after each."""

    changed = Signal()

    def __init__(self, offers: Sequence[Offer], parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.table = QTableWidget(len(offers), 2, self)
        self.table.setHorizontalHeaderLabels(["Panel", "Caption"])
        self.table.verticalHeader().hide()
        self.table.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.table.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        header = self.table.horizontalHeader()
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        header.setSectionResizeMode(1, QHeaderView.ResizeMode.Interactive)
        header.resizeSection(1, 120)
        for row, offer in enumerate(offers):
            self._fill(row, offer)
        self.up, self.down = (QPushButton(text, self) for text in ("Move up", "Move down"))
        buttons = QHBoxLayout()
        for button, step in ((self.up, -1), (self.down, 1)):
            button.setAutoDefault(False)
            button.clicked.connect(lambda _=False, by=step: self.move_current(by))
            buttons.addWidget(button)
        buttons.addStretch(1)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self.table, 1)
        layout.addLayout(buttons)
        self.table.itemChanged.connect(lambda _: self.changed.emit())

    def _fill(self, row: int, offer: Offer) -> None:
        name = QTableWidgetItem(offer.words)
        name.setToolTip(offer.words)
        name.setFlags(Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable | Qt.ItemFlag.ItemIsUserCheckable)
        name.setCheckState(Qt.CheckState.Checked if offer.is_chosen else Qt.CheckState.Unchecked)
        name.setData(OFFER, offer)
        self.table.setItem(row, 0, name)
        self.table.setItem(row, 1, QTableWidgetItem(offer.panel.caption.strip()))

    def panels(self, *, bars: bool) -> tuple[Panel, ...]:
        """The chosen panels in their order, with colour bars or without."""
        found = []
        for row in range(self.table.rowCount()):
            name, caption = self.table.item(row, 0), self.table.item(row, 1)
            if name is not None and caption is not None and name.checkState() == Qt.CheckState.Checked:
                panel = name.data(OFFER).panel
                # a blank stands for no caption at all: nothing would be the name of the map
                found.append(replace(panel, caption=caption.text().strip() or " ", bar=panel.bar and bars))
        return tuple(found)

    def renew(self, offers: Sequence[Offer]) -> None:
        """The window shows something else now: panels that are still there are brought in line."""
        by_kind = {offer.words: offer for offer in offers}
        self.table.blockSignals(True)
        for row in range(self.table.rowCount()):
            name = self.table.item(row, 0)
            if name is not None and name.text() in by_kind:
                name.setData(OFFER, by_kind[name.text()])
        self.table.blockSignals(False)
        self.changed.emit()

    def move_current(self, by: int) -> None:
        """Change the place of the selected panel with its neighbour's."""
        row = self.table.currentRow()
        other = row + by
        if row < 0 or not 0 <= other < self.table.rowCount():
            return
        self.table.blockSignals(True)
        for column in range(2):
            one, two = self.table.takeItem(row, column), self.table.takeItem(other, column)
            self.table.setItem(row, column, two)
            self.table.setItem(other, column, one)
        self.table.setCurrentCell(other, 0)
        self.table.blockSignals(False)
        self.changed.emit()
