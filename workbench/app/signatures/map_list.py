"""The maps that are compared: named, coloured, removed in a table."""

from __future__ import annotations

from dataclasses import dataclass, replace

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor, QPixmap
from PySide6.QtWidgets import QAbstractItemView, QColorDialog, QHeaderView, QTableWidget, QTableWidgetItem, QWidget

from workbench.core.signature import Signature

COLOURS = ("#1f6feb", "#d9480f", "#2b8a3e", "#9c36b5", "#c2255c", "#0b7285", "#8a6d00", "#846358")
"""Told apart on a light and on a dark background; the ninth map begins again."""


@dataclass(frozen=True, eq=False)
class ComparedMap:
    """One map: its signature at its own scale, and the colour of its curve."""

    signature: Signature
    colour: QColor


class MapList(QTableWidget):
    """One row a map; `changed` tells that there are others, `repainted` that only names or colours differ."""

    changed = Signal()
    repainted = Signal()

    def __init__(self, parent: QWidget) -> None:
        super().__init__(0, 3, parent)
        self.maps: list[ComparedMap] = []
        self._next_colour = 0
        self.setHorizontalHeaderLabels(["map", "mean", "simplices"])
        self.verticalHeader().hide()
        self.setSelectionBehavior(QAbstractItemView.SelectionBehavior.SelectRows)
        self.horizontalHeader().setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        for column in (1, 2):
            self.horizontalHeader().setSectionResizeMode(column, QHeaderView.ResizeMode.ResizeToContents)
        self.setToolTip("Double click a name to change it; double click the mean to choose another colour.")
        self.itemChanged.connect(self._renamed)
        self.cellDoubleClicked.connect(self._ask_colour)

    def add(self, signature: Signature) -> None:
        """One more map; a name that is taken gets a number."""
        colour = QColor(COLOURS[self._next_colour % len(COLOURS)])
        self._next_colour += 1
        name = self._free_name(signature.name, -1)
        self.maps.append(ComparedMap(signature.named(name), colour))
        self._fill()
        self.changed.emit()

    def remove_selected(self) -> None:
        """Forget the maps of the selected rows."""
        rows = {index.row() for index in self.selectionModel().selectedRows()}
        if rows:
            self.maps = [item for row, item in enumerate(self.maps) if row not in rows]
            self._fill()
            self.changed.emit()

    def set_colour(self, row: int, colour: QColor) -> None:
        if colour.isValid():
            self.maps[row] = replace(self.maps[row], colour=colour)
            self._fill()
            self.repainted.emit()

    def _free_name(self, name: str, own_row: int) -> str:
        taken = {item.signature.name for row, item in enumerate(self.maps) if row != own_row}
        free, number = name, 2
        while free in taken:
            free, number = f"{name} ({number})", number + 1
        return free

    def _fill(self) -> None:
        self.blockSignals(True)
        self.setRowCount(len(self.maps))
        for row, item in enumerate(self.maps):
            swatch = QPixmap(14, 14)
            swatch.fill(item.colour)
            name = QTableWidgetItem(swatch, item.signature.name)
            cells = [name, QTableWidgetItem(f"{item.signature.mean:.4g}"), QTableWidgetItem(str(len(item.signature.values)))]
            for column, cell in enumerate(cells):
                if column:
                    cell.setFlags(cell.flags() & ~Qt.ItemFlag.ItemIsEditable)
                    cell.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
                self.setItem(row, column, cell)
        self.blockSignals(False)

    def _renamed(self, cell: QTableWidgetItem) -> None:
        row = cell.row()
        old = self.maps[row]
        name = self._free_name(cell.text().strip() or old.signature.name, row)
        self.maps[row] = replace(old, signature=old.signature.named(name))
        self._fill()
        self.changed.emit()

    def _ask_colour(self, row: int, column: int) -> None:
        if column == 0:
            return
        dialog = QColorDialog(self.maps[row].colour, self)
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.colorSelected.connect(lambda colour: self.set_colour(row, colour))
        dialog.open()
