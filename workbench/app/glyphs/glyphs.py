"""Which glyphs the views show, and keeping them in line with the map."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from PySide6.QtCore import QObject, QTimer, Signal

from workbench.app.appearance.theme import Theme
from workbench.app.background import Background
from workbench.app.texturing.texturing import number_within
from workbench.app.views.geometry import Geometry
from workbench.app.views.glyph_layer import GlyphLayer
from workbench.app.views.mesh_view import MeshView
from workbench.core.glyph_places import GlyphPlaces
from workbench.core.mesh import Mesh
from workbench.core.solid_look.drawn_faces import DrawnFaces

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

KINDS = {"none": "&None", "stretches": "&Stretches", "ellipses": "&Ellipses"}
"""What can be drawn: nothing, lines along the singular vectors, images of circles or balls."""
USUAL = {2: 300, 3: 150}
"""Glyphs on triangles, and on solids, where each is a body."""
MOST = 2000
LARGEST = 4.0
"""Factor of the usual number, or size, up to which it can be chosen; the inverse is the smallest."""
PLACES = ("source", "target")


@dataclass(frozen=True)
class GlyphChoice:
    """`kind` of `KINDS`; `number` and `size` are factors of the usual ones; `places` of `PLACES` are views that show them."""

    kind: str = "none"
    number: float = 1.0
    size: float = 1.0
    places: tuple[str, ...] = PLACES


class Glyphs(QObject):
    """Glyphs of the large views: on the same simplices in all of them, drawn with every map."""

    changed = Signal()

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self.choice = GlyphChoice()
        self._places: GlyphPlaces | None = None
        self._faces: DrawnFaces | None = None
        self._layers: dict[MeshView, GlyphLayer] = {}
        self._compiling: Background | None = None
        self._is_ready = False
        self._late = QTimer(self)
        self._late.setSingleShot(True)
        self._late.setInterval(0)
        self._late.timeout.connect(self._draw_again)
        window.document.opened.connect(self._forget)
        window.document.shown_changed.connect(self._draw)
        window.volume.changed.connect(self._late.start)
        window.theme_switch.changed.connect(self._theme_changed)

    def _theme_changed(self, _: Theme) -> None:
        self._late.start()

    def choose(self, **changes: Any) -> None:
        """Show others: fields of `GlyphChoice`."""
        choice = replace(self.choice, **changes)
        if choice != self.choice:
            is_as_many = choice.number == self.choice.number
            self.choice = choice
            if not is_as_many:
                self._forget()
            self.changed.emit()
            self._draw_again()

    def wait(self) -> None:
        """Let threads end before the window does."""
        self._late.stop()
        if self._compiling is not None:
            self._compiling.wait()

    # ------------------------------------------------------------------------------------------ drawing

    def _forget(self) -> None:
        self._places = None

    @property
    def _views(self) -> Iterator[tuple[MeshView, bool]]:
        """Each large view, and whether it shows the source."""
        window = self._window
        yield window.source.view, True
        yield window.target.view, False
        for pane in window.presenter.more:
            yield pane.view, pane.is_source

    def _draw_again(self) -> None:
        self._draw()
        for view, _ in self._views:
            view.refresh()

    def _draw(self) -> None:
        """Bring the glyphs of every view in line with what its geometry shows now."""
        mesh = self._window.document.mesh
        source, target = self._window.source.view.geometry_shown, self._window.target.view.geometry_shown
        if self.choice.kind == "none" or mesh is None or source is None or target is None or not self._can_compute():
            for layer in self._layers.values():
                layer.show(None, as_lines=True)
            return
        places = self._places_on(mesh, source)
        columns = len(target.frame.centre)
        stretches = places.stretches(target.vertices[:, :columns].astype(np.float64) / target.frame.scale)
        as_lines, size = self.choice.kind == "stretches", self.choice.size
        on_source = places.on_source(stretches, source.points, size, as_lines=as_lines)
        on_target = places.on_target(stretches, target.points, size * target.frame.scale / source.frame.scale)
        views = dict(self._views)
        self._layers = {view: layer for view, layer in self._layers.items() if view in views}  # panes of splits can be gone
        for view, is_source in views.items():
            if view not in self._layers:
                self._layers[view] = GlyphLayer(view)
            is_wanted = PLACES[0 if is_source else 1] in self.choice.places
            self._layers[view].show((on_source if is_source else on_target) if is_wanted else None, as_lines=as_lines)

    def count(self, mesh: Mesh) -> int:
        """Glyphs that a view of a mesh shows, at the most."""
        return round(min(self.choice.number * USUAL[mesh.dimension], MOST))

    def _places_on(self, mesh: Mesh, source: Geometry) -> GlyphPlaces:
        """The places on what is drawn of the source now."""
        if self._places is None or self._faces is not source.faces:
            self._faces = source.faces
            self._places = GlyphPlaces(mesh, source.points, source.triangles, source.faces.simplices, self.count(mesh))
        return self._places

    def _can_compute(self) -> bool:
        """Whether the kernel is there; else it is compiled beside the window, once, and glyphs come then."""
        if self._is_ready or self._compiling is not None:
            return self._is_ready
        from workbench.engine.stretch_kernels import compile_stretches

        self._compiling = Background(compile_stretches, self)
        self._compiling.finished.connect(self._take_kernel)
        self._compiling.failed.connect(self._window.reporter.show_exception)
        self._compiling.start()
        return False

    def _take_kernel(self, _: object) -> None:
        self._compiling, self._is_ready = None, True
        self._draw_again()

    # ------------------------------------------------------------------------------------------ memory

    def kept(self) -> dict[str, Any]:
        """What differs from the usual choice and is there again at the next start, as plain values."""
        usual, found = vars(GlyphChoice()), vars(self.choice) | {"places": list(self.choice.places)}
        return {name: value for name, value in found.items() if getattr(self.choice, name) != usual[name]}

    def take_kept(self, kept: Mapping[str, Any]) -> None:
        """Take up what `kept` gave; values of another kind are passed over."""
        kind, places = kept.get("kind"), kept.get("places")
        self.choose(
            kind=kind if kind in KINDS else "none",
            number=number_within(kept.get("number"), 1.0 / LARGEST, LARGEST, 1.0),
            size=number_within(kept.get("size"), 1.0 / LARGEST, LARGEST, 1.0),
            places=tuple(name for name in PLACES if name in places) if isinstance(places, list) else PLACES,
        )
