"""The preferences in the window: in force from its beginning, and a dialog for them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from workbench.app.preferences.applying import Applying
from workbench.app.preferences.preferences import Preferences

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow
    from workbench.app.preferences.preferences_dialog import PreferencesDialog


class Preferring(QObject):
    """One dialog at a time."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self.preferences = Preferences(window.settings, self)
        self.applying = Applying(window, self.preferences)
        self.dialog: PreferencesDialog | None = None

    def ask(self, page: str = "") -> None:
        """Open the dialog, on a page."""
        if self.dialog is None:
            from workbench.app.preferences.preferences_dialog import PreferencesDialog

            self.preferences.read_again()
            self.dialog = PreferencesDialog(self.preferences, self._window)
            self.dialog.finished.connect(self._closed)
            self._offer_methods()
            self.dialog.open()
        if page:
            self.dialog.show_page(page)
        self.dialog.raise_()

    def _offer_methods(self) -> None:
        """Distortions and solvers, where they are found by now."""
        panel, dialog = self._window.panel, self.dialog
        if dialog is None:
            return
        for name, box in (("distortion", panel.distortion.combo), ("solver", panel.solver.combo)):
            words = {box.itemData(row): box.itemText(row) for row in range(box.count()) if box.itemData(row)}
            if words:
                dialog.offer(name, words)

    def _closed(self) -> None:
        self.dialog = None

    def end(self) -> None:
        """The window is closed."""
        self.applying.end()

    def choose(self, name: str, value: object) -> None:
        """Put a preference in force and keep it, as a menu does."""
        self.preferences.set(name, value)
        if self.dialog is None:
            self.preferences.keep()
