"""The time line of a window: records, looks back, plays, compares, goes on from an earlier map."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject, Qt
from PySide6.QtWidgets import QMenu

from workbench.app.appearance.theme import Theme
from workbench.app.sessions.restoring import with_anchors
from workbench.app.timeline.looking_back import LookingBack
from workbench.app.timeline.past_badge import PastBadge, badge_of
from workbench.app.timeline.player import Player
from workbench.app.timeline.recorder import Recorder, anchors_of
from workbench.app.timeline.time_line_dock import TimeLineDock
from workbench.session.moments import Moment

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow
    from workbench.app.timeline.comparing import Comparing
    from workbench.app.timeline.filming import Filming
    from workbench.app.views.mesh_view import MeshView

ACTIONS = ("past-live", "past-go-on", "past-compare", "film")


class TimeLine(QObject):
    """Owns the parts and connects them; made after views and undo, before the menus."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._document = window.document
        actions = window.actions_by_name
        self.recorder = Recorder(window.document, window.undoing, window.settings.time_line_memory * 2**20)
        self.looking = LookingBack(window.document, self.recorder)
        self.player = Player(self.recorder.record, self.looking)
        self.dock = TimeLineDock(self.recorder, self.looking, [actions[name] for name in ACTIONS[1:]], window)
        window.addDockWidget(Qt.DockWidgetArea.BottomDockWidgetArea, self.dock, Qt.Orientation.Vertical)
        self.dock.hide()
        window.docks.append(self.dock)
        self.filming: Filming | None = None
        self.comparing: Comparing | None = None
        self._connect()

    def _connect(self) -> None:
        dock, looking, actions = self.dock, self.looking, self._window.actions_by_name
        actions["past-live"].triggered.connect(lambda _=False: looking.go_live())
        actions["past-go-on"].triggered.connect(lambda _=False: self.go_on())
        actions["film"].triggered.connect(lambda _=False: self.film())
        actions["past-compare"].triggered.connect(lambda _=False: self.compare())
        dock.play_wanted.connect(self.player.toggle)
        dock.speed.currentIndexChanged.connect(lambda _: self._set_speed())
        dock.mark_wanted.connect(self.mark)
        dock.flip_wanted.connect(self.flip)
        dock.memory_wanted.connect(self.set_memory)
        self.player.changed.connect(lambda: dock.show_playing(self.player.is_playing))
        looking.changed.connect(self._show)
        looking.failed.connect(lambda error: self._window.reporter.show_exception(error))
        self.recorder.cleared.connect(self._forget)
        self._window.undoing.gone.connect(looking.go_live)
        self._show()

    def fill_menu(self, menu: QMenu) -> None:
        for name in ACTIONS:
            menu.addAction(self._window.actions_by_name[name])

    def set_theme(self, theme: Theme) -> None:
        self.dock.set_theme(theme)
        for badge in self.badges().values():
            badge.set_theme(theme)

    def wait(self) -> None:
        """Let threads end before the window does."""
        self.player.stop()
        self.looking.wait()
        for part in (self.filming, self.comparing):
            if part is not None:
                part.wait()

    # ------------------------------------------------------------------------------------------ showing

    def badges(self) -> dict[MeshView, PastBadge]:
        """The sign of every view that there is now."""
        window = self._window
        others = (*(dock.view for dock in window.maps), *(pane.view for pane in window.presenter.more))
        views = (window.source.view, window.target.view, *others)
        return {view: badge_of(view, window.theme, in_corner=view in others) for view in views}

    def _show(self) -> None:
        moment = self.looking.moment
        words = ""
        if moment is not None:
            energy = f", E {moment.energy:.6g}" if math.isfinite(moment.energy) else ""
            words = f"Past: iteration {moment.iteration}{energy}"
        for view, badge in self.badges().items():
            badge.say(words if view is self._window.target.view else words and "Past")
        for name in ("past-live", "past-go-on"):
            self._window.actions_by_name[name].setEnabled(moment is not None)
        if moment is None:
            self.player.stop()

    def _forget(self) -> None:
        self.dock.slider.marked.clear()
        self.dock.show_place()
        if self.comparing is not None:
            self.comparing.close()

    # ------------------------------------------------------------------------------------------ deeds

    @property
    def present(self) -> Moment | None:
        """The moment that is shown; the newest while it is live."""
        record = self.recorder.record
        return record[self.looking.index] if len(record) else None

    def mark(self, name: str) -> None:
        """Call the moment that is shown A or B; once more lets it go."""
        marked, moment = self.dock.slider.marked, self.present
        if moment is None:
            return
        if marked.get(name) is moment:
            del marked[name]
        else:
            marked[name] = moment
        self.dock.show_place()
        if self.comparing is not None:
            self.comparing.measure()

    def flip(self) -> None:
        """Show B where A is shown, else A."""
        marked = self.dock.slider.marked
        if len(marked) == 2:
            self.looking.show_moment(marked["B" if self.looking.moment is marked["A"] else "A"])

    def go_on(self) -> None:
        """Take the map that is shown, with its anchors; a step that can be undone."""
        moment, measurer = self.looking.moment, self.looking.measurer()
        if moment is None or measurer is None or self._document.is_held:
            return
        if not moment.is_exact and not moment.inverted_count:
            flipped = int(np.count_nonzero(measurer.singular_values(moment).inverted))
            if flipped:
                self._window.error_bar.show_message(
                    f"This map was kept in single precision only, in which {flipped} of its simplices invert; "
                    "go on from a moment beside it, or from one with a note."
                )
                return
        session = with_anchors(self._document.session, anchors_of(moment))
        positions = moment.positions
        self._document.changing.emit("Take a map", "")  # ends looking back, too
        self._document.restore(session, positions)

    def compare(self) -> None:
        """Show how A and B differ."""
        if self.comparing is None:
            from workbench.app.timeline.comparing import Comparing  # late: it is not needed for the first picture

            self.comparing = Comparing(self._window, self)
        self.comparing.ask()

    def film(self) -> None:
        """Ask for a film of the time line."""
        if self.filming is None:
            from workbench.app.timeline.filming import Filming  # late: it is not needed for the first picture

            self.filming = Filming(self._window, self)
        self.filming.ask()

    def set_memory(self, megabytes: int) -> None:
        """Keep maps of so many megabytes at most, from now on and in the next window."""
        self._window.settings.time_line_memory = megabytes
        self.recorder.record.set_limit(megabytes * 2**20)
        self.dock.show_place()

    def _set_speed(self) -> None:
        self.player.speed = float(self.dock.speed.currentData())
