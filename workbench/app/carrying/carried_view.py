"""The carried surface of the window: read on a thread, drawn in source and target with every map, saved."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from PySide6.QtCore import QObject, Signal

from workbench.app.background import Background
from workbench.app.carrying.carried_bar import FIRST_OPACITY, CarriedBar
from workbench.app.carrying.carried_layer import CarriedLayer
from workbench.app.carrying.carried_quantities import CARRIED_QUANTITIES
from workbench.app.colouring.colour_range import ColourRange
from workbench.app.document.document import Document
from workbench.app.splitting.split_pane import SplitPane
from workbench.app.views.pane import ViewPane
from workbench.core.arrays import Floats
from workbench.core.mesh import Mesh

if TYPE_CHECKING:
    from workbench.core.carried_surface import CarriedSurface

NOTHING = "Nothing is carried: File > Carry a surface puts one into a solid."


class CarriedView(QObject):
    """One surface at a time; another mesh lets it go."""

    told = Signal(str)
    """What has been done, for the status bar."""
    refused = Signal(object)
    """The exception that kept a surface from being read or written."""

    def __init__(
        self, document: Document, panes: Sequence[ViewPane], bar_below: ViewPane, parent: QObject | None = None
    ) -> None:
        """`panes`: source, target."""
        super().__init__(parent)
        self._document = document
        self._panes = list(panes)
        self._ranges = {quantity.id: ColourRange(quantity) for quantity in CARRIED_QUANTITIES}
        self.range = next(iter(self._ranges.values()))
        for colour_range in self._ranges.values():
            colour_range.setParent(self)
            colour_range.changed.connect(self._show_range)
        self.bar = CarriedBar(CARRIED_QUANTITIES, self.range, bar_below)
        bar_below.add_below(self.bar)
        self.surface: CarriedSurface | None = None
        self.source = ""
        self._layers: list[CarriedLayer] = []
        self._work: Background | None = None
        self.opacity = FIRST_OPACITY
        self.bar.opacity_chosen.connect(self.set_opacity)
        self.bar.dismissed.connect(self.let_go)
        self.bar.quantity_chosen.connect(self.show_quantity)
        document.opened.connect(self.let_go)
        document.shown_changed.connect(self.show_map)
        document.session_changed.connect(self._follow)

    @property
    def is_possible(self) -> bool:
        """Whether there is a solid to carry a surface."""
        return self._document.mesh is not None and self._document.kind == "volume"

    @property
    def is_busy(self) -> bool:
        return self._work is not None

    # ------------------------------------------------------------------------------------------ reading and writing

    def read(self, source: str) -> None:
        """Carry the surface of a file, or `sample:ID`; places are found on a thread while the window goes on.

        A sample lies in the solid bar, and is scaled into the box of any other solid.
        """
        mesh = self._document.mesh
        if mesh is None or not self.is_possible or self.is_busy:
            return
        self.told.emit("Looking where the surface lies in the solid…")

        def work() -> CarriedSurface:
            from workbench.engine.carried_source import carry_source
            from workbench.engine.carrying_kernels import compile_carrying

            compile_carrying()
            return carry_source(source, mesh)

        self._begin(work, lambda found: self._take(found, mesh, source))

    def save(self, path: str) -> None:
        """Write the surface as it is now."""
        positions = self._document.positions
        if self.surface is None or positions is None or self.is_busy:
            return
        surface = self.surface

        def work() -> None:
            moved = surface.at(positions)
            from workbench.io.write import write_surface

            write_surface(path, surface.surface, moved, surface.table(moved))

        self._begin(work, lambda _: self.told.emit(f"Saved {path}."))

    def _begin(self, work: Any, then: Any) -> None:
        self._work = Background(work, self)

        def end(deed: Any, result: Any) -> None:
            self._work = None
            deed(result)

        self._work.finished.connect(lambda result: end(then, result))
        self._work.failed.connect(lambda error: end(self._fail, error))
        self._work.start()

    def _fail(self, error: Exception) -> None:
        document = self._document
        document.session = replace(document.session, carried=self.source)  # it is not asked for again
        self.refused.emit(error)

    def _follow(self) -> None:
        """Carry what the session names: an undo, or a session that was opened, may name another one."""
        wanted = self._document.session.carried
        if wanted == self.source or self.is_busy:
            return
        if wanted:
            self.read(wanted)
        else:
            self._drop()

    def _take(self, found: CarriedSurface, mesh: Mesh, source: str) -> None:
        if self._document.mesh is not mesh:
            return  # another mesh was opened meanwhile
        self._drop()
        self.surface, self.source = found, source
        self._document.choose(carried=source)
        surface = found.surface
        self._layers = [CarriedLayer(pane.view, surface.simplices, surface.vertex_count) for pane in self._panes]
        for colour_range in self._ranges.values():
            colour_range.forget()
        self.bar.caption.setText(f"{Path(surface.name).stem}, {surface.simplex_count} triangles")
        self._move(surface.vertices, of_source=True)
        self.bar.show()
        self.set_opacity(self.opacity)
        self.show_map()
        self._show_range()
        self.told.emit(found.note or f"The map carries {surface.name}.")

    # ------------------------------------------------------------------------------------------ drawing

    def show_map(self) -> None:
        """Bring the surface in line with the newest map; the source is drawn again when its turn comes."""
        shown = self._document.shown
        if self.surface is None or shown is None:
            return
        moved = self.surface.at(shown.positions)
        values = self.values(moved)
        self.range.take(values)
        self.bar.legend.show_values(values)
        for layer in self._layers:
            layer.paint(values)
        self._move(moved, of_source=False)

    def show_quantity(self, id: str) -> None:
        """Colour the surface by another of its measures."""
        self.range = self._ranges[id]
        self.show_map()
        self._show_range()

    def values(self, moved: Floats) -> Floats:
        """What is shown of the surface's own map (m,) where its vertices are at `moved` (k, 3)."""
        assert self.surface is not None
        measure = self.range.quantity.measure
        return self.surface.measures(moved, (measure,))[measure.id]

    def _show_range(self) -> None:
        self.bar.legend.show_range(self.range)
        for layer in self._layers:
            layer.show_range(self.range)
        self._refresh()

    # ------------------------------------------------------------------------------------------ panes of splits

    def add_pane(self, pane: ViewPane) -> None:
        """Draw the surface in one more view."""
        self._panes.append(pane)
        if self.surface is not None:
            layer = CarriedLayer(pane.view, self.surface.surface.simplices, self.surface.surface.vertex_count)
            self._layers.append(layer)
            self._move(self.surface.surface.vertices, of_source=True)
            self.show_map()
            layer.show_range(self.range)
        self._set_solid(self.opacity)

    def remove_pane(self, pane: ViewPane) -> None:
        """A view is gone."""
        row = self._panes.index(pane)
        del self._panes[row]
        if self._layers:
            self._layers.pop(row).remove()

    def _is_source(self, pane: ViewPane) -> bool:
        return pane.is_source if isinstance(pane, SplitPane) else pane is self._panes[0]

    def _move(self, vertices: Floats, *, of_source: bool) -> None:
        """Put the surface (k, 3) where it is in the source, or in the map."""
        for pane, layer in zip(self._panes, self._layers, strict=False):
            if self._is_source(pane) is of_source:
                layer.move(vertices)
                if not of_source:
                    pane.view.refresh()

    def set_opacity(self, opacity: float) -> None:
        """How much of the solid is seen while a surface is carried: 0 nothing, 1 nothing but the solid."""
        self.opacity = opacity
        self._set_solid(opacity)

    def opacity_in(self, pane: ViewPane) -> float:
        """How much of the solid a view shows while a surface is carried."""
        return 0.0 if isinstance(pane, SplitPane) and pane.shows_carried_alone else self.opacity

    def _set_solid(self, opacity: float) -> None:
        for pane in self._panes:
            if isinstance(pane, SplitPane) and pane.shows_carried_alone and self._document.mesh is not None:
                pane.view.overlay.message = "" if self.surface is not None else NOTHING
            shows_all = not (isinstance(pane, SplitPane) and pane.shows_carried_alone)
            if pane.view.surface is not None and (self.surface is not None or not shows_all):
                pane.view.surface.set_opacity(opacity if shows_all else 0.0)
        self._refresh()

    def _refresh(self) -> None:
        for pane in self._panes:
            pane.view.refresh()

    def set_theme(self, theme: Any) -> None:
        self.bar.set_theme(theme)

    def let_go(self) -> None:
        """Carry nothing any longer; the solid is drawn as before."""
        self._drop()
        self._document.choose(carried="")

    def _drop(self) -> None:
        self._set_solid(1.0)
        for layer in self._layers:
            layer.remove()
        self._layers = []
        self.surface, self.source = None, ""
        self.bar.hide()
        self._refresh()
