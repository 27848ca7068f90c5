"""Pinning what a click means: a whole loop of the boundary, or the shortest path between two vertices."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import scipy
from PySide6.QtCore import QObject, Qt, Signal
from PySide6.QtGui import QKeyEvent

from workbench.app.handling.anchor_tool import AnchorTool
from workbench.app.handling.key_trap import KeyTrap
from workbench.app.views.sketch import Sketch
from workbench.core.arrays import Integers
from workbench.core.boundary_sides import boundary_edges
from workbench.core.edge_graph import EdgeGraph, PathTree

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

MOST_SHOWN = 4000
"""Edges of a preview that are drawn; a whole surface of a solid has more."""
HINTS = {
    "loop": "Click near a loop of the boundary to pin it · Esc: leave",
    "path": "Click where the path begins · Esc: leave",
    "end": "Click where it ends, to pin the shortest path along edges · Esc: leave",
}


class EscapeKey(KeyTrap):
    """Esc leaves."""

    pressed = Signal()

    def wants(self, event: QKeyEvent) -> bool:
        return event.key() == Qt.Key.Key_Escape

    def take(self, event: QKeyEvent) -> None:
        self.pressed.emit()


class Pinning(QObject):
    """Lets vertices be picked in every view; what would be pinned is shown while the pointer moves."""

    def __init__(self, window: MainWindow, tools: list[AnchorTool]) -> None:
        super().__init__(window)
        self._window = window
        self._document = window.document
        self._tools = tools
        self.deed = ""
        self._graph: EdgeGraph | None = None
        self._facets = self._labels = self._nearest = np.empty(0, np.int64)
        self._tree: PathTree | None = None
        self._key = EscapeKey(self)
        self._key.pressed.connect(self.end)
        self._document.opened.connect(self._forget)
        self._document.snapshot_taken.connect(self._show_again)
        self._shown = np.empty((0, 2), np.int64)

    def connect_tool(self, tool: AnchorTool) -> None:
        """Let one more tool pick."""
        tool.picked.connect(self._pick)
        tool.hovered.connect(self._hover)

    # ------------------------------------------------------------------------------------------ picking

    def begin(self, deed: str) -> None:
        """The next click picks a "loop", the next two the ends of a "path"."""
        if self._document.mesh is None or self._document.positions is None:
            return
        self.end()
        if deed == "loop" and not self._find_loops():
            self._window.status.say("This mesh has no boundary.")
            return
        self.deed = deed
        self._key.listen(True)
        for tool in self._tools:
            tool.let_go()
            tool.is_picking = True
            tool.view.overlay.setCursor(Qt.CursorShape.CrossCursor)
        self._tell(HINTS[deed])

    def end(self) -> None:
        """Nothing is picked any longer."""
        if self.deed:
            self.deed, self._tree = "", None
            self._key.listen(False)
            for tool in self._tools:
                tool.is_picking = False
                tool.view.overlay.unsetCursor()
            self._show(np.empty((0, 2), np.int64))
            self._tell("")

    def _forget(self) -> None:
        self.end()
        self._graph, self._nearest = None, np.empty(0, np.int64)

    def _tell(self, hint: str) -> None:
        self._window.status.say(hint.removesuffix(" · Esc: leave"))
        for tool in self._tools:
            tool.view.overlay.scene.hint = hint
            tool.view.overlay.update()

    def _pick(self, vertex: int) -> None:
        if not self.deed or vertex < 0:
            self.end()
        elif self.deed == "loop":
            self._pin(np.unique(self._loop_at(vertex)))
        elif self._tree is None:
            self._tree = self._edges_for(vertex).paths_from(vertex)
            self._tell(HINTS["end"])
        else:
            self._pin(self._tree.to(vertex))

    def _pin(self, vertices: Integers) -> None:
        self.end()
        if not len(vertices):
            self._window.status.say("No path along edges leads there.")
            return
        self._document.pin(vertices)
        self._document.select_all(vertices.tolist())
        self._window.status.say(f"{len(vertices)} anchors are set and selected: G moves, R turns, S scales.")

    # ------------------------------------------------------------------------------------------ preview

    def _hover(self, vertex: int) -> None:
        if self.deed == "loop":
            self._show(self._loop_at(vertex) if vertex >= 0 else self._shown[:0])
        elif self._tree is not None:
            path = self._tree.to(vertex) if vertex >= 0 else np.empty(0, np.int64)
            self._show(np.stack([path[:-1], path[1:]], axis=1) if len(path) > 1 else self._shown[:0])

    def _show(self, edges: Integers) -> None:
        self._shown = edges[:MOST_SHOWN]
        self._show_again()

    def _show_again(self) -> None:
        """The map has moved on under what is shown."""
        for tool in self._tools:
            scene, geometry = tool.view.overlay.scene, tool.view.geometry_shown
            was_shown = scene.sketches.pop("pin", None) is not None
            if len(self._shown) and geometry is not None:
                ends = geometry.points[self._shown]
                is_shell = self.deed == "loop" and self._facets.shape[1] == 3
                dots = None if is_shell else np.concatenate([ends[:1, 0], ends[:, 1]])
                scene.sketches["pin"] = Sketch(ends, "shell" if is_shell else "path", dots)
            if was_shown or len(self._shown):
                tool.view.overlay.update()

    # ------------------------------------------------------------------------------------------ loops and paths

    def _all_edges(self) -> EdgeGraph:
        mesh = self._document.mesh
        assert mesh is not None
        if self._graph is None:
            self._graph = EdgeGraph(mesh.vertices, mesh.simplices)
        return self._graph

    def _edges_for(self, vertex: int) -> EdgeGraph:
        """On the surface of a solid paths stay on it, where they are seen."""
        mesh, solid = self._document.mesh, self._window.volume.solid
        assert mesh is not None
        if solid is None or vertex not in solid.boundary.triangles:
            return self._all_edges()
        return EdgeGraph(mesh.vertices, solid.boundary.triangles)

    def _find_loops(self) -> bool:
        """Sort the facets of the boundary by loops, and find the nearest one of every vertex; whether there are any."""
        mesh, solid = self._document.mesh, self._window.volume.solid
        assert mesh is not None
        if not len(self._nearest):
            self._facets = boundary_edges(mesh.simplices) if solid is None else solid.boundary.triangles
            if not len(self._facets):
                return False
            edges = EdgeGraph(mesh.vertices, self._facets).edges
            links = scipy.sparse.csr_array((np.ones(len(edges)), (edges[:, 0], edges[:, 1])), shape=(mesh.vertex_count,) * 2)
            self._labels = scipy.sparse.csgraph.connected_components(links, directed=False)[1]
            self._nearest = self._all_edges().nearest(np.unique(self._facets))
        return True

    def _loop_at(self, vertex: int) -> Integers:
        """Edges (k, 2) of the loop, or surface, of the boundary that is nearest to a vertex."""
        mesh, near = self._document.mesh, self._nearest[vertex]
        assert mesh is not None
        if near < 0:
            return np.empty((0, 2), np.int64)
        chosen = self._facets[self._labels[self._facets[:, 0]] == self._labels[near]]
        return EdgeGraph(mesh.vertices, chosen).edges
