"""The toggles of the View menu for what views draw, and the lines of a mesh that they need."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QMenu

from workbench.app.background import Background
from workbench.app.splitting.leaf import Leaf
from workbench.app.views.drawing_choices import LINES, DrawingChoices
from workbench.core.arrays import Integers
from workbench.core.boundary_sides import boundary_edges
from workbench.core.mesh import Mesh
from workbench.core.seams import seam_edges

if TYPE_CHECKING:
    from workbench.app.main_window import MainWindow

ACTIONS = {name: name.replace("_", "-") for name in LINES}
"""Names of the actions by those of the choices."""


@dataclass(frozen=True, eq=False)
class MeshLines:
    """`boundary`, `seams` : (k, 2) int64 vertices of edges; none of a solid"""

    boundary: Integers
    seams: Integers


class DrawingDesk(QObject):
    """An action holds for every view; the menu of a view for that one. Colour maps have edges only where they ask for them."""

    changed = Signal()

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self.choices = DrawingChoices()
        self._lines: MeshLines | None = None
        self._lines_of: Mesh | None = None
        self._search: Background | None = None
        self._actions: dict[str, QAction] = {name: window.actions_by_name[action] for name, action in ACTIONS.items()}
        self._actions["seams"].setChecked(True)
        for name, action in self._actions.items():
            action.triggered.connect(lambda on, n=name: self.choose(n, on))
        window.document.opened.connect(self._opened)
        window.splitting.pane_made.connect(self._begin)

    # ------------------------------------------------------------------------------------------ choices

    def choose(self, name: str, on: bool) -> None:
        """Draw something in every view, or nowhere."""
        self.choices = replace(self.choices, **{name: on})
        for leaf in self._window.splitting.leaves:
            if leaf.pane is not None or name != "edges":
                self.choose_in(leaf, name, on)
        self._actions[name].setChecked(on)

    def choose_in(self, leaf: Leaf, name: str, on: bool) -> None:
        """Draw something in one view."""
        self.set_in(leaf, replace(leaf.view.drawing, **{name: on}))

    def set_in(self, leaf: Leaf, choices: DrawingChoices) -> None:
        """Draw all of these in one view."""
        leaf.view.set_drawing(choices)
        self._give(leaf)
        self.changed.emit()

    def take(self, choices: DrawingChoices) -> None:
        """What every view draws that has no choices of its own."""
        for name in LINES:
            value = getattr(choices, name)
            if value is not None:
                self.choose(name, value)

    def fill_menu(self, leaf: Leaf, menu: QMenu) -> None:
        """The toggles for one view."""
        for name, action in self._actions.items():
            toggle = menu.addAction(action.text())
            toggle.setCheckable(True)
            drawn = getattr(leaf.view.drawing, name)
            is_on = leaf.view.surface is not None and leaf.view.surface.has_edges if drawn is None else drawn
            toggle.setChecked(bool(is_on))
            toggle.triggered.connect(lambda on, n=name: self.choose_in(leaf, n, on))

    # ------------------------------------------------------------------------------------------ lines

    def _begin(self, leaf: Leaf) -> None:
        """A new view draws what is drawn everywhere."""
        self.set_in(leaf, self.choices)

    def _opened(self) -> None:
        self._lines = self._lines_of = None
        for leaf in self._window.splitting.leaves:
            self._give(leaf)

    def _give(self, leaf: Leaf) -> None:
        """Hand the lines of the mesh to a view that draws them; they are found on a thread, once a mesh, when wanted first."""
        mesh = self._window.document.mesh
        wanted = leaf.view.drawing.boundary or (leaf.view.drawing.seams and mesh is not None and mesh.texture is not None)
        if mesh is None or not wanted:
            return
        if self._lines_of is mesh and self._lines is not None:
            leaf.view.set_lines(self._lines.seams, self._lines.boundary)
        elif self._search is None:
            self._search = Background(lambda: (mesh, lines_of(mesh)), self)
            self._search.finished.connect(self._take)
            self._search.failed.connect(self._failed)
            self._search.start()

    def _take(self, found: tuple[Mesh, MeshLines]) -> None:
        self._search = None
        self._lines_of, self._lines = found
        for leaf in self._window.splitting.leaves:
            self._give(leaf)

    def _failed(self, error: Exception) -> None:
        self._search = None
        self._window.reporter.show_exception(error)


def lines_of(mesh: Mesh) -> MeshLines:
    """The edges of a mesh that stand out."""
    nothing = np.empty((0, 2), np.int64)
    if mesh.dimension == 3:
        return MeshLines(nothing, nothing)
    seams = nothing if mesh.texture is None else seam_edges(mesh.texture, mesh.simplices)
    return MeshLines(boundary_edges(mesh.simplices), seams)
