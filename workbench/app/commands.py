"""What the actions do."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import QObject, Qt
from PySide6.QtWidgets import QMessageBox, QWidget

from workbench.app.background import Background
from workbench.app.binding.binding import Binding
from workbench.app.citing.citing import Citing
from workbench.app.composing.composing import Composing
from workbench.app.composing.figure_presets import FigurePresets
from workbench.app.document.saving import FILTERS, SURFACE_FILTERS, Saver, SaveRequest
from workbench.app.document.switches import name_of_distortion
from workbench.app.exporting.export_kinds import KINDS
from workbench.app.exporting.exporting import Exporting
from workbench.app.files.file_choice import MESH_FILTERS, ask_file
from workbench.app.files.new_file import ask_new_file, stem_of
from workbench.app.filling.filling import Filling
from workbench.app.help.help_texts import ABOUT
from workbench.app.method_tips.chooser_tips import ChooserTips
from workbench.app.palette.commanding import Commanding
from workbench.app.race.racing import Racing
from workbench.app.refining.refining import Refining
from workbench.app.status.reporter import source_name
from workbench.app.verdict.judging import Judging
from workbench.app.verdict.ranked_places import RankedPlaces
from workbench.core.errors import WorkbenchError

if TYPE_CHECKING:
    from workbench.app.dissection.dissection_window import DissectionWindow
    from workbench.app.main_window import MainWindow
    from workbench.app.signatures.signature_window import SignatureWindow


class Commands(QObject):
    """Connects every action to its deed; dialogs open without stopping the event loop."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._document = window.document
        self.saver = Saver(self)
        self.saver.saved.connect(lambda path: window.status.say(f"Saved {path}."))
        self.saver.failed.connect(lambda sentence: window.error_bar.show_message(sentence))
        self._boundary_search: Background | None = None
        self.signatures: SignatureWindow | None = None
        self.dissection: DissectionWindow | None = None
        self.refining = Refining(window)
        self.filling = Filling(window)
        self.racing = Racing(window)
        self.composing = Composing(window)
        self.presets = FigurePresets(window)
        self.judging = Judging(window)
        self.ranked = RankedPlaces(window)
        self.binding = Binding(window)
        self.exporting = Exporting(window)
        self.citing = Citing(window)
        self.commanding = Commanding(window)
        self.tips = ChooserTips(window)
        window.carried.told.connect(window.status.say)
        window.carried.refused.connect(self._carried_refused)
        document = window.document
        deeds: dict[str, Any] = {
            "open": self.ask_open,
            "save": self.ask_save,
            "open-session": window.sessions.ask_open,
            "save-session": window.sessions.save,
            "save-session-as": window.sessions.ask_save,
            "undo": lambda: self._go_through_history(window.undoing.undo),
            "redo": lambda: self._go_through_history(window.undoing.redo),
            "fill": self.filling.ask,
            "equations": self.binding.ask,
            **{name: lambda n=name: self.exporting.ask(n) for name in KINDS},
            "refine": self.refining.ask,
            "figure": self.composing.ask,
            "shot-window": lambda: self.ask_screenshot(window, "window"),
            "quit": window.close,
            "pin": self.pin_boundary,
            "remove": window.handling.remove_selected,
            "clear": window.handling.clear,
            "run": document.toggle,
            "step": document.step,
            "reset": document.reset,
            "stop": document.stop,
            "fit": self.fit,
            "lock": self.hold_ranges,
            "unbrush": window.brush.clear,
            "signatures": self.show_signatures,
            "race": self.racing.ask,
            "dissect": self.show_dissection,
            "judge": self.judging.ask,
            "next-place": lambda: self.judging.walk(1),
            "last-place": lambda: self.judging.walk(-1),
            "worst": lambda: self.ranked.walk(1),
            "less-bad": lambda: self.ranked.walk(-1),
            "preferences": lambda: window.preferring.ask(),
            "palette": self.commanding.ask,
            "shortcuts": self.show_keys,
            "help": window.help.show,
            "log": window.noticing.show,
            "cite": self.citing.ask,
            "report": self.show_report,
            "about": lambda: self._tell("About", ABOUT),
        }
        for name, deed in deeds.items():
            window.actions_by_name[name].triggered.connect(lambda _=False, d=deed: d())

    def wait(self) -> None:
        """End what has more to do at the end of the window than to let a thread end."""
        self._window.preferring.end()
        self.saver.wait()
        if self.signatures is not None:
            self.signatures.wait()
        self.refining.wait()
        self.filling.wait()
        self.presets.wait()
        self.racing.close()
        self.judging.close()
        if self.dissection is not None:
            self.dissection.close()

    def _go_through_history(self, deed: Callable[[], None]) -> None:
        """Undo or redo, or say what has to be over first."""
        if self._document.is_held:
            self._window.status.say("An anchor is being moved: let it go first, or take that back with Esc.")
        elif self._document.opening_source:
            self._window.status.say("A mesh is being read: undo and redo wait until it is there.")
        else:
            deed()

    # ------------------------------------------------------------------------------------------ files

    def ask_open(self) -> None:
        ask_file(self._window, "Open a mesh or a case", MESH_FILTERS, self._window.open)

    def ask_save(self) -> None:
        name = stem_of(self._document.session.source) + "-map.obj"
        self._ask_place("Save the map", name, FILTERS, self.save_map)

    def _ask_place(self, title: str, name: str, filters: str, deed: Any) -> None:
        """Ask for a file to write; its ending is that of the filter, the name's first."""
        place = Path(self._window.settings.folder) / name
        ask_new_file(self._window, title, str(place), filters, place.suffix[1:], deed, overwrites=True)

    def save_map(self, path: str) -> None:
        """Write the map as it is now; the window goes on meanwhile."""
        document = self._document
        if document.loaded is None or document.snapshot is None:
            return
        self._window.settings.folder = str(Path(path).parent)
        anchors = document.anchors.in_force
        dimension = document.snapshot.positions.shape[1]
        self.saver.save(
            SaveRequest(
                Path(path),
                document.session,
                document.loaded,
                document.snapshot,
                anchors.vertices,
                anchors.target_array(dimension),
            )
        )

    def ask_carry(self) -> None:
        ask_file(self._window, "Carry a surface inside the solid", MESH_FILTERS, self._window.carried.read)

    def _carried_refused(self, error: Exception) -> None:
        if isinstance(error, WorkbenchError):
            self._window.error_bar.show_message(error.sentence)
            self._window.status.say("The surface is not carried.")
        else:
            self._window.reporter.show_exception(error)

    def ask_save_carried(self) -> None:
        """Ask where the carried surface goes."""
        surface = self._window.carried.surface
        if surface is not None:
            name = Path(surface.surface.name).stem.lower() + "-carried.obj"
            self._ask_place("Save the carried surface", name, SURFACE_FILTERS, self._window.carried.save)

    def ask_screenshot(self, widget: QWidget, name: str) -> None:
        self._ask_place(f"Screenshot of the {name}", f"{name}.png", "PNG (*.png)", partial(self.save_screenshot, widget))

    def save_screenshot(self, widget: QWidget, path: str) -> None:
        """Write a picture of a widget with all that is in it."""
        self.exporting.save_picture(widget.grab().toImage(), path)

    # ------------------------------------------------------------------------------------------ anchors

    def pin_boundary(self) -> None:
        """Anchors at all boundary vertices; the boundary is found on a thread, once a mesh."""
        mesh, generation = self._document.mesh, self._document.generation
        if mesh is None or (self._boundary_search is not None):
            return

        def pin(vertices: Any) -> None:
            self._boundary_search = None
            if self._document.generation == generation:
                if not len(vertices):
                    self._window.status.say("This mesh has no boundary.")
                self._document.pin(vertices)

        def fail(error: Exception) -> None:
            self._boundary_search = None
            self._window.reporter.show_exception(error)

        solid = self._window.volume.solid
        simplices, sides = mesh.simplices, None if solid is None else solid.boundary.triangles
        find = (lambda: np.unique(sides)) if sides is not None else (lambda: boundary_vertices(simplices))
        self._boundary_search = Background(find, self)
        self._boundary_search.finished.connect(pin)
        self._boundary_search.failed.connect(fail)
        self._boundary_search.start()

    # ------------------------------------------------------------------------------------------ view

    def fit(self) -> None:
        self._window.source.view.fit()
        self._window.presenter.refit_target()
        for pane in self._window.splitting.panes:
            pane.view.fit()

    def hold_ranges(self) -> None:
        is_wanted = self._window.actions_by_name["lock"].isChecked()
        self._window.quantities.hold_all(is_wanted)
        self._window.colouring.hold_own(is_wanted)

    def show_signatures(self) -> None:
        """The window that compares maps; the maps in it stay while it is closed."""
        if self.signatures is None:
            from workbench.app.signatures.signature_window import SignatureWindow

            window = self._window
            self.signatures = SignatureWindow(window.theme, window)
            self.signatures.present_wanted.connect(self._add_signature)
            window.theme_switch.changed.connect(self.signatures.set_theme)
            self._add_signature()
        self.signatures.show()
        self.signatures.raise_()

    def _add_signature(self) -> None:
        mesh, positions, snapshot = self._document.mesh, self._document.positions, self._document.snapshot
        if mesh is None or positions is None or snapshot is None or self.signatures is None:
            return
        session = self._document.session
        name = f"{source_name(session.source)}, {name_of_distortion(session.distortion)}, iteration {snapshot.row.iteration}"
        self.signatures.add_map(mesh, positions, name)

    def show_dissection(self) -> None:
        """The window that takes the next step apart."""
        if self._document.mesh is None:
            return
        if self.dissection is None:
            from workbench.app.dissection.dissection_window import DissectionWindow

            self.dissection = DissectionWindow(self._document, self._window.theme, self._window)
            self.dissection.finished.connect(self._dissection_closed)
            self._window.theme_switch.changed.connect(self.dissection.set_theme)
            self.dissection.show()
        self.dissection.raise_()
        self.dissection.ask()

    def _dissection_closed(self) -> None:
        dissection, self.dissection = self.dissection, None
        if dissection is not None:
            self._window.theme_switch.changed.disconnect(dissection.set_theme)

    def choose_theme(self, choice: str) -> None:
        self._window.preferring.choose("theme", choice)

    # ------------------------------------------------------------------------------------------ help

    def show_keys(self) -> None:
        """The sheet of all keys and gestures."""
        from workbench.app.shortcuts.sheet import sheet_of
        from workbench.app.shortcuts.sheet_window import SheetWindow

        SheetWindow(sheet_of(self._window), self._window.settings.folder, self._window).show()

    def show_report(self) -> None:
        loaded = self._document.loaded
        lines = loaded.lines if loaded is not None else ("No mesh is open.",)
        self._tell("Report on the mesh", "<p>" + "<br>".join(line.replace("<", "&lt;") for line in lines) + "</p>")

    def _tell(self, title: str, text: str) -> None:
        box = QMessageBox(self._window)
        box.setWindowTitle(title)
        box.setTextFormat(Qt.TextFormat.RichText)
        box.setText(text)
        box.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        box.open()


def boundary_vertices(triangles: Any) -> Any:
    """Vertices (k,) of the edges that belong to one triangle only."""
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    unique, counts = np.unique(edges, axis=0, return_counts=True)
    return np.unique(unique[counts == 1])
