"""History rows in growing arrays, for curves that are drawn again and again."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import fields

import numpy as np

from workbench.core.arrays import Floats
from workbench.engine.messages import HistoryRow

COLUMNS = tuple(field.name for field in fields(HistoryRow))


class History:
    """Columns of `HistoryRow` since the last start. Appending is O(1) a row; reading copies nothing.

    A row that is told once more, as after a pause, stands there once.
    """

    def __init__(self, columns: tuple[str, ...] = COLUMNS) -> None:
        self._columns = columns
        self._table: Floats = np.empty((len(columns), 256))
        self._count = 0

    def __len__(self) -> int:
        return self._count

    def clear(self) -> None:
        self._count = 0

    def extend(self, rows: Iterable[HistoryRow]) -> None:
        for row in rows:
            if self._count == self._table.shape[1]:
                grown = np.empty((len(self._columns), 2 * self._count))
                grown[:, : self._count] = self._table
                self._table = grown
            self._table[:, self._count] = [getattr(row, name) for name in self._columns]
            is_new = not self._count or not np.array_equal(*self._table[:, self._count - 1 : self._count + 1].T, equal_nan=True)
            self._count += is_new

    def column(self, name: str) -> Floats:
        """(k,) float64, a view"""
        return self._table[self._columns.index(name), : self._count]
