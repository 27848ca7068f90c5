"""Splitting the views of the window: what the menus do, and the panes that come and go."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, QSignalBlocker, Signal
from PySide6.QtWidgets import QMenu, QWidget

from workbench.app.handling.anchor_tool import AnchorTool
from workbench.app.splitting.camera_links import CameraLinks
from workbench.app.splitting.leaf import Leaf
from workbench.app.splitting.pane_grid import CLOSED, PaneGrid, Side, Tree
from workbench.app.splitting.pane_tools import PaneTools
from workbench.app.splitting.split_pane import SIDES, SplitPane
from workbench.app.views.mesh_view import MeshView
from workbench.session import view_schema

if TYPE_CHECKING:
    from workbench.app.docks.colour_map_dock import ColourMapDock
    from workbench.app.main_window import MainWindow

MOST_PANES = 6
"""Panes that may be split off: with source and target they make eight views, beside the colour maps."""
DOCKED = 0.6
"""Part of the window that a colour map may take when it is split: other panels make way."""
NO_ROOM = "There is no room for one more view here: split another one, close a panel or enlarge the window."
FULL = f"There are {MOST_PANES + 2} views, as many as there can be; close one first."


class Splitting(QObject):
    """Every view of the window as a leaf of a grid: one grid in the centre, one in each colour map.

    Source and target are hidden when they are closed, as everything else is built on them; panes are gone.
    """

    changed = Signal()
    """Other panes, or other links, than before."""
    pane_made = Signal(object)
    """A `Leaf` that is new"""
    pane_gone = Signal(object)

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self.links = CameraLinks(self)
        self.grids: dict[str, PaneGrid] = {"centre": window.grid}
        self._leaves: dict[str, Leaf] = {}
        self.active = "target"
        for name, pane, is_source in (("source", window.source, True), ("target", window.target, False)):
            pane.setObjectName(name)
            leaf = Leaf(name, pane, pane.view, is_source, pane)
            pane.add_to_header(self._add(leaf, pane.header, is_linked=True))
        for dock in window.maps:
            self._add_dock(dock)
        window.theme_switch.changed.connect(self.set_theme)
        actions = window.actions_by_name
        actions["split-right"].triggered.connect(lambda _=False: self.split(self.active, "right"))
        actions["split-below"].triggered.connect(lambda _=False: self.split(self.active, "below"))
        actions["close-view"].triggered.connect(lambda _=False: self.close_view(self.active))

    def _add_dock(self, dock: ColourMapDock) -> None:
        name = dock.objectName()
        body = dock.widget()
        body.setObjectName(name)
        grid = self.grids[name] = PaneGrid(body)
        dock.setWidget(grid.root)
        title = dock.titleBarWidget()
        title.add(self._add(Leaf(name, body, dock.view, False, None), title, is_linked=False))  # type: ignore[attr-defined]

    def _add(self, leaf: Leaf, line: QWidget, *, is_linked: bool) -> PaneTools:
        """The buttons for a view, whose title stands in `line`."""
        self._leaves[leaf.name] = leaf
        tools = PaneTools(partial(self.fill_menu, leaf.name), self._window.theme, line)
        leaf.tools = tools
        self.links.add(leaf.view, is_source=leaf.is_source, is_on=is_linked)
        tools.chain.setChecked(is_linked)
        tools.link_toggled.connect(partial(self._link, leaf))
        leaf.view.overlay.pressed.connect(partial(self._activate, leaf.name))
        return tools

    def _activate(self, name: str, _: object = None) -> None:
        self.active = name

    def _link(self, leaf: Leaf, on: bool) -> None:
        self.links.set_on(leaf.view, on)
        self.changed.emit()

    # ------------------------------------------------------------------------------------------ what there is

    @property
    def leaves(self) -> tuple[Leaf, ...]:
        """All views, source and target first."""
        return tuple(self._leaves.values())

    @property
    def panes(self) -> tuple[SplitPane, ...]:
        """The panes that were split off."""
        return tuple(leaf.pane for leaf in self.leaves if isinstance(leaf.pane, SplitPane))

    def __getitem__(self, name: str) -> Leaf:
        return self._leaves[name]

    def __contains__(self, name: object) -> bool:
        return name in self._leaves

    def _grid_of(self, leaf: Leaf) -> PaneGrid:
        return next(grid for grid in self.grids.values() if leaf.widget in grid)

    def is_visible(self, name: str) -> bool:
        """Whether a view of the centre has not been closed."""
        return self._leaves[name].widget.property(CLOSED) is not True

    # ------------------------------------------------------------------------------------------ splitting

    def split(self, name: str, side: Side) -> SplitPane | None:
        """A new view beside one, which shows the same at first; None where there are as many as can be."""
        if len(self.panes) >= MOST_PANES:
            self._window.status.say(FULL)
            return None
        grid = self._grid_of(leaf := self._leaves[name])
        room = self._window.size() * DOCKED if grid is not self.grids["centre"] else grid.root.size()
        leaf = self._leaves[name]
        pane = self.make(
            self._free_name(), leaf.pane.side if isinstance(leaf.pane, SplitPane) else "source" if leaf.is_source else "target"
        )
        grid.split(leaf.widget, side, pane)
        self._begin(pane, self.shown_in(leaf))
        _look_alike(pane.view, leaf.view)
        if not grid.fits(room):
            self.close_view(pane.objectName())
            self._window.status.say(NO_ROOM)
            return None
        self.active = pane.objectName()
        self.changed.emit()
        return pane

    def _free_name(self) -> str:
        return next(name for i in range(1, MOST_PANES + 2) if (name := f"pane-{i}") not in self._leaves)

    def shown_in(self, leaf: Leaf) -> str:
        """Name of a pattern, or id of a quantity."""
        if leaf.pane is not None:
            return self._window.colouring.style_of(leaf.pane)
        return next(dock.quantity for dock in self._window.maps if dock.objectName() == leaf.name)

    def make(self, name: str, side: str) -> SplitPane:
        """The one factory of panes; `_begin` then fills what was put into a grid."""
        window = self._window
        like = window.source if side == "source" else window.target
        pane = SplitPane(name, side, like.styles, window.quantities, window.theme, window)
        leaf = Leaf(name, pane, pane.view, pane.is_source, pane)
        pane.add_to_header(self._add(leaf, pane.header, is_linked=True))
        pane.style_chosen.connect(lambda style: window.colouring.set_style(pane, style))
        pane.side_chosen.connect(partial(self._change_side, name))
        return pane

    def _begin(self, pane: SplitPane, shown: str) -> None:
        """Draw in a pane, and let the mouse at it."""
        window, leaf = self._window, self._leaves[pane.objectName()]
        if pane.offers(shown) or shown in window.quantities:
            pane.set_style(shown)
        leaf.tool = AnchorTool(
            pane.view, is_target=not pane.is_source, may_anchor=lambda: window.document.positions is not None
        )
        window.connect_tool(leaf.tool)
        window.presenter.add_pane(pane)
        window.look.linked.add(pane.view)
        window.carried.add_pane(pane)
        window.inspector.follow_too(pane.view)
        self.pane_made.emit(leaf)

    def _change_side(self, name: str, side: str) -> None:
        """Show the source in the place of the target, or the other way round."""
        leaf = self._leaves[name]
        if side not in SIDES or not isinstance(leaf.pane, SplitPane) or leaf.pane.side == side:
            return
        shown = self.shown_in(leaf)
        grid = self._grid_of(leaf)
        self._end(leaf)
        pane = self.make(name, side)
        grid.replace(leaf.widget, pane)
        leaf.widget.deleteLater()
        self._begin(pane, shown)
        _look_alike(pane.view, self._leaves["source" if side == "source" else "target"].view)
        self.changed.emit()

    def close_view(self, name: str) -> None:
        """Close a view, but for the last one of the centre."""
        leaf = self._leaves[name]
        in_centre = leaf.widget in self.grids["centre"]
        if in_centre and sum(self.is_visible(other.objectName()) for other in self.grids["centre"].leaves()) == 1:
            self._window.status.say("This is the last view; split it before it is closed.")
            return
        if leaf.pane is None:
            next(dock for dock in self._window.maps if dock.objectName() == name).close()
        elif isinstance(leaf.pane, SplitPane):
            grid = self._grid_of(leaf)
            self._end(leaf)
            grid.take(leaf.widget)
            leaf.widget.deleteLater()
        else:
            self.set_visible(name, False)
        if self.active == name:
            self.active = next(other.objectName() for other in self.grids["centre"].leaves() if other.isVisible())
        self.changed.emit()

    def set_visible(self, name: str, visible: bool) -> None:
        """Show source or target again, or hide it; the last view of the centre stays."""
        widget, window = self._leaves[name].widget, self._window
        for own, tool in (("source", window.source_tool), ("target", window.target_tool)):
            if name == own and not visible:
                tool.cancel()
        widget.setProperty(CLOSED, not visible)
        widget.setVisible(visible)
        self._window.turns.all_stale()
        self.changed.emit()

    def _end(self, leaf: Leaf) -> None:
        """Let go of a pane; its widget is still where it was."""
        assert isinstance(leaf.pane, SplitPane)
        self.pane_gone.emit(leaf)
        window = self._window
        window.carried.remove_pane(leaf.pane)
        window.look.linked.remove(leaf.view)
        window.presenter.remove_pane(leaf.pane)
        self.links.remove(leaf.view)
        del self._leaves[leaf.name]
        if leaf.tool is not None:
            leaf.tool.cancel()  # the hand cannot let go in a view that is gone
            leaf.tool.let_go()
            window.document.opened.disconnect(leaf.tool.let_go)
        leaf.view.close_view()

    # ------------------------------------------------------------------------------------------ memory

    def layout(self) -> dict[str, Tree]:
        """How each grid is arranged that is not as at the beginning."""
        has_panes = bool(self.panes)
        return {name: grid.state() for name, grid in self.grids.items() if has_panes and len(grid.leaves()) > 1}

    def arrange(self, layout: Mapping[str, Tree], sides: Mapping[str, str]) -> None:
        """Arrange the views as `layout` gave it; `sides` says what new panes show. Trees that lack a view stay away."""
        for pane in self.panes:
            self.set_visible_all()
            self.close_view(pane.objectName())
        for name, grid in self.grids.items():
            if len(grid.leaves()) > 1:
                grid.reset()
            fixed = {leaf.objectName(): leaf for leaf in grid.leaves()}
            tree = layout.get(name)
            named = [] if tree is None else list(view_schema.leaves(tree))
            wanted = [leaf for leaf in named if leaf not in fixed]
            is_sound = set(fixed) <= set(named) and all(leaf in sides for leaf in wanted)
            if tree is None or not is_sound or len(self.panes) + len(wanted) > MOST_PANES:
                continue
            made = {leaf: self.make(leaf, sides[leaf]) for leaf in wanted}
            grid.arrange(tree, fixed | made)
            for pane in made.values():
                self._begin(pane, "plain")
        self.changed.emit()

    def set_visible_all(self) -> None:
        """Show source and target."""
        for name in ("source", "target"):
            if not self.is_visible(name):
                self.set_visible(name, True)

    @staticmethod
    def begins_linked(leaf: Leaf) -> bool:
        """Whether the camera of a view is linked until someone says otherwise: colour maps show everything."""
        return leaf.pane is not None

    def note_linked(self, leaf: Leaf, on: bool) -> None:
        """Link a view or not, and leave its camera as it is."""
        assert leaf.tools is not None
        self.links.note(leaf.view, on)
        with QSignalBlocker(leaf.tools):
            leaf.tools.chain.setChecked(on)

    # ------------------------------------------------------------------------------------------ menus

    def fill_menu(self, name: str, menu: QMenu) -> None:
        """What can be done to a view."""
        menu.addAction("Split &right").triggered.connect(lambda: self.split(name, "right"))
        menu.addAction("Split &below").triggered.connect(lambda: self.split(name, "below"))
        menu.addAction("&Close this view").triggered.connect(lambda: self.close_view(name))
        menu.addSeparator()
        chain = menu.addAction("&Link the camera")
        chain.setCheckable(True)
        tools = self._leaves[name].tools
        assert tools is not None
        chain.setChecked(tools.chain.isChecked())
        chain.toggled.connect(tools.chain.setChecked)
        menu.addAction("&Fit").triggered.connect(self._leaves[name].view.fit)
        menu.addSeparator()
        self._window.drawing.fill_menu(self._leaves[name], menu)

    def fill_views(self, menu: QMenu) -> None:
        """Source and target, to be shown again."""
        menu.clear()
        for name, text in (("source", SIDES["source"]), ("target", SIDES["target"])):
            action = menu.addAction(text)
            action.setCheckable(True)
            action.setChecked(self.is_visible(name))
            action.toggled.connect(lambda on, n=name: self.set_visible(n, True) if on else self.close_view(n))

    # ------------------------------------------------------------------------------------------ end

    def set_theme(self, theme: Any) -> None:
        for leaf in self.leaves:
            if leaf.tools is not None:
                leaf.tools.set_theme(theme)
        for pane in self.panes:
            pane.set_theme(theme)

    def set_drawing(self, wanted: bool) -> None:
        for pane in self.panes:
            pane.view.is_drawing = wanted

    def close(self) -> None:
        """Before the window ends."""
        self.links.stop()
        self._window.theme_switch.changed.disconnect(self.set_theme)
        for pane in self.panes:
            pane.view.close_view()


def _look_alike(view: MeshView, other: MeshView) -> None:
    """Look from where another view of the same kind does; what shows everything goes on doing so."""
    if other.geometry_shown is not None:
        view.set_camera(replace(other.camera), fits=other.shows_everything)
        if other.shows_everything:
            view.fit()
