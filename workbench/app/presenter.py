"""From the document to the pictures: meshes, maps, anchors and marks in every view."""

from __future__ import annotations

from functools import partial

import numpy as np
from PySide6.QtCore import QObject, Signal

from workbench.app.colouring.colouring import Colouring
from workbench.app.docks.colour_map_dock import ColourMapDock
from workbench.app.document.document import Document
from workbench.app.handling.gizmo import gizmo_of
from workbench.app.one_shot import one_shot
from workbench.app.panel_turns import SOON, PanelTurns
from workbench.app.simplex_brush import SimplexBrush
from workbench.app.splitting.split_pane import SplitPane
from workbench.app.views.brush_mark import BrushedParts
from workbench.app.views.geometry import Geometry
from workbench.app.views.mesh_view import MeshView
from workbench.app.views.pane import ViewPane
from workbench.app.volumes.volume_view import VolumeView
from workbench.core.arrays import Floats
from workbench.core.solid_look.drawn_faces import DrawnFaces

EMPTY = "Open a mesh with Ctrl+O, choose a sample in the File menu, or drop a file here."
MARKS_WAIT = 35
"""Milliseconds that moved anchors wait for the map that follows them, to be drawn in one pass with it."""


class Presenter(QObject):
    """Draws the newest snapshot in the target at once, in the source and the panels in turns."""

    picture_sent = Signal(int)
    """A map that has taken up this anchor serial is on its way to the screen."""

    def __init__(
        self,
        document: Document,
        source: ViewPane,
        target: ViewPane,
        maps: list[ColourMapDock],
        colouring: Colouring,
        turns: PanelTurns,
        brush: SimplexBrush,
        volume: VolumeView,
    ) -> None:
        super().__init__(document)
        self._document = document
        self._brush = brush
        self._volume = volume
        self._panes = (source, target)
        self.source = source.view
        self.target = target.view
        self.more: list[SplitPane] = []
        self._maps = maps
        self._colouring = colouring
        self._turns = turns
        self._target_geometry: Geometry | None = None
        self._brushable: BrushedParts | None = None
        self._faces: DrawnFaces | None = None
        self._hovered = -1
        self._fits_next = False
        self._late_marks = one_shot(self, MARKS_WAIT, self._draw_marks)
        self.target.drawn.connect(turns.main_is_drawn)
        turns.add(self.source, self._draw_source, self._source_cost)
        document.opened.connect(self._show_mesh)
        document.shown_changed.connect(self._show_snapshot)
        document.history_restarted.connect(self._start_again)
        document.anchors_changed.connect(self._anchors_changed)
        document.selection_changed.connect(self._anchors_changed)
        brush.changed.connect(self._show_brush)
        # slider moves that came while a picture was drawn become one; the large views are painted each in a pass of its own
        self._late_look, self._late_source = one_shot(self, 0, self._look_again), one_shot(self, SOON, self._draw_source)
        volume.changed.connect(self._late_look.start)
        for dock in maps:
            turns.add(dock.view, partial(self._draw_map, dock), dock.cost)
        self.clear()

    # ------------------------------------------------------------------------------------------ meshes

    def clear(self) -> None:
        self._target_geometry = None
        for view in self._marked_views:
            view.clear()
            view.overlay.message = EMPTY if self._document.mesh is None else ""
        for dock in self._maps:
            dock.clear()
        self._mark()

    def _show_mesh(self) -> None:
        loaded = self._document.loaded
        assert loaded is not None
        self._hovered = -1
        self.clear()
        self._brush.clear()
        self._volume.begin()
        self._faces = self._volume.faces()
        self._brushable = BrushedParts(self._faces)
        geometry = Geometry(loaded.mesh.vertices, loaded.mesh.simplices, self._faces)
        surface = self.source.show_geometry(geometry)
        surface.set_cut_edges(loaded.cut_edges)
        self._colouring.apply(self._panes[0])
        for pane in self.more:
            if pane.is_source:
                self._show_in(pane, geometry)

    def _begin_target(self, positions: Floats) -> Geometry:
        """The first map of a mesh: its frame is kept, so that dragging does not move the picture."""
        loaded = self._document.loaded
        assert loaded is not None
        geometry = Geometry(positions, loaded.mesh.simplices, self._faces)
        self._target_geometry = geometry
        surface = self.target.show_geometry(geometry)
        surface.set_cut_edges(loaded.cut_edges)
        for dock in self._maps:
            dock.show_geometry(geometry)
            assert dock.view.surface is not None
            dock.view.surface.set_cut_edges(loaded.cut_edges)
        self._colouring.apply(self._panes[1])
        for pane in self.more:
            if not pane.is_source:
                self._show_in(pane, geometry)
        return geometry

    def _start_again(self) -> None:
        """A new start may have another size."""
        self._fits_next = True

    def refit_target(self) -> None:
        """Fit the target and the panels to the map as it is now."""
        self.target.fit()
        for dock in self._maps:
            dock.view.fit()
        for pane in self.more:
            if not pane.is_source:
                pane.view.fit()

    # ------------------------------------------------------------------------------------------ panes of splits

    def add_pane(self, pane: SplitPane) -> None:
        """Draw one more view of source or target, in turn with the panels."""
        self.more.append(pane)
        self._colouring.add(pane)
        self._turns.add(pane.view, partial(self._draw_pane, pane), lambda: pane.view.canvas.seconds)
        geometry = self.source.geometry_shown if pane.is_source else self._target_geometry
        pane.view.overlay.message = EMPTY if self._document.mesh is None else ""
        if geometry is not None:
            self._show_in(pane, geometry)
            self._draw_pane(pane)
            self._look_at_shell(pane.view)
        if self._brushable is not None:
            self._mark_brushed()
        self._mark()

    def remove_pane(self, pane: SplitPane) -> None:
        """A view of a split is gone."""
        self.more.remove(pane)
        self._turns.remove(pane.view)
        self._colouring.remove(pane)

    def _show_in(self, pane: SplitPane, geometry: Geometry) -> None:
        loaded = self._document.loaded
        assert loaded is not None
        surface = pane.view.show_geometry(geometry)
        surface.set_cut_edges(loaded.cut_edges)
        if pane.shows_carried_alone:
            surface.set_opacity(0.0)
        self._colouring.apply(pane)

    def _draw_pane(self, pane: SplitPane) -> None:
        """Bring a view of a split in line with the newest map; the points were written already."""
        surface, geometry, snapshot = pane.view.surface, self._target_geometry, self._document.snapshot
        if surface is None or geometry is None or snapshot is None:
            return
        surface.lay_texture()
        if not pane.is_source:
            pane.view.points_changed()
            if not len(self._document.anchors):
                pane.view.fit_if_it_left(snapshot.phase)
            elif not self._document.is_held:
                pane.view.fit_if_it_is_gone()
        self._colouring.paint(pane)
        pane.view.refresh()

    # ------------------------------------------------------------------------------------------ maps

    def _show_snapshot(self) -> None:
        snapshot = self._document.shown
        assert snapshot is not None
        is_first = self._target_geometry is None
        geometry = self._target_geometry or self._begin_target(snapshot.positions)
        geometry.write(snapshot.positions)
        self._show_faces()
        self.target.points_changed()
        self._colouring.take(snapshot)
        self._colouring.paint(self._panes[1])
        self._mark()
        self._late_marks.stop()
        if is_first:
            self.refit_target()
            self._draw_source()
        elif self._fits_next or not len(self._document.anchors):
            # whoever moves anchors wants the picture to stand still
            self.target.fit_if_it_left(snapshot.phase)
        elif not self._document.is_held:
            self.target.fit_if_it_is_gone()  # a single anchor takes the whole map with it
        self._fits_next = False
        self._draw_soon()
        self.picture_sent.emit(snapshot.anchor_serial)

    @property
    def _views(self) -> tuple[MeshView, ...]:
        return (*self._marked_views, *(dock.view for dock in self._maps))

    @property
    def _marked_views(self) -> tuple[MeshView, ...]:
        """Views that show anchors."""
        return (self.source, self.target, *(pane.view for pane in self.more))

    def _show_faces(self) -> bool:
        """Draw what the look into a solid leaves of it; whether that is something else than before."""
        faces = self._volume.faces()
        if faces is self._faces:
            return False
        self._faces, self._brushable = faces, BrushedParts(faces)
        for geometry in (self.source.geometry_shown, self._target_geometry):
            if geometry is not None:
                geometry.show_faces(faces)
        for view in self._views:
            view.faces_changed()
        self._mark_brushed()
        return True

    def _look_again(self) -> None:
        """A solid is looked at in another way."""
        if self._faces is None:
            return
        if not self._show_faces():
            self._mark_brushed()
        for view in self._views:
            self._look_at_shell(view)
        self._late_source.start()
        self._draw_soon()

    def _look_at_shell(self, view: MeshView) -> None:
        """Draw the boundary round what is left of a solid."""
        solid, look = self._volume.solid, self._volume.look
        shell = solid.boundary.triangles if solid is not None and look.takes_away else None
        if view.surface is not None:
            view.surface.ghost.show(shell, look.ghost, as_wires=look.is_wired)

    def _draw_soon(self) -> None:
        """The target now, the panels after it."""
        self.target.refresh()
        self._turns.take_map()
        if not self.target.is_shown():
            self._turns.main_is_drawn()  # there is nothing to wait for

    def _draw_source(self) -> None:
        """The source changes with the map where it carries its texture, inverted triangles or marks."""
        surface, geometry = self.source.surface, self._target_geometry
        if surface is None or geometry is None:
            return
        self._colouring.paint(self._panes[0])
        self.source.refresh()

    def _source_cost(self) -> float:
        return self.source.canvas.seconds

    def _draw_map(self, dock: ColourMapDock) -> None:
        if self._document.shown is not None:
            dock.show_snapshot(self._document.shown)

    # ------------------------------------------------------------------------------------------ marks

    def hover(self, vertex: int) -> None:
        if vertex != self._hovered:
            self._hovered = vertex
            self._anchors_changed()

    def _anchors_changed(self) -> None:
        self._mark()
        if self._document.is_running:
            if not self._late_marks.isActive():
                self._late_marks.start()
        else:
            self._draw_marks()

    def _show_brush(self) -> None:
        """Mark the brushed simplices in every view; the panels follow the target in turns."""
        if self._brushable is not None:
            self._mark_brushed()
            self._draw_soon()

    def _mark_brushed(self) -> None:
        assert self._brushable is not None
        marked = self._brush.simplices
        if self._volume.is_on and self._volume.look.only_marked and len(marked) > 1:
            marked = marked[:0]  # nothing else is drawn: a mark would only hide the colours
        part = self._brushable.part(marked)
        for view in self._views:
            if view.surface is not None:
                view.surface.show_brushed(part)

    def stop(self) -> None:
        self._late_marks.stop()
        self._late_look.stop()
        self._late_source.stop()

    def _draw_marks(self) -> None:
        """Paint the layers above anew; the pictures below stay as they are."""
        for view in self._marked_views:
            view.overlay.update()

    def _mark(self) -> None:
        """Bring anchors, the hovered vertex and the limiting simplex of both layers up to date."""
        document = self._document
        mesh, positions = document.mesh, document.positions
        anchors = document.shown_anchors
        targets = (self.target, *(pane.view for pane in self.more if not pane.is_source))
        for view in self._marked_views:
            scene = view.overlay.scene
            geometry = view.geometry_shown
            scene.limiting = None
            scene.hovered_point = None
            if mesh is None or geometry is None or positions is None:
                scene.gizmo = None
                scene.anchor_vertices = np.empty(0, np.int64)
                scene.anchor_points = scene.vertex_points = np.empty((0, 3))
                continue
            scene.anchor_vertices = anchors.vertices
            scene.vertex_points = geometry.points[anchors.vertices]
            scene.selected, scene.grouped = document.selected_anchors, frozenset(anchors.groups)
            scene.soft, scene.off = anchors.is_soft, anchors.is_off
            if view in targets:
                places = scene.anchor_points = geometry.frame.to_display(anchors.target_array(positions.shape[1]))
                scene.gizmo = gizmo_of(places[scene.is_selected], is_flat=geometry.is_flat)
            else:
                scene.anchor_points, scene.gizmo = scene.vertex_points, None
            if 0 <= self._hovered < geometry.vertex_count and not document.is_held:
                scene.hovered = self._hovered
                scene.hovered_point = geometry.points[self._hovered]
            snapshot = document.shown
            if snapshot is not None and 0 <= snapshot.limiting_simplex < mesh.simplex_count:
                scene.limiting = geometry.points[mesh.simplices[snapshot.limiting_simplex]]
                scene.limiting_label = f"{mesh.simplex_noun()} {snapshot.limiting_simplex} limits the step"
