"""Refining the open map: from the dialog to a file, and from the file to the new document."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject

from workbench.app.background import Backgrounds
from workbench.app.files.new_file import stem_of
from workbench.app.refining.refine_dialog import RefineDialog
from workbench.app.refining.refine_work import CurvePicture, CurveRequest, RefineRequest, draw_curves, refine_into
from workbench.app.status.reporter import source_name
from workbench.core.errors import WorkbenchError

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow


class Refining(QObject):
    """Opens the dialog and does its work on threads; the result is a file, which is opened as any other."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._document = window.document
        self._works = Backgrounds(self)
        self._curves: CurvePicture | None = None
        self.dialog: RefineDialog | None = None

    def wait(self) -> None:
        """Let threads end before the window does."""
        self._works.wait()

    def ask(self) -> None:
        """Open the dialog for the mesh and the map on the screen."""
        document = self._document
        if document.mesh is None or document.positions is None or self.dialog is not None:
            return
        source = document.session.source
        stem = stem_of(source)
        dialog = RefineDialog(document.mesh, stem, self._window.settings.folder, self._window)
        dialog.refine_wanted.connect(self._refine)
        dialog.curves_wanted.connect(self._measure)
        dialog.figure_wanted.connect(self._save_figure)
        dialog.closed.connect(self._forget_dialog)
        self.dialog = dialog
        dialog.open()

    def _forget_dialog(self) -> None:
        self.dialog = self._curves = None

    # ------------------------------------------------------------------------------------------ refining

    def _refine(self, path: str) -> None:
        document, window = self._document, self._window
        loaded, positions, dialog = document.loaded, document.positions, self.dialog
        if loaded is None or positions is None or dialog is None:
            return
        anchors = document.anchors.in_force
        request = RefineRequest(
            loaded.mesh,
            loaded.kind,
            positions,
            anchors.vertices,
            anchors.target_array(positions.shape[1]),
            dialog.chosen_scheme,
            dialog.levels.value(),
        )
        window.settings.folder = str(Path(path).parent)
        generation = document.generation
        window.status.say(f"Refining into {Path(path).name}…")

        def done(_: int) -> None:
            if document.generation == generation:
                document.open(path, kind=loaded.kind)
            else:
                window.status.say(f"The refined map is in {path}.")

        self._works.start(lambda: refine_into(Path(path), request), done, window.reporter.show_exception)

    # ------------------------------------------------------------------------------------------ curves

    def _measure(self, levels: int) -> None:
        document, dialog = self._document, self.dialog
        if document.mesh is None or document.positions is None or dialog is None:
            return
        session = document.session
        request = CurveRequest(
            document.mesh,
            document.positions,
            levels,
            source_name(session.source),
            session.distortion,
            dict(session.distortion_parameters),
            dialog.devicePixelRatioF(),
        )

        def done(curves: CurvePicture) -> None:
            if self.dialog is dialog:
                self._curves = curves
                dialog.show_curves(curves)

        def fail(error: Exception) -> None:
            if self.dialog is dialog:
                is_ours = isinstance(error, WorkbenchError)
                dialog.show_no_curves(error.sentence if is_ours else f"{type(error).__name__}: {error}")

        self._works.start(lambda: draw_curves(request, lambda: self.dialog is not dialog), done, fail)

    def _save_figure(self, path: str) -> None:
        from workbench.figures.save import save_figure

        if self._curves is None or self.dialog is None:
            return
        try:
            save_figure(self._curves.figure, path)
        except WorkbenchError as error:
            self.dialog.show_error(error.sentence)
            return
        self._window.settings.folder = str(Path(path).parent)
        self._window.status.say(f"Saved {path}.")
