"""Edges of a mesh that stand out: where it was cut, seams of its texture, its boundary."""

from __future__ import annotations

from typing import Any

from vtkmodules.vtkCommonDataModel import vtkPolyData

from workbench.app.appearance.theme import CUT, Theme
from workbench.app.views.actors import cells, line_actor
from workbench.app.views.geometry import Geometry
from workbench.core.arrays import Integers

SEAM = (0.66, 0.36, 0.10)
"""Colour of the texture's seams: neither that of a cut nor of anything that is marked."""


class _Lines:
    """Edges between the points of a geometry in one colour; without any nothing is drawn."""

    def __init__(self, geometry: Geometry, colour: tuple[float, float, float], width: float, nearer: float) -> None:
        self._polydata = vtkPolyData()
        self._polydata.SetPoints(geometry.vtk_points)
        self.actor: Any = line_actor(self._polydata, colour, width, nearer=nearer)
        self._count = 0
        self._is_wanted = True

    def set_edges(self, edges: Integers) -> None:
        self._count = len(edges)
        self._polydata.SetLines(cells(edges))
        self.want(self._is_wanted)

    @property
    def is_shown(self) -> bool:
        return bool(self.actor.GetVisibility())

    def want(self, wanted: bool) -> None:
        self._is_wanted = wanted
        self.actor.SetVisibility(wanted and self._count > 0)


class FeatureLines:
    """Three kinds of lines in one view; each is given once a mesh, and drawn while it is wanted."""

    def __init__(self, geometry: Geometry, theme: Theme) -> None:
        self.cut = _Lines(geometry, CUT, 3.0, nearer=12.0)
        self.seams = _Lines(geometry, SEAM, 3.0, nearer=11.0)
        self.boundary = _Lines(geometry, CUT, 2.0, nearer=10.0)
        self.boundary.want(False)
        self.actors = (self.boundary.actor, self.seams.actor, self.cut.actor)
        self.set_theme(theme)

    def set_theme(self, theme: Theme) -> None:
        shade = 0.95 if theme.is_dark else 0.1
        self.boundary.actor.GetProperty().SetColor(shade, shade, shade)

    def set_cut(self, edges: Integers) -> None:
        """Edges (k, 2) that a fix opened: green."""
        self.cut.set_edges(edges)

    def set_seams(self, edges: Integers) -> None:
        """Edges (k, 2) across which the texture of the file jumps."""
        self.seams.set_edges(edges)

    def set_boundary(self, edges: Integers) -> None:
        """Edges (k, 2) of one triangle only."""
        self.boundary.set_edges(edges)

    def want(self, *, seams: bool, boundary: bool) -> None:
        """Which of them are drawn."""
        self.cut.want(seams)
        self.seams.want(seams)
        self.boundary.want(boundary)
