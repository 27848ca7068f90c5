"""Edit > Linear equations: one dialog, kept while the window lives."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from workbench.app.binding.equation_dialog import EquationDialog

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow


class Binding(QObject):
    """Makes the dialog when it is asked for."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self.dialog: EquationDialog | None = None

    def ask(self) -> None:
        settings = self._window.settings
        if self.dialog is None:
            self.dialog = EquationDialog(self._window.document, settings.folder, self._window)
            self.dialog.folder_used.connect(lambda folder: setattr(settings, "folder", folder))
        self.dialog.show()
        self.dialog.raise_()
