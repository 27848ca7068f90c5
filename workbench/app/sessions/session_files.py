"""Session files in the window: dialogs, recent ones, the title, and the question before something is lost."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Qt
from PySide6.QtWidgets import QMenu, QMessageBox

from workbench.app.files.file_choice import ask_file
from workbench.app.files.new_file import ask_new_file, stem_of
from workbench.app.sessions.session_desk import FILTERS, Found, SessionDesk
from workbench.app.status.reporter import source_name
from workbench.core.errors import WorkbenchError
from workbench.engine.session_file import ENDING, carries_session, is_session_file

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

Buttons = QMessageBox.StandardButton


class SessionFiles(QObject):
    """What the File menu does with sessions; dialogs open without stopping the event loop."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._closes_after_save = False
        self._may_close = False
        self.desk = SessionDesk(window.document)
        self.desk.said.connect(lambda sentence: window.status.say(sentence))
        self.desk.failed.connect(self._failed)
        self.desk.changed.connect(self.show_title)
        self.desk.mesh_wanted.connect(self._ask_for_mesh)
        self.desk.saved.connect(self._saved)
        window.undoing.gone.connect(self.desk.mark_modified)

    # ------------------------------------------------------------------------------------------ saving

    def save(self) -> None:
        """Write to the file of the session, or ask for one."""
        if self.desk.path:
            self.desk.save(self.desk.path)
        else:
            self.ask_save()

    def ask_save(self) -> None:
        """Ask for a file, and write the session to it."""
        if not self.desk.has_something:
            return
        window = self._window
        name = Path(self.desk.path).name or stem_of(window.document.session.source) + ENDING
        place = str(Path(window.settings.folder) / name)
        ask_new_file(window, "Save the session", place, FILTERS, ENDING[1:], self.save_to, overwrites=True)

    def save_to(self, path: str) -> None:
        """Write the session to this file, which is its own from now on."""
        self._window.settings.folder = str(Path(path).parent)
        self.desk.save(path)

    def _saved(self, path: str) -> None:
        self._window.settings.remember_session(path)
        if self._closes_after_save:
            self._may_close = True
            self._window.close()

    # ------------------------------------------------------------------------------------------ opening

    def ask_open(self) -> None:
        """Ask for a session, and go to it."""
        filters = "Sessions, and pictures that carry one (*.dwb *.json *.png);;All files (*)"
        ask_file(self._window, "Open a session", filters, self.open)

    def takes(self, path: str) -> bool:
        """Whether a file is a session by its ending, or a picture that carries one."""
        return is_session_file(path) or carries_session(path)

    def open(self, path: str) -> None:
        """Read a session and go to it."""
        self._window.settings.folder = str(Path(path).parent)
        self._window.settings.remember_session(path)
        self._window.error_bar.dismiss()
        self._window.status.say(f"Reading {Path(path).name}…")
        self.desk.read(path, keeps_path=is_session_file(path))

    def _ask_for_mesh(self, found: Found) -> None:
        """The mesh is missing or another one: the user says what to do."""
        box = QMessageBox(self._window)
        box.setIcon(QMessageBox.Icon.Question)
        box.setWindowTitle("The mesh of the session")
        box.setText(found.trouble)
        box.setInformativeText("Choose the mesh that belongs to the session, or leave it.")
        choose = box.addButton("Choose the mesh…", QMessageBox.ButtonRole.AcceptRole)
        choose.clicked.connect(partial(self._choose_mesh, found))
        if Path(found.record.session.source).is_file():
            use = box.addButton("Use it as it is", QMessageBox.ButtonRole.AcceptRole)
            use.clicked.connect(lambda: self.desk.open(found))
        box.addButton(Buttons.Cancel)
        box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        box.open()

    def _choose_mesh(self, found: Found) -> None:
        folder = str(Path(found.path).parent)
        ask_file(self._window, "The mesh of the session", "", partial(self.desk.open, found), place=folder)

    def fill_recent(self, menu: QMenu) -> None:
        """The sessions of the settings that are still there."""
        menu.clear()
        last = self._window.autosave.last
        if last is not None:
            menu.addAction("The last one that was not saved").triggered.connect(
                lambda: self.desk.read(str(last), keeps_path=False)
            )
            menu.addSeparator()
        paths = self._window.settings.recent_sessions
        for path in paths:
            menu.addAction(path).triggered.connect(partial(self._open_recent, path))
        if not paths:
            menu.addAction("No sessions yet").setEnabled(False)

    def _open_recent(self, path: str, _: bool = False) -> None:
        self.open(path)

    def _failed(self, error: Any) -> None:
        self._closes_after_save = False
        window = self._window
        if isinstance(error, WorkbenchError):
            window.error_bar.show_message(error.sentence)
            window.status.say("The session was neither opened nor saved.")
        else:
            window.reporter.show_exception(error)

    # ------------------------------------------------------------------------------------------ title, end

    def show_title(self) -> None:
        """Session and mesh in the title of the window, with a mark where something is not saved."""
        source = source_name(self._window.document.session.source)
        name = f"{Path(self.desk.path).name} ({source})" if self.desk.path else source
        self._window.setWindowTitle(f"{name}[*] – Distortion Workbench" if name else "Distortion Workbench[*]")
        self._window.setWindowModified(self.desk.is_modified)

    def keeps_from_closing(self) -> bool:
        """Whether the window has to stay, as the user is asked about changes to a file.

        What has no file yet is kept as the last session (see `Autosave`), so that nothing is lost and nobody is asked.
        """
        if self._may_close or not self.desk.path or not self.desk.is_modified:
            return False
        box = QMessageBox(self._window)
        box.setIcon(QMessageBox.Icon.Question)
        box.setWindowTitle("Save the session?")
        box.setText(f"{Path(self.desk.path).name} was changed since it was saved.")
        box.setStandardButtons(Buttons.Save | Buttons.Discard | Buttons.Cancel)
        box.setDefaultButton(Buttons.Save)
        box.buttonClicked.connect(lambda button: self._close_or_stay(box.standardButton(button)))
        box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        box.open()
        return True

    def _close_or_stay(self, choice: Buttons) -> None:
        if choice is Buttons.Save:
            self._closes_after_save = True
            self.save()
        elif choice is Buttons.Discard:
            self._may_close = True
            self._window.close()
