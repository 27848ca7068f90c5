"""Help > Cite what this session uses."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt

from workbench.app.files.new_file import stem_of
from workbench.core.errors import WorkbenchError
from workbench.io.atomic import write_text

if TYPE_CHECKING:
    from workbench.app.citing.citation_dialog import CitationDialog
    from workbench.app.main_window import MainWindow


class Citing(QObject):
    """One dialog, made anew each time it is asked for: the session is another by then."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self.dialog: CitationDialog | None = None

    def ask(self) -> None:
        """Show what to cite for the session as it is now, and for the legs that led to its map."""
        window = self._window
        desk, loaded = window.sessions.desk, window.document.loaded
        from workbench.app.citing.citation_dialog import CitationDialog
        from workbench.engine.citing import cited_in

        methods = cited_in(desk.record(), loaded.kind) if desk.has_something and loaded is not None else ()
        stem = stem_of(window.document.session.source) or "workbench"
        if self.dialog is not None:
            self.dialog.close()
        dialog = self.dialog = CitationDialog(methods, window.settings.folder, stem, window)
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.finished.connect(self._forget)
        dialog.save_wanted.connect(self.save)
        dialog.show()

    def _forget(self) -> None:
        self.dialog = None

    def save(self, path: str) -> None:
        """Write the bibliography of the dialog."""
        window = self._window
        if self.dialog is None:
            return
        window.settings.folder = str(Path(path).parent)
        try:
            write_text(path, self.dialog.text.toPlainText())
        except WorkbenchError as error:
            window.error_bar.show_message(error.sentence)
            return
        window.status.say(f"Saved {path}.")
