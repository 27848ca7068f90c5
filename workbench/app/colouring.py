"""How each view is coloured: a pattern or a quantity; and what of each map is therefore watched."""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QObject

from workbench.app.docks.quantity_dock import QuantityDock
from workbench.app.document import Document
from workbench.app.quantity_book import QuantityBook
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
        super().__init__()
        self._texturing = texturing
        self._document = document
        self._book = book
        self._styles = {pane: pane.chooser.current for pane in panes}
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

    def add(self, pane: ViewPane) -> None:
        """Colour one more view."""
        self._styles[pane] = pane.chooser.current
        self.apply(pane)
        self.watch()

    def remove(self, pane: ViewPane) -> None:
        """A view is gone."""
        del self._styles[pane]
        self.watch()

    def style_of(self, pane: ViewPane) -> str:
        """Name of a pattern, or id of a quantity."""
        return self._styles[pane]

    def set_style(self, pane: ViewPane, style: str) -> None:
        """Colour a view by a pattern or by a quantity; its values come with the next snapshot."""
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
        for id in self.shown():
            colour_range = self._book.range_of(id)
            values = snapshot.fields.get(colour_range.quantity.field)
            if values is not None:
                colour_range.take(values)

    def apply(self, pane: ViewPane) -> None:
        """Give a view the colours of its style; a new mesh has none yet."""
        style, surface = self._styles[pane], pane.view.surface
        is_pattern = style in PATTERNS
        pane.show_colours(None if is_pattern else self._book.range_of(style))
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
        for colour_range in self._book.ranges():
            colour_range.forget()

    def _texture_changed(self) -> None:
        for pane, style in self._styles.items():
            if style in PATTERNS:
                self.apply(pane)

    def _range_changed(self, id: str) -> None:
        for pane, style in self._styles.items():
            if style == id:
                self.apply(pane)
