"""The palette in the window: what it lists, and what was used lately."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt

from workbench.app.palette.collecting import entries_of
from workbench.app.palette.entry import Entry
from workbench.app.palette.palette import Palette

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow


class Commanding(QObject):
    """Opens the palette over the window and does what is chosen in it."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self.palette: Palette | None = None

    def ask(self) -> None:
        """Open the palette, or close it."""
        if self.palette is None:
            self.palette = Palette(self._window)
            self.palette.wanted.connect(self._do)
            document = self._window.document
            for signal in (document.opened, document.session_changed, self._window.quantities.listed):
                signal.connect(self._renew, Qt.ConnectionType.QueuedConnection)
        if self.palette.isVisible():
            self.palette.close_and_then()
            return
        self.palette.open(entries_of(self._window), self._window.settings.recent_commands)

    def _renew(self) -> None:
        """What can be done is something else now, while the palette is open."""
        if self.palette is not None and self.palette.isVisible():
            self.palette.renew(entries_of(self._window))

    def _do(self, entry: Entry) -> None:
        self._window.settings.remember_command(entry.key)
        entry.run()
