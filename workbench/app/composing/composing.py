"""Composing a figure of what the window shows: the dialog, its previews and its files on threads."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt

from workbench.app.background import Backgrounds
from workbench.app.composing.figure_dialog import PREVIEW, FigureDialog
from workbench.app.composing.figure_work import ENDINGS, Order, Subject, draw_preview, save
from workbench.app.composing.offers import offers_of, subject_of
from workbench.app.exporting.session_pictures import session_binder
from workbench.core.errors import WorkbenchError

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow


class Composing(QObject):
    """One dialog at a time; one preview is drawn at a time, the newest that is wanted after it."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._works = Backgrounds(self)
        self._subject: Subject | None = None
        self._is_drawing = self._is_stale = False
        self.dialog: FigureDialog | None = None

    def ask(self) -> None:
        """Open the dialog for the map on the screen."""
        if self.dialog is not None:
            self.dialog.raise_()
            return
        self._subject = subject_of(self._window)
        if self._subject is None:
            return
        dialog = FigureDialog(offers_of(self._window), self._subject.stem, self._window.settings.folder, self._window)
        dialog.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        dialog.preview_wanted.connect(self._draw)
        dialog.save_wanted.connect(self._save)
        dialog.map_wanted.connect(self._renew)
        dialog.closed.connect(self._forget)
        self.dialog = dialog
        dialog.open()

    def _forget(self) -> None:
        self.dialog = self._subject = None

    def _renew(self) -> None:
        """The map, the colours and the ranges as they are now."""
        subject = subject_of(self._window)
        if self.dialog is not None and subject is not None:
            self._subject = subject
            self.dialog.panels.renew(offers_of(self._window))

    def _order(self) -> Order | None:
        if self.dialog is None or self._subject is None:
            return None
        return Order(self._subject, self.dialog.page, self.dialog.chosen)

    # ------------------------------------------------------------------------------------------ preview

    def _draw(self) -> None:
        order, dialog = self._order(), self.dialog
        if order is None or dialog is None:
            return
        if self._is_drawing:
            self._is_stale = True
            return
        self._is_drawing, self._is_stale = True, False
        pixels = round(PREVIEW[0] * dialog.devicePixelRatioF())

        def done(png: bytes) -> None:
            if self.dialog is dialog:
                dialog.show_preview(png)
            self._drawn()

        def fail(error: Exception) -> None:
            if self.dialog is dialog:
                dialog.show_no_preview(sentence_of(error))
            self._drawn()

        self._works.start(lambda: draw_preview(order, pixels), done, fail)

    def _drawn(self) -> None:
        self._is_drawing = False
        if self._is_stale:
            self._draw()

    # ------------------------------------------------------------------------------------------ files

    def _save(self, path: str) -> None:
        order, dialog, window = self._order(), self.dialog, self._window
        if order is None or dialog is None:
            return
        if Path(path).suffix.lower() not in ENDINGS:
            dialog.say(f"Figures are written as {', '.join(ENDINGS)}; choose one of these endings.")
            return
        window.settings.folder = str(Path(path).parent)
        dialog.say(f"Saving {Path(path).name}…")

        def done(notes: tuple[str, ...]) -> None:
            window.status.say(f"Saved {path}.")
            if self.dialog is dialog:
                dialog.say(" ".join((f"Saved {Path(path).name}.", *notes)))

        def fail(error: Exception) -> None:
            if self.dialog is dialog:
                dialog.say(sentence_of(error))
            else:
                window.error_bar.show_message(sentence_of(error))

        bind = session_binder(window, path)
        self._works.start(lambda: save(order, Path(path), bind), done, fail)


def sentence_of(error: Exception) -> str:
    """What to say of an error: ours in their own words."""
    return error.sentence if isinstance(error, WorkbenchError) else f"{type(error).__name__}: {error}"
