"""How each view is coloured: a pattern or a quantity; and what of each map is therefore watched."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QObject

from workbench.app.colouring.colour_range import ColourRange
from workbench.app.docks.quantity_dock import QuantityDock
from workbench.app.document.document import Document
from workbench.app.quantities.quantity_book import QuantityBook
from workbench.app.texturing.texturing import Texturing
from workbench.app.views.pane import ViewPane
from workbench.app.views.textures import PATTERNS
from workbench.engine.messages import Snapshot

OWNER = "views"
"""Name under which the views watch."""


class Colouring(QObject):
    """The styles of the two views, the quantities of the panels, and their ranges."""

    def __init__(
        self,
        document: Document,
        book: QuantityBook,
        panes: Iterable[ViewPane],
        panels: Iterable[QuantityDock],
        texturing: Texturing,
    ) -> None:
        super().__init__(document)
        self._texturing = texturing
        self._document = document
        self._book = book
        self._styles = {pane: pane.chooser.current for pane in panes}
        self._own: dict[ViewPane, ColourRange] = {}
        self._panels = list(panels)
        book.range_changed.connect(self._range_changed)
        texturing.changed.connect(self._texture_changed)
        document.opened.connect(self._begin)
        document.session_changed.connect(self._take_choice)
        book.listed.connect(self._take_choice)
        book.replaced.connect(self._replace)
        for panel in self._panels:
            panel.quantity_changed.connect(self.watch)
            panel.visibilityChanged.connect(lambda _: self.watch())
        for pane in self._styles:
            self._offer_own(pane)

    def add(self, pane: ViewPane) -> None:
        """Colour one more view."""
        self._styles[pane] = pane.chooser.current
        self._offer_own(pane)
        self.apply(pane)
        self.watch()

    def remove(self, pane: ViewPane) -> None:
        """A view is gone."""
        del self._styles[pane]
        self._own.pop(pane, None)
        self.watch()

    def _offer_own(self, pane: ViewPane) -> None:
        pane.legend.bar.is_own = False
        pane.legend.bar.own_wanted.connect(lambda on: self.set_own(pane, on))

    def range_of(self, pane: ViewPane) -> ColourRange:
        """The range of a view that shows a quantity: one that all views of the quantity share, or its own."""
        own = self._own.get(pane)
        return own if own is not None else self._book.range_of(self._styles[pane])

    def own_range(self, pane: ViewPane) -> ColourRange | None:
        """The range that is this view's own; None where it shares one."""
        return self._own.get(pane)

    def set_own(self, pane: ViewPane, on: bool) -> None:
        """Give a view a range of its own, which is as the shared one at first, or take it away."""
        style = self._styles[pane]
        if not on or style in PATTERNS:
            self._own.pop(pane, None)
        elif pane not in self._own:
            self._own[pane] = own = self._book.range_of(style).copy(pane)
            own.changed.connect(lambda: self.apply(pane))
        pane.legend.bar.is_own = pane in self._own
        self.apply(pane)

    def style_of(self, pane: ViewPane) -> str:
        """Name of a pattern, or id of a quantity."""
        return self._styles[pane]

    def set_style(self, pane: ViewPane, style: str) -> None:
        """Colour a view by a pattern or by a quantity; its values come with the next snapshot."""
        if style != self._styles[pane]:
            self._own.pop(pane, None)
            pane.legend.bar.is_own = False
        self._styles[pane] = style
        pane.set_style(style)
        self.apply(pane)
        self.watch()

    def _replace(self, old: str, new: str) -> None:
        """Show another quantity wherever this one was shown."""
        for pane, style in list(self._styles.items()):
            if style == old:
                self.set_style(pane, new)
        for panel in self._panels:
            if panel.quantity == old:
                panel.show_quantity(new)

    def shown(self) -> set[str]:
        """Ids of the quantities that are to be seen somewhere."""
        in_views = {style for style in self._styles.values() if style not in PATTERNS}
        return in_views | {panel.quantity for panel in self._panels if panel.isVisible()}

    def watch(self) -> None:
        """Ask for what is shown, and for nothing else."""
        self._document.watch(OWNER, [self._book.range_of(id).quantity for id in sorted(self.shown())])

    def take(self, snapshot: Snapshot) -> None:
        """Fit the ranges of what is shown to a map."""
        for colour_range in (*(self._book.range_of(id) for id in self.shown()), *self._own_ranges()):
            values = snapshot.fields.get(colour_range.quantity.field)
            if values is not None:
                colour_range.take(values, at_rest=snapshot.phase in ("idle", "finished"))

    def apply(self, pane: ViewPane) -> None:
        """Give a view the colours of its style; a new mesh has none yet."""
        style, surface = self._styles[pane], pane.view.surface
        is_pattern = style in PATTERNS
        pane.show_colours(None if is_pattern else self.range_of(pane))
        if surface is not None and is_pattern:
            surface.show_pattern(self._texturing.texture(style))  # type: ignore[arg-type]
        self.paint(pane)
        pane.view.refresh()

    def paint(self, pane: ViewPane) -> None:
        """Bring the colours of a view in line with the newest map."""
        snapshot, surface = self._document.shown, pane.view.surface
        if snapshot is None or surface is None:
            return
        surface.lay_texture()
        style = self._styles[pane]
        values = None if style in PATTERNS else snapshot.fields.get(self._book.range_of(style).quantity.field)
        surface.set_values(values, snapshot.inverted)
        if values is not None:
            pane.legend.show_values(values)

    def _take_choice(self) -> None:
        """The distortion in force may be another one. Before the methods are found there is nothing to look it up in."""
        if not self._book.is_listed:
            return
        session = self._document.session
        self._book.set_in_force(session.distortion, session.distortion_parameters)
        self.watch()

    def _begin(self) -> None:
        """Another mesh, maybe of another dimension."""
        if self._document.mesh is not None:
            self._book.set_dimension(self._document.mesh.dimension)
        for colour_range in (*self._book.ranges(), *self._own_ranges()):
            colour_range.forget()

    def hold_own(self, locked: bool) -> None:
        """Keep the ranges that views have for themselves as they are, or let them follow their values."""
        for colour_range in self._own_ranges():
            colour_range.hold(locked)

    def _own_ranges(self) -> list[ColourRange]:
        panels = [panel.own_range for panel in self._panels if panel.own_range is not None]
        return [*self._own.values(), *panels]

    def _texture_changed(self) -> None:
        for pane, style in self._styles.items():
            if style in PATTERNS:
                self.apply(pane)

    def _range_changed(self, id: str) -> None:
        for pane, style in self._styles.items():
            if style == id:
                if pane in self._own:
                    self._own[pane].quantity = self._book[id]
                self.apply(pane)
