"""Anchors from files and to files, and the panel of the table in the window."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Qt
from PySide6.QtWidgets import QMessageBox

from workbench.app.anchors.anchor_dock import AnchorDock
from workbench.app.anchors.anchor_edits import set_of, table_of
from workbench.app.background import Backgrounds
from workbench.app.document.anchor_set import AnchorSet
from workbench.app.files.file_choice import ask_file
from workbench.app.files.new_file import ask_new_file, stem_of
from workbench.core.errors import WorkbenchError
from workbench.io.anchor_rows import AnchorTable
from workbench.io.anchors import read_anchors, vertices_after_fixes, vertices_before_fixes, write_anchors

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

ENDINGS = (".csv", ".tsv")
FILTERS = "Anchors (*.csv *.tsv);;All files (*)"
Roles = QMessageBox.ButtonRole


class AnchorFiles(QObject):
    """Owns the panel; reads and writes on threads. Files name vertices of the mesh file, whatever fixes made of it."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._document = window.document
        actions = window.actions_by_name
        self._works = Backgrounds(self)
        files = actions["import-anchors"], actions["export-anchors"]
        self.dock = AnchorDock(window.document, window.error_bar, files, window)
        files[0].triggered.connect(lambda _=False: self.ask_import())
        files[1].triggered.connect(lambda _=False: self.ask_export())

    # ------------------------------------------------------------------------------------------ in

    def takes(self, path: str) -> bool:
        """Whether a file is one of anchors by its ending."""
        return Path(path).suffix.lower() in ENDINGS

    def ask_import(self) -> None:
        if self._document.mesh is None:
            self._window.status.say("Open a mesh first; anchors belong to its vertices.")
            return
        ask_file(self._window, "Import anchors", FILTERS, self.read)

    def read(self, path: str) -> None:
        """Read a file, then put its anchors in the place of those that are there, or beside them, as the user says."""
        document, loaded = self._document, self._document.loaded
        if document.mesh is None or loaded is None:
            self._window.error_bar.show_message(f"{Path(path).name} has anchors for a mesh; open the mesh first.")
            return
        self._window.settings.folder = str(Path(path).parent)
        mesh, dimension, generation = document.mesh, 3 if document.kind == "volume" else 2, document.generation
        origin = mesh.vertex_origin
        count = mesh.vertex_count if origin is None else int(origin.max()) + 1

        def work() -> AnchorSet:
            table = read_anchors(path, count, dimension)
            vertices = vertices_after_fixes(path, table.vertices, mesh)
            return set_of(AnchorTable(vertices, table.targets, table.weights, table.groups, table.is_off))

        def done(found: AnchorSet) -> None:
            if document.generation != generation:
                return
            if len(document.anchors) and len(found):
                self._ask_how(found, Path(path).name)
            else:
                self._replace(found)

        self._works.start(work, done, self._failed)

    def _ask_how(self, found: AnchorSet, name: str) -> None:
        present = self._document.anchors
        shared = sum(vertex in present for vertex in found.targets)
        box = QMessageBox(self._window)
        box.setObjectName("import-anchors")
        box.setIcon(QMessageBox.Icon.Question)
        box.setWindowTitle("Import anchors")
        box.setText(f"{name} has {len(found)} anchors, and there are {len(present)} already.")
        box.setInformativeText(f"{shared} of them are on vertices that have one; those become as the file says." * bool(shared))
        replacing = box.addButton("Replace", Roles.AcceptRole)
        adding = box.addButton("Add", Roles.AcceptRole)
        box.addButton(QMessageBox.StandardButton.Cancel)
        box.setDefaultButton(replacing)
        replacing.clicked.connect(partial(self._replace, found))
        adding.clicked.connect(partial(self.dock.take, found, "Import"))
        box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        box.open()

    def _replace(self, found: AnchorSet, _: bool = False) -> None:
        count = len(found)
        self._document.set_anchors(found, name=f"Import {count} anchor{'s' * (count != 1)}")
        self._window.status.say(f"{count} anchor{'s' * (count != 1)} imported.")

    def _failed(self, error: Exception) -> None:
        if isinstance(error, WorkbenchError):
            self._window.error_bar.show_message(error.sentence)
        else:
            self._window.reporter.show_exception(error)

    # ------------------------------------------------------------------------------------------ out

    def ask_export(self) -> None:
        if not len(self._document.anchors):
            self._window.status.say("There are no anchors to export.")
            return
        name = stem_of(self._document.session.source) + "-anchors.csv"
        place = str(Path(self._window.settings.folder) / name)
        ask_new_file(self._window, "Export anchors", place, FILTERS, "csv", self.write, overwrites=True)

    def write(self, path: str) -> None:
        """Write all anchors, those that are off among them."""
        document, mesh = self._document, self._document.mesh
        if mesh is None:
            return
        self._window.settings.folder = str(Path(path).parent)
        table = table_of(document.anchors, 3 if document.kind == "volume" else 2)

        def work() -> str:
            vertices = vertices_before_fixes(table.vertices, mesh)
            write_anchors(path, AnchorTable(vertices, table.targets, table.weights, table.groups, table.is_off))
            return path

        self._works.start(work, lambda path: self._window.status.say(f"Saved {path}."), self._failed)
