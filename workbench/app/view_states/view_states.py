"""The views of the window as one plain object, and back."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, replace
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject

from workbench.app.splitting.leaf import Leaf
from workbench.app.splitting.split_pane import SplitPane
from workbench.app.view_states.camera_state import camera_state, take_camera_state
from workbench.app.view_states.range_state import range_state, take_range_state
from workbench.app.view_states.words import quantity_meant, words_of
from workbench.app.views.drawing_choices import DrawingChoices
from workbench.core.errors import WorkbenchError
from workbench.session import view_schema

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

Plain = dict[str, Any]


class ViewStates(QObject):
    """For a session with all that belongs to its mesh: cameras, ends of ranges. For the next start without."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._wanted: Plain | None = None
        self._waits_for_mesh = False
        self._waiting: Plain = {}
        self._begins = {leaf.name: window.splitting.shown_in(leaf) for leaf in window.splitting.leaves}
        desk = window.sessions.desk
        desk.views = lambda: self.state(of_mesh=True)
        desk.views_found.connect(self.want)
        window.document.opened.connect(self._mesh_came)
        window.document.snapshot_taken.connect(self._map_came)
        window.quantities.listed.connect(self._show_waiting)

    # ------------------------------------------------------------------------------------------ keeping

    def state(self, *, of_mesh: bool) -> Plain:
        """What differs from the views of a fresh window."""
        window = self._window
        panes = {leaf.name: self._state_of(leaf, of_mesh=of_mesh) for leaf in window.splitting.leaves}
        draws = _differing(window.drawing.choices, DrawingChoices())
        found: Plain = {
            "layout": window.splitting.layout(),
            "panes": {name: state for name, state in panes.items() if state},
            "draws": draws,
        }
        if window.readings.is_on:
            found["readings"] = True
        if of_mesh:
            ranges = {r.quantity.id: range_state(r, with_ends=True) for r in window.quantities.ranges()}
            found["ranges"] = {id: state for id, state in ranges.items() if state}
            found |= {"pattern": window.texturing.kept(), "glyphs": window.glyphs.kept()}
            found["solid"] = window.volume.seen()
        return {name: part for name, part in found.items() if part}

    def _state_of(self, leaf: Leaf, *, of_mesh: bool) -> Plain:
        splitting, book = self._window.splitting, self._window.quantities
        is_pane = isinstance(leaf.pane, SplitPane)
        found: Plain = {}
        if isinstance(leaf.pane, SplitPane):
            found["side"] = leaf.pane.side
        id = splitting.shown_in(leaf)
        if is_pane or (of_mesh and id != self._begins[leaf.name]):
            found["shows"] = words_of(book[id]) if id in book else id
        if leaf.name in self._waiting:
            found["shows"] = self._waiting[leaf.name]
        if splitting.links.is_on(leaf.view) is not splitting.begins_linked(leaf):
            found["linked"] = splitting.links.is_on(leaf.view)
        if not splitting.is_visible(leaf.name):
            found["closed"] = True
        draws = _differing(leaf.view.drawing, self._usual(leaf))
        if draws:
            found["draws"] = draws
        own = self._own_range(leaf)
        if of_mesh and own is not None:
            found["range"] = range_state(own, with_ends=True)
        if of_mesh and leaf.view.geometry_shown is not None:
            camera = camera_state(leaf.view)
            if "focal" in camera or not leaf.view.geometry_shown.is_flat:
                found["camera"] = camera
        return found

    def _usual(self, leaf: Leaf) -> DrawingChoices:
        """What a view draws that has no choices of its own."""
        choices = self._window.drawing.choices
        return choices if leaf.pane is not None else replace(choices, edges=None)

    def _own_range(self, leaf: Leaf) -> Any:
        if leaf.pane is not None:
            return self._window.colouring.own_range(leaf.pane)
        return self._dock_of(leaf).own_range

    def _dock_of(self, leaf: Leaf) -> Any:
        return next(dock for dock in self._window.maps if dock.objectName() == leaf.name)

    # ------------------------------------------------------------------------------------------ taking up

    def restore(self, state: object) -> None:
        """Take up what was kept for this start; what is no state is passed over."""
        try:
            checked = view_schema.views("views", state)
        except WorkbenchError:
            return
        self.apply(checked)

    def want(self, views: Mapping[str, Any] | None) -> None:
        """Take up the views of a session once its map is on the screen; None leaves the window as it is."""
        self._wanted = None if views is None else dict(views)
        self._waits_for_mesh = bool(self._window.document.opening_source)

    def _mesh_came(self) -> None:
        self._waits_for_mesh = False

    def _map_came(self) -> None:
        is_drawn = self._window.target.view.geometry_shown is not None  # not the map of the mesh before
        if self._wanted is not None and is_drawn and not self._waits_for_mesh:
            wanted, self._wanted = self._wanted, None
            self.apply(wanted, resets=True)

    def apply(self, state: Plain, *, resets: bool = False) -> None:
        """Arrange the views as a checked state says, and show in each what it says.

        Of what it says nothing all is as in a fresh window where it `resets`, else as it was.
        """
        window, splitting = self._window, self._window.splitting
        panes = state.get("panes", {})
        sides = {name: pane["side"] for name, pane in panes.items() if "side" in pane}
        splitting.arrange(state.get("layout", {}), sides)
        window.drawing.take(DrawingChoices(**state.get("draws", {})))
        window.actions_by_name["readings"].setChecked(state.get("readings") is True)
        ranges = state.get("ranges", {})
        if resets:
            ranges = {r.quantity.id: {} for r in window.quantities.ranges()} | ranges
            window.texturing.take_kept(state.get("pattern", {}))
            window.glyphs.take_kept(state.get("glyphs", {}))
            window.volume.see(state.get("solid", {}))
        for id, of_range in ranges.items():
            if id in window.quantities:
                take_range_state(window.quantities.range_of(id), of_range)
        self._waiting = {}
        for leaf in splitting.leaves:
            pane = panes.get(leaf.name, {})
            if resets and leaf.name in self._begins:
                pane = {"shows": self._begins[leaf.name]} | pane
            self._apply_to(leaf, pane)
        # linked views follow others: cameras come while none is linked
        for leaf in splitting.leaves:
            splitting.note_linked(leaf, False)
        for leaf in splitting.leaves:
            if resets:
                leaf.view.fit()
            take_camera_state(leaf.view, panes.get(leaf.name, {}).get("camera", {}))
        for leaf in splitting.leaves:
            splitting.note_linked(leaf, panes.get(leaf.name, {}).get("linked", splitting.begins_linked(leaf)))

    def _apply_to(self, leaf: Leaf, pane: Plain) -> None:
        window = self._window
        if "shows" in pane:
            self._show(leaf, pane["shows"])
        window.drawing.set_in(leaf, replace(self._usual(leaf), **pane.get("draws", {})))
        if leaf.name in ("source", "target"):
            window.splitting.set_visible(leaf.name, pane.get("closed") is not True)
        if "range" in pane and leaf.name not in self._waiting:
            owner = self._dock_of(leaf) if leaf.pane is None else None
            if owner is not None:
                owner.set_own(True)
            elif leaf.pane is not None:
                window.colouring.set_own(leaf.pane, True)
            own = self._own_range(leaf)
            if own is not None:
                take_range_state(own, pane["range"])

    def _show(self, leaf: Leaf, words: object) -> None:
        """Show what is meant; what needs the methods waits until they are listed."""
        book, pane = self._window.quantities, leaf.pane
        is_pattern = isinstance(words, str) and pane is not None and pane.offers(words)
        id = str(words) if is_pattern else quantity_meant(words, book)
        if id is None:
            if not book.is_listed:
                self._waiting[leaf.name] = words
        elif pane is not None:
            self._window.colouring.set_style(pane, id)
        else:
            self._dock_of(leaf).show_quantity(id)

    def _show_waiting(self) -> None:
        waiting, self._waiting = self._waiting, {}
        for name, words in waiting.items():
            if name in self._window.splitting:
                self._show(self._window.splitting[name], words)


def _differing(choices: DrawingChoices, usual: DrawingChoices) -> Plain:
    return {name: value for name, value in asdict(choices).items() if value != getattr(usual, name)}
