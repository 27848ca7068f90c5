"""What becomes of a fault: the first from one place is shown, those that follow are counted."""

from __future__ import annotations

from collections.abc import Hashable
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt

from workbench.app.faults.fault import Fault, fault_of

if TYPE_CHECKING:
    from workbench.app.faults.fault_dialog import FaultDialog
    from workbench.app.main_window import MainWindow

MOST_PLACES = 50
"""Places of faults that are told apart; more of them are one."""


class FaultDesk(QObject):
    """Shows faults in one dialog. A place that a dialog has told of already opens no second one: the bar counts on."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._known: set[Hashable] = set()
        self.dialog: FaultDialog | None = None

    def take(self, error: BaseException, where: str = "") -> None:
        """An exception that nobody caught, from the thread `where` (empty: the window's)."""
        fault = fault_of(error, where)
        if self.dialog is not None:
            self.dialog.add(fault)
        elif fault.key in self._known or len(self._known) >= MOST_PLACES:
            self._window.error_bar.show_message(f"Once more: {fault.sentence}", details=fault.details)
        else:
            self._open(fault)
        self._known.add(fault.key)

    def tell_of_last_time(self, text: str) -> None:
        """What an earlier process left that a fault ended: where it was, from Python's own fault handler."""
        self._window.error_bar.show_message(
            "The program or its engine was ended by a fault last time, inside a library. The log has the details, too.",
            details=text,
        )

    def close(self) -> None:
        """The window goes, and the dialog with it."""
        if self.dialog is not None:
            self.dialog.close()

    def _open(self, fault: Fault) -> None:
        from workbench.app.faults.fault_dialog import FaultDialog  # late: it is hardly ever needed

        window = self._window
        self.dialog = FaultDialog(window)
        self.dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.dialog.add(fault)
        self.dialog.save_wanted.connect(window.sessions.save)
        self.dialog.close_wanted.connect(window.close)
        self.dialog.finished.connect(self._forget)
        self.dialog.show()

    def _forget(self) -> None:
        self.dialog = None
