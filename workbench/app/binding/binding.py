"""Edit > Linear equations: one dialog, kept while the window lives."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from workbench.app.binding.equation_dialog import FILTER, EquationDialog
from workbench.app.files.new_file import endings_of

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow


class Binding(QObject):
    """Makes the dialog when it is asked for."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self.dialog: EquationDialog | None = None

    def ask(self) -> None:
        if self.dialog is None:
            self.dialog = EquationDialog(self._window.document, self._window)
        self.dialog.show()
        self.dialog.raise_()

    def takes(self, path: str) -> bool:
        """Whether a file is one of equations by its ending."""
        return Path(path).suffix.lower() in endings_of(FILTER)

    def open(self, path: str) -> None:
        """Show the dialog with the equations of a file."""
        self.ask()
        assert self.dialog is not None
        self.dialog.open(path)
