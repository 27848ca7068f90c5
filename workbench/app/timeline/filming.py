"""Films of the time line: the dialog, its pictures and the file, made on threads."""

from __future__ import annotations

import threading
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject, Signal

from workbench.app.background import Backgrounds
from workbench.app.composing.composing import sentence_of
from workbench.app.composing.offers import offers_of
from workbench.app.files.new_file import stem_of
from workbench.app.inspector.latest import Latest
from workbench.app.timeline.film_dialog import FilmDialog
from workbench.app.timeline.film_plan import FilmPlan, frames_of, sentence_about, still_of
from workbench.core.errors import WorkbenchError
from workbench.core.mesh import Mesh
from workbench.figures.film import SAMPLED, FilmDrawer, Still
from workbench.figures.film_shading import Pixels, compile_shading
from workbench.session.moments import Moment

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow
    from workbench.app.timeline.time_line import TimeLine

TOLD = 0.004
"""Part of a film after which its progress is told anew."""


class Filming(QObject):
    """One film at a time; the window, the solver and the record go on meanwhile."""

    _progressed = Signal(float)

    def __init__(self, window: MainWindow, time_line: TimeLine) -> None:
        super().__init__(window)
        self._window, self._time_line = window, time_line
        self._works = Backgrounds(self)
        self._previews = Latest(self)
        self._previews.done.connect(self._show_preview)
        self._previews.failed.connect(self._show_no_preview)
        self._cancelled = threading.Event()
        self._told = 0.0
        self.dialog: FilmDialog | None = None
        self._progressed.connect(self._show_progress)

    @property
    def is_working(self) -> bool:
        """Whether a film is being made."""
        return len(self._works) > 0

    def wait(self) -> None:
        """Let threads end before the window does; a film that is not done is cancelled."""
        self._cancelled.set()
        self._previews.wait()
        self._works.wait()

    def ask(self) -> None:
        """Open the dialog, for what the window shows now; while a film is made, that of this film."""
        window = self._window
        if window.document.mesh is None or not len(self._time_line.recorder.record):
            return
        if self.dialog is not None and (self.is_working or self.dialog.isVisible()):
            self.dialog.show()
            self.dialog.raise_()
            return
        if self.dialog is not None:
            self.dialog.deleteLater()
        offers = [offer for offer in offers_of(window) if offer.panel.is_picture]
        usual = {1, len(offers) - 1}  # the target, and the last of the colour maps: few pictures are large ones
        offers = [replace(offer, is_chosen=place in usual) for place, offer in enumerate(offers)]
        stem = stem_of(window.document.session.source)
        place = Path(window.settings.folder) / f"{stem}.gif"
        is_marked = len(self._time_line.dock.slider.marked) == 2
        self.dialog = FilmDialog(offers, window.theme.is_dark, is_marked, place, window)
        self.dialog.take_kept(window.settings.film())
        self.dialog.preview_wanted.connect(self._draw)
        self.dialog.save_wanted.connect(self.save)
        self.dialog.cancel_wanted.connect(self._cancelled.set)
        self.dialog.show()

    # ------------------------------------------------------------------------------------------ frames

    def moments(self, plan: FilmPlan) -> list[Moment]:
        """The moments of the frames. Raises `WorkbenchError` where there are too many, or A and B are not there."""
        record, marked = self._time_line.recorder.record, self._time_line.dock.slider.marked
        first, last = 0, len(record) - 1
        if plan.part == "marked":
            if len(marked) < 2:
                raise WorkbenchError("A and B are not marked; mark two moments, or film everything.")
            first, last = sorted(record.index_of(moment) for moment in marked.values())
        elif plan.part == "rest":
            first = 0 if self._time_line.looking.is_live else self._time_line.looking.index
        return frames_of(record[first : last + 1], plan.film.rate, plan.pace, plan.speed)

    def _stills(self, plan: FilmPlan) -> tuple[Mesh, list[Still]]:
        mesh = self._window.document.mesh
        if mesh is None:
            raise WorkbenchError("There is no map to film; open a mesh first.")
        has_anchors = any(panel.anchors for panel in plan.film.panels)
        stills = [still_of(moment, has_anchors) for moment in self.moments(plan)]
        plan.film.check(len(stills))
        return mesh, stills

    def _plan(self, dialog: FilmDialog) -> FilmPlan:
        """The film as the dialog has it, with what the window knows of the mesh."""
        plan, loaded = dialog.plan, self._window.document.loaded
        return plan if loaded is None else replace(plan, film=replace(plan.film, cuts=loaded.cut_edges))

    def _draw(self) -> None:
        if self.dialog is None:
            return
        try:
            plan = self._plan(self.dialog)
            mesh, stills = self._stills(plan)
        except WorkbenchError as error:
            self._show_no_preview(error)
            return
        rows = np.unique(np.linspace(0, len(stills) - 1, SAMPLED).astype(int)).tolist()
        few = [stills[row] for row in rows]

        def draw() -> tuple[Pixels, str]:
            compile_shading()
            return FilmDrawer(plan.film, mesh, few).draw(few[len(few) // 2]), sentence_about(len(stills), plan.film.rate)

        self._previews.ask(draw)

    def _show_preview(self, found: tuple[Pixels, str]) -> None:
        if self.dialog is not None and not self.is_working:
            self.dialog.show_preview(*found)

    def _show_no_preview(self, error: Exception) -> None:
        if self.dialog is not None:
            self.dialog.show_no_preview(sentence_of(error))

    # ------------------------------------------------------------------------------------------ the file

    def save(self, path: str) -> None:
        """Make the film as the dialog has it, and write it."""
        from workbench.figures.film_file import FilmCancelledError, check_film_path, save_film

        dialog, window = self.dialog, self._window
        if dialog is None or self.is_working:
            return
        try:
            plan = self._plan(dialog)
            mesh, stills = self._stills(plan)
            check_film_path(path)
        except WorkbenchError as error:
            dialog.say(error.sentence)
            return
        window.settings.folder = str(Path(path).parent)
        window.settings.save_film(dialog.kept())
        self._cancelled.clear()
        self._told = 0.0
        dialog.show_progress(0.0)
        name = Path(path).name
        dialog.say(f"Filming {name}, {sentence_about(len(stills), plan.film.rate)}. The window can be used meanwhile.")

        def work() -> None:
            compile_shading()
            save_film(path, plan.film, mesh, stills, self._tell, self._cancelled.is_set)

        def end(sentence: str, *, failed: bool = False) -> None:
            dialog.show_progress(-1.0)
            dialog.say(sentence)
            if failed and not dialog.isVisible():
                window.error_bar.show_message(sentence)
            else:
                window.status.say(sentence)

        def fail(error: Exception) -> None:
            is_wanted = isinstance(error, FilmCancelledError)
            end(sentence_of(error), failed=not is_wanted)

        self._works.start(work, lambda _: end(f"Saved {path}."), fail)

    def _tell(self, share: float) -> None:
        """On the thread of the film."""
        if share - self._told >= TOLD:
            self._told = share
            self._progressed.emit(share)

    def _show_progress(self, share: float) -> None:
        if self.dialog is not None and self.is_working:
            self.dialog.show_progress(share)
