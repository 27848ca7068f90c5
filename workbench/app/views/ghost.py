"""The boundary of a solid as a veil round what is left of it."""

from __future__ import annotations

from typing import Any

from vtkmodules.vtkCommonDataModel import vtkPolyData

from workbench.app.appearance.theme import Theme
from workbench.app.views.actors import actor_of, cells, mapper_of
from workbench.app.views.geometry import Geometry
from workbench.core.arrays import Integers

DARK_VEIL = (0.92, 0.95, 1.0)
"""On black the same opacity of a mean grey would not be seen."""
FARTHER = 60.0
"""How far it is put behind faces in the same place."""


class Ghost:
    """Triangles between the vertices of one `Geometry`, seen through; hidden at first."""

    def __init__(self, geometry: Geometry, theme: Theme) -> None:
        self._polydata = vtkPolyData()
        self._polydata.SetPoints(geometry.vtk_points)
        self._shown: Integers | None = None
        mapper = mapper_of(self._polydata)
        mapper.ScalarVisibilityOff()
        # a little farther from the eye than faces that are drawn: it lies over gaps, not over their colours
        mapper.SetResolveCoincidentTopologyToPolygonOffset()
        mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(0.0, FARTHER)
        mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0.0, FARTHER)
        self.actor: Any = actor_of(mapper)
        self.actor.PickableOff()
        style = self.actor.GetProperty()
        style.SetInterpolationToFlat()
        style.SetAmbient(0.5)
        style.SetDiffuse(0.5)
        style.BackfaceCullingOn()  # one layer of the veil, not two
        self.set_theme(theme)
        self.show(None, 0.0)

    def set_theme(self, theme: Theme) -> None:
        self.actor.GetProperty().SetColor(*(DARK_VEIL if theme.is_dark else theme.edges))

    def show(self, triangles: Integers | None, opacity: float, *, as_wires: bool = False) -> None:
        """Draw these triangles (k, 3), facing outwards, or their edges; None draws none."""
        self.actor.SetVisibility(triangles is not None and opacity > 0)
        if triangles is None:
            return
        if triangles is not self._shown:
            self._shown = triangles
            self._polydata.SetPolys(cells(triangles))
        style = self.actor.GetProperty()
        style.SetOpacity(opacity)
        style.SetRepresentationToWireframe() if as_wires else style.SetRepresentationToSurface()
        style.SetLighting(not as_wires)
