"""From the document to a race and back: the set-up, the window, the map that is kept."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject

from workbench.app.background import Background
from workbench.app.document.orders import held_anchors
from workbench.app.status.reporter import source_name
from workbench.engine.messages import Reset, Run, SetAnchors, SetProblem
from workbench.engine.race_messages import StartRace, StartWish

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow
    from workbench.app.race.draft import Draft
    from workbench.app.race.race_window import RaceWindow
    from workbench.app.race.set_up_dialog import RaceChoice, SetUpDialog
    from workbench.core.registry import Registry

OTHER_MESH = "The document holds another mesh now, which this map does not fit; open the mesh of the race again."


class Racing(QObject):
    """One race at a time; the contestants that were chosen last are offered again."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._document = window.document
        self._drafts: list[Draft] = []
        self._generation = -1
        self._finder: Background | None = None
        self._registry: Registry | None = None
        self._preset = ""
        self.dialog: SetUpDialog | None = None
        self.race: RaceWindow | None = None
        self.make_worker: Any = None
        """Makes the worker of the race in place of the real one; None: the real one."""

    # ------------------------------------------------------------------------------------------ set-up

    def ask(self) -> None:
        """Show the race that there is, or ask for one."""
        if self.race is not None and self._generation == self._document.generation:
            self.race.show()
            self.race.raise_()
        else:
            self.ask_contestants()

    def ask_contestants(self, preset: str = "") -> None:
        """Open the dialog, once the methods are found; `preset` fills it with a comparison."""
        self._preset = preset
        if self._document.mesh is None or self._document.positions is None:
            self._window.status.say("Open a mesh first; then solvers can race on it.")
            return
        if self.dialog is not None or self._finder is not None:
            return
        self._finder = Background(_find_methods, self)
        self._finder.finished.connect(self._show_dialog)
        self._finder.failed.connect(self._window.reporter.show_exception)
        self._finder.start()

    def _show_dialog(self, registry: Registry) -> None:
        from workbench.app.race.set_up_dialog import RaceGround, SetUpDialog

        document, session = self._document, self._document.session
        self._finder, self._registry = None, registry
        if document.mesh is None:
            return
        if self._generation != document.generation:
            # maps from elsewhere are maps of one source
            self._drafts = [draft for draft in self._drafts if draft.map is None]
        ground = RaceGround(
            document.mesh,
            document.kind,
            session.distortion,
            dict(session.distortion_parameters),
        )
        owner = self.race if self.race is not None else self._window
        self.dialog = SetUpDialog(ground, registry, self._drafts, owner)
        self.dialog.chosen.connect(self.begin)
        self.dialog.finished.connect(self._dialog_closed)
        if self._preset:
            self.dialog.take_preset(self._preset)
        self.dialog.open()

    def _dialog_closed(self) -> None:
        self.dialog = None

    # ------------------------------------------------------------------------------------------ race

    def begin(self, choice: RaceChoice) -> None:
        """Bring the contestants to the start; the document's own solver rests meanwhile."""
        set_up = self._set_up(choice)
        if set_up is None:
            return
        self._document.pause()
        self._generation = self._document.generation
        title = f"Race: {source_name(self._document.session.source)}"  # the document may go on to another mesh meanwhile
        if self.race is not None:
            self.race.setWindowTitle(title)
            self.race.begin(set_up)
            return
        from workbench.app.race.race_bridge import race_worker
        from workbench.app.race.race_window import RaceWindow

        window = self._window
        quantity = set_up.problem.distortion
        self.race = RaceWindow(
            set_up,
            window.quantities,
            quantity if quantity in window.quantities else "symmetric-dirichlet",
            window.theme,
            window,
            self.make_worker or race_worker,
        )
        self.race.setWindowTitle(title)
        self.race.take_wanted.connect(self.take_map)
        self.race.switch_wanted.connect(self.ask_switch)
        self.race.set_up_wanted.connect(self.ask_contestants)
        self.race.anchors_wanted.connect(self.move_anchors)
        self.race.closed.connect(self._race_closed)
        window.theme_switch.changed.connect(self.race.set_theme)
        self.race.open()

    def _set_up(self, choice: RaceChoice) -> StartRace | None:
        document, session = self._document, self._document.session
        loaded, positions = document.loaded, document.positions
        if loaded is None or positions is None:
            return None
        own = not choice.distortion
        problem = SetProblem(
            session.distortion if own else choice.distortion,
            dict(session.distortion_parameters) if own else {},
            session.fixed_boundary,
            session.allow_inversions,
            session.linear_equations,
        )
        reset = Reset(session.initializer, dict(session.initializer_parameters), session.start_file, session.match_area)
        return StartRace(
            serial=0,
            mesh=loaded.mesh,
            kind=loaded.kind,
            start=positions if choice.from_map else StartWish(session.source, session.solver, session.fixes, reset),
            entrants=choice.entrants,
            problem=problem,
            anchors=self._anchors(positions.shape[1]),
            limits=Run(choice.iterations, choice.tolerance),
        )

    def take_map(self, index: int) -> None:
        """The document goes on from the map of a contestant that is shown."""
        assert self.race is not None
        record = self.race.model.records[index]
        if record.frame is None or record.frame.positions is None:
            return
        if self._document.generation != self._generation:
            self.race.error_bar.show_message(OTHER_MESH)
            return
        self._document.take_map(record.frame.positions)
        self.race.say(f"The document holds the map of {record.label}, iteration {record.frame.iteration}.")

    def ask_switch(self, index: int) -> None:
        """Let a contestant go on in another way."""
        from workbench.app.race.switch_dialog import SwitchDialog

        assert self.race is not None and self._registry is not None
        model = self.race.model
        record = model.records[index]
        dialog = SwitchDialog(record.entrant, record.problem, model.set_up.kind, self._registry, self.race)
        dialog.switched.connect(lambda *change: model.switch(index, *change))
        dialog.open()

    def move_anchors(self) -> None:
        """All contestants go on with the anchors that the document has now."""
        assert self.race is not None
        if self._document.generation != self._generation:
            self.race.error_bar.show_message(OTHER_MESH)
        else:
            anchors = self._anchors(self.race.model.mesh.dimension)
            count = len(anchors.vertices)
            self.race.model.move_anchors(f"{count} {'anchor' if count == 1 else 'anchors'} of the document", anchors)

    def _anchors(self, dimension: int) -> SetAnchors:
        """Those of the document that are in force."""
        return held_anchors(self._document.anchors, dimension)

    def _race_closed(self) -> None:
        race, self.race = self.race, None
        if race is not None:
            self._window.theme_switch.changed.disconnect(race.set_theme)

    def close(self) -> None:
        """End the race with the window."""
        if self._finder is not None:
            self._finder.wait()
        if self.race is not None:
            self.race.close()


def _find_methods() -> Any:
    from workbench.core.registry import registry

    return registry()
