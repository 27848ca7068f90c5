"""File > Export: a place is asked for, and one file is written beside the running window."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QMenu

from workbench.app.background import Backgrounds
from workbench.app.composing.composing import sentence_of
from workbench.app.composing.figure_work import Order, save
from workbench.app.composing.offers import offers_of, rows_of, subject_of
from workbench.app.exporting.export_kinds import KINDS, MAP_KINDS, OTHER_KINDS, PICTURE_KINDS, ExportKind
from workbench.app.exporting.session_pictures import png_of, session_binder
from workbench.app.files.new_file import ask_new_file, stem_of
from workbench.core.errors import WorkbenchError
from workbench.core.unit_square import into_unit_square
from workbench.figures.recipe import Page
from workbench.io.atomic import write_bytes, write_text
from workbench.io.opening import OpenedSource, open_source
from workbench.session.session import Session

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

PAGE = Page(width=120.0, columns=1)
"""On which a single picture stands."""


class Exporting(QObject):
    """One deed a kind of file; all write on threads, whole or not at all."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._works = Backgrounds(self)

    def fill_menu(self, menu: QMenu) -> None:
        """Meshes and tables, then pictures; what there is nothing for yet is grey."""
        menu.clear()
        for name in (*MAP_KINDS, *OTHER_KINDS, "", *PICTURE_KINDS):
            if not name:
                menu.addSeparator()
                continue
            action = self._window.actions_by_name[name]
            action.setEnabled(self._is_possible(name))
            menu.addAction(action)

    def _is_possible(self, name: str) -> bool:
        if name in ("export-history", "export-curve"):
            return len(self._window.history) > 1
        document = self._window.document
        return document.snapshot is not None and (name != "export-unit" or document.kind == "parameterize")

    def ask(self, name: str) -> None:
        """Ask where to, with a name that tells the mesh and the kind."""
        window, kind = self._window, KINDS[name]
        stem = stem_of(window.document.session.source)
        place = str(Path(window.settings.folder) / (stem + kind.name))
        suffix, take = Path(kind.name).suffix[1:], partial(self.export, name)
        ask_new_file(window, _title(kind), place, kind.filters, suffix, take, overwrites=True)

    def export(self, name: str, path: str) -> None:
        """Write this kind of file as the window shows it now."""
        if not self._is_possible(name):
            self._window.error_bar.show_message("There is nothing to export yet; open a mesh and run the solver first.")
            return
        self._window.settings.folder = str(Path(path).parent)
        if name in MAP_KINDS:
            self._window.commands.save_map(path)
        elif name in PICTURE_KINDS:
            self._draw(PICTURE_KINDS[name].panel, path)
        elif name == "export-script":
            self._write_script(path)
        elif name == "export-unit":
            self._write_in_unit_square(path)
        else:
            self._write_history(path)

    def _write_history(self, path: str) -> None:
        rows = rows_of(self._window.history)

        def write() -> None:
            from workbench.engine.run_report import history_text

            write_text(path, history_text(rows))

        self._start(write, path)

    def _write_script(self, path: str) -> None:
        seal = self._window.sessions.desk.sealer()

        def work() -> None:
            record = seal()
            from workbench.engine.python_script import write_script

            write_script(path, record, _opened(record.session))

        self._start(work, path)

    def _write_in_unit_square(self, path: str) -> None:
        record = self._window.sessions.desk.record()

        def work() -> None:
            opened = _opened(record.session)
            from workbench.io.write import write_map

            write_map(path, opened.file.mesh, opened.mesh, into_unit_square(record.map), opened.kind)

        self._start(work, path)

    def _draw(self, words: str, path: str) -> None:
        subject = subject_of(self._window)
        offer = next((offer for offer in offers_of(self._window) if offer.words.startswith(words)), None)
        if subject is None or offer is None:
            return
        order = Order(subject, PAGE, (offer.panel,))
        bind = session_binder(self._window, path)
        self._start(lambda: save(order, Path(path), bind), path)

    def save_picture(self, image: QImage, path: str) -> None:
        """Write a picture that was taken."""
        bind = session_binder(self._window, path)
        self._start(lambda: write_bytes(path, bind(png_of(image))), path)

    def _start(self, work: Callable[[], Any], path: str) -> None:
        window = self._window
        window.status.say(f"Writing {Path(path).name}…")

        def fail(error: Exception) -> None:
            own = isinstance(error, WorkbenchError)
            window.error_bar.show_message(sentence_of(error) if own else f"{path} could not be written: {sentence_of(error)}.")

        def done(notes: Any) -> None:
            window.status.say(" ".join((f"Saved {path}.", *(notes if isinstance(notes, tuple) else ()))))

        self._works.start(work, done, fail)


def _opened(session: Session) -> OpenedSource:
    """The source once more, with what the window does not hold of its file; for threads."""
    return open_source(session.source, kind=session.kind, fixes=session.fixes)


def _title(kind: ExportKind) -> str:
    return f"Export: {kind.text.replace('&', '').rstrip('…')}"
