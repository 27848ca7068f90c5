"""History rows in growing arrays, for curves that are drawn again and again."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Floats
from workbench.engine.messages import HistoryRow

if TYPE_CHECKING:
    from workbench.app.document.switches import Switch

COLUMNS = tuple(field.name for field in fields(HistoryRow))


@dataclass(frozen=True, eq=False)
class Curves:
    """The rows of a run up to a moment, and what was switched until then.

    `table` (columns, at least count) is shared with the history, which only ever writes behind the rows that it has told.
    """

    table: Floats
    count: int
    switches: tuple[Switch, ...] = ()

    @property
    def iteration(self) -> int:
        """Of the last row; 0 where there is none."""
        return int(self._last("iteration"))

    @property
    def seconds(self) -> float:
        return self._last("seconds")

    def _last(self, name: str) -> float:
        return float(self.table[COLUMNS.index(name), self.count - 1]) if self.count else 0.0


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
        self._table, self._count = np.empty((len(self._columns), 256)), 0  # another table: moments keep the old one

    def kept(self, switches: tuple[Switch, ...] = ()) -> Curves:
        """The rows as they are now, however the history goes on."""
        return Curves(self._table, self._count, switches)

    def go_back(self, curves: Curves) -> None:
        """Go on from the rows of an earlier moment; what followed them there stays with whoever keeps it."""
        self._table, self._count = curves.table.copy(), curves.count

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
