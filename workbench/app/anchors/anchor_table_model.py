"""The anchors of the window as rows of a Qt table; sorted here, by whole arrays, so that many are no trouble."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from PySide6.QtCore import QAbstractTableModel, QModelIndex, QObject, QPersistentModelIndex, Qt, Signal

from workbench.app.anchors.anchor_columns import Column, columns_for
from workbench.app.anchors.anchor_edits import table_of
from workbench.app.document.anchor_set import AnchorSet
from workbench.core.arrays import Floats, Integers
from workbench.io.anchor_rows import AXES, AnchorTable, columns_of, text_of

Index = QModelIndex | QPersistentModelIndex
Role = Qt.ItemDataRole
NOWHERE = QModelIndex()
RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter


class AnchorTableModel(QAbstractTableModel):
    """Rows are anchors, in the order of the column that was sorted by last.

    A row keeps its place while it is edited; only a sort, or another set of vertices, moves it.
    """

    edited = Signal(int, str, str)
    """A cell was given another value: its row, the key of its column, the text. Whoever listens changes the anchors."""

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.columns: tuple[Column, ...] = columns_for(2, 2)
        self._sources: Floats = np.empty((0, 2))
        self._dimension = 2
        self._anchors = AnchorSet.none()
        self._table = table_of(self._anchors, 2)
        self._residuals: Floats = np.empty(0)
        self._order: Integers = np.empty(0, np.int64)
        self._sorted_by: tuple[str, bool] = ("", False)

    # ------------------------------------------------------------------------------------------ what it shows

    def show_mesh(self, sources: Floats, dimension: int) -> None:
        """Another source (n, d) and maps of `dimension` columns; without anchors at first."""
        self.beginResetModel()
        self._sources, self._dimension = sources, dimension
        self.columns = columns_for(sources.shape[1], dimension)
        self._take(AnchorSet.none())
        self.endResetModel()

    def show_anchors(self, anchors: AnchorSet) -> None:
        """Other anchors; where their vertices are the same ones, every row stays in its place."""
        if anchors is self._anchors:
            return
        if list(anchors.targets) == list(self._anchors.targets):
            order = self._order
            self._take(anchors)
            self._order = order
            self._tell_changed(0, len(self.columns) - 1)
        else:
            self.beginResetModel()
            self._take(anchors)
            self._sort()
            self.endResetModel()

    def _take(self, anchors: AnchorSet) -> None:
        if len(self._residuals) != len(anchors) or list(anchors.targets) != list(self._anchors.targets):
            self._residuals = np.full(len(anchors), np.nan)
        self._anchors = anchors
        self._table = table_of(anchors, self._dimension)
        self._order = np.arange(len(anchors))

    def show_positions(self, positions: Floats) -> None:
        """The map (n, d) from which the targets are so far."""
        table = self._table
        if len(table.vertices) and positions.shape[1] == table.targets.shape[1]:
            self._residuals = np.linalg.norm(positions[table.vertices] - table.targets, axis=1)
            place = self.place_of("residual")
            self._tell_changed(place, place)

    def _tell_changed(self, first: int, last: int) -> None:
        if len(self._order):
            self.dataChanged.emit(self.index(0, first), self.index(len(self._order) - 1, last))

    @property
    def residual_summary(self) -> tuple[float, float]:
        """Largest residual of those that are on, and the root of the mean square; NaN without any."""
        held = self._residuals[~self._table.is_off]
        held = held[np.isfinite(held)]
        if not len(held):
            return math.nan, math.nan
        return float(held.max()), float(np.sqrt(np.mean(held**2)))

    # ------------------------------------------------------------------------------------------ rows and vertices

    def vertices_in(self, rows: Integers) -> Integers:
        """(k,) vertices of some rows (k,)."""
        return self._table.vertices[self._order[rows]]

    def rows_of(self, vertices: Integers) -> Integers:
        """(k,) rows of those of `vertices` that have one, ascending."""
        return np.flatnonzero(np.isin(self._table.vertices[self._order], vertices))

    def place_of(self, key: str) -> int:
        """Place of a column."""
        return next(place for place, column in enumerate(self.columns) if column.key == key)

    def text_of_rows(self, rows: Integers) -> str:
        """Some rows with a header, parted by tabs, as they are pasted back to the same anchors."""
        chosen = self._order[rows]
        table = self._table
        columns = columns_of(
            AnchorTable(
                table.vertices[chosen], table.targets[chosen], table.weights[chosen], table.groups[chosen], table.is_off[chosen]
            ),
            whole=True,
        )
        for axis, values in zip(AXES, self._sources[table.vertices[chosen]].T, strict=False):
            columns[f"source_{axis}"] = list(map(repr, values.tolist()))
        columns["residual"] = [f"{value:.6g}" for value in self._residuals[chosen].tolist()]
        return text_of(columns, "\t")

    # ------------------------------------------------------------------------------------------ sorting

    def sort(self, column: int, order: Qt.SortOrder = Qt.SortOrder.AscendingOrder) -> None:
        """By one column; rows that are equal in it stay as they were set. Column -1: as they were set."""
        key = self.columns[column].key if 0 <= column < len(self.columns) else ""
        self._sorted_by = key, order == Qt.SortOrder.DescendingOrder
        self.beginResetModel()
        self._sort()
        self.endResetModel()

    def _sort(self) -> None:
        key, is_descending = self._sorted_by
        if not key:
            self._order = np.arange(len(self._anchors))
            return
        values = self._values(key)
        self._order = np.argsort(-values if is_descending else values, kind="stable")  # NaN stands last

    def _values(self, key: str) -> Floats:
        """(k,) what a column is sorted by."""
        table = self._table
        if key.startswith("source_"):
            return self._sources[table.vertices, AXES.index(key[-1])]
        if key in AXES:
            return table.targets[:, AXES.index(key)]
        found = {"on": table.is_off, "vertex": table.vertices, "weight": table.weights, "group": table.groups}
        return np.asarray(found.get(key, self._residuals), dtype=np.float64)

    # ------------------------------------------------------------------------------------------ Qt's side

    def rowCount(self, parent: Index = NOWHERE) -> int:
        return 0 if parent.isValid() else len(self._order)

    def columnCount(self, parent: Index = NOWHERE) -> int:
        return 0 if parent.isValid() else len(self.columns)

    def headerData(self, section: int, orientation: Qt.Orientation, role: int = Role.DisplayRole) -> Any:
        if orientation == Qt.Orientation.Horizontal and 0 <= section < len(self.columns):
            column = self.columns[section]
            return {Role.DisplayRole: column.title, Role.ToolTipRole: column.tip}.get(Role(role))
        return None

    def flags(self, index: Index) -> Qt.ItemFlag:
        flags = Qt.ItemFlag.ItemIsEnabled | Qt.ItemFlag.ItemIsSelectable
        column = self.columns[index.column()]
        if column.key == "on":
            return flags | Qt.ItemFlag.ItemIsUserCheckable
        return flags | Qt.ItemFlag.ItemIsEditable if column.is_editable else flags

    def data(self, index: Index, role: int = Role.DisplayRole) -> Any:
        if not index.isValid() or index.row() >= len(self._order):
            return None
        key, item = self.columns[index.column()].key, int(self._order[index.row()])
        if role == Role.TextAlignmentRole:
            return RIGHT
        if role == Role.ToolTipRole:
            return self._words(key, item, "{!r}") or self.columns[index.column()].tip
        if role == Role.CheckStateRole and key == "on":
            return Qt.CheckState.Unchecked if self._table.is_off[item] else Qt.CheckState.Checked
        if role == Role.DisplayRole:
            return self._words(key, item, "{:.5g}")
        if role == Role.EditRole:
            return self._words(key, item, "{!r}")
        return None

    def is_off(self, row: int) -> bool:
        """Whether the anchor of a row holds nothing."""
        return bool(self._table.is_off[self._order[row]])

    def _words(self, key: str, item: int, form: str) -> str:
        table = self._table
        if key == "on":
            return ""
        if key == "vertex":
            return str(table.vertices[item])
        if key == "group":
            return str(table.groups[item]) if table.groups[item] >= 0 else ""
        value = float(self._values_at(key, item))
        if key == "weight" and math.isinf(value):
            return "hard"
        return (form if key != "residual" else "{:.3g}").format(value) if math.isfinite(value) else ""

    def _values_at(self, key: str, item: int) -> float:
        table = self._table
        if key.startswith("source_"):
            return float(self._sources[table.vertices[item], AXES.index(key[-1])])
        if key in AXES:
            return float(table.targets[item, AXES.index(key)])
        return float(table.weights[item] if key == "weight" else self._residuals[item])

    def setData(self, index: Index, value: Any, role: int = Role.EditRole) -> bool:
        key = self.columns[index.column()].key
        if role == Role.CheckStateRole and key == "on":
            self.edited.emit(index.row(), key, "on" if Qt.CheckState(value) == Qt.CheckState.Checked else "off")
            return True
        if role != Role.EditRole or str(value) == self.data(index, Role.EditRole):
            return False
        self.edited.emit(index.row(), key, str(value))
        return True
