"""The rows and marks of the run that leads to the present map; undo and redo bring those of their moment back."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QObject, Signal

from workbench.app.document.document import Document
from workbench.app.document.history import Curves, History
from workbench.app.document.switches import Switches
from workbench.engine.messages import HistoryRow


class RunCurves(QObject):
    """Fills history and switches from what the document takes; `begun_again` tells that they are other ones."""

    begun_again = Signal()

    def __init__(self, document: Document, history: History, switches: Switches) -> None:
        super().__init__(document)
        self._document = document
        self._history = history
        self._switches = switches
        self._returned: Curves | None = None
        document.snapshot_taken.connect(self._extend)
        document.history_restarted.connect(self._restart)
        document.curves_returned.connect(self._go_back)

    def kept(self) -> Curves:
        """Those of this moment; costs next to nothing."""
        return self._history.kept(tuple(self._switches))

    def _extend(self) -> None:
        snapshot = self._document.snapshot
        assert snapshot is not None
        rows = snapshot.rows
        if self._returned is not None:
            returned, self._returned = self._returned, None
            rows = rows_after(rows, returned.iteration, returned.seconds)
        begin = begin_of_run(rows)
        if begin >= 0:
            self._history.clear()  # another start, or what was under way when it was made anew, came before it
            rows = rows[begin:]
        self._history.extend(rows)

    def _restart(self) -> None:
        self._returned = None
        self._history.clear()
        self._switches.clear()
        self.begun_again.emit()

    def _go_back(self, curves: Curves) -> None:
        """Show those of an earlier moment; the engine goes on from its last row."""
        self._returned = curves
        self._history.go_back(curves)
        self._switches.go_back(curves.switches)
        self.begun_again.emit()


def begin_of_run(rows: Sequence[HistoryRow]) -> int:
    """Place of the newest row of a map that nothing has stepped, with which the curves begin; -1 where there is none."""
    return max((at for at, row in enumerate(rows) if row.iteration == row.seconds == 0), default=-1)


def rows_after(rows: Sequence[HistoryRow], iteration: int, seconds: float) -> Sequence[HistoryRow]:
    """Those that follow the row of the map that was taken up, which is known; before it stands what was under way."""
    found = [at for at, row in enumerate(rows) if row.iteration == iteration and row.seconds == seconds]
    return rows[found[-1] + 1 :] if found else rows
