"""A carried surface in one view: triangles in the colours of their own distortion, shaded smoothly."""

from __future__ import annotations

from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData

from workbench.app.colouring.colour_range import ColourRange
from workbench.app.views.actors import actor_of, cells, mapper_of
from workbench.app.views.colours import table_of
from workbench.app.views.mesh_view import MeshView
from workbench.core.arrays import Floats, Integers


class CarriedLayer:
    """Drawn within a view's own units; `move` and `paint` change it, `remove` takes it out."""

    def __init__(self, view: MeshView, triangles: Integers, vertex_count: int) -> None:
        self._view = view
        self._triangles = triangles
        self._points = np.zeros((vertex_count, 3), np.float32)
        self._normals = np.zeros((vertex_count, 3), np.float32)
        self._values = np.zeros(len(triangles), np.float32)
        # VTK refers to these arrays and does not own them: the attributes keep them alive
        self._point_data = numpy_to_vtk(self._points, deep=0)
        self._normal_data = numpy_to_vtk(self._normals, deep=0)
        self._value_data = numpy_to_vtk(self._values, deep=0)
        self._vtk_points = vtkPoints()
        self._vtk_points.SetData(self._point_data)
        polydata = vtkPolyData()
        polydata.SetPoints(self._vtk_points)
        polydata.SetPolys(cells(triangles))
        polydata.GetPointData().SetNormals(self._normal_data)
        polydata.GetCellData().SetScalars(self._value_data)
        self._mapper = mapper_of(polydata)
        self._mapper.SetScalarModeToUseCellData()
        self._mapper.UseLookupTableScalarRangeOn()
        self.actor: Any = actor_of(self._mapper)
        self.actor.PickableOff()
        style = self.actor.GetProperty()
        style.SetInterpolationToPhong()
        style.SetAmbient(0.3)
        style.SetDiffuse(0.7)
        view.add_actor(self.actor)

    def move(self, vertices: Floats) -> None:
        """Put its vertices (k, 3), in units of the mesh, where they are now."""
        geometry = self._view.geometry_shown
        if geometry is None:
            return
        from workbench.core.surface_normals import vertex_normals

        np.copyto(self._points, geometry.frame.to_display(vertices), casting="same_kind")
        np.copyto(self._normals, vertex_normals(vertices, self._triangles), casting="same_kind")
        for data in (self._point_data, self._normal_data, self._vtk_points):
            data.Modified()

    def paint(self, values: Floats) -> None:
        """Colour it by one number a triangle (m,); NaN, where there is none, is drawn as the least."""
        np.copyto(self._values, np.nan_to_num(values, nan=0.0, posinf=3e38), casting="same_kind")
        self._value_data.Modified()

    def show_range(self, colour_range: ColourRange) -> None:
        self._mapper.SetLookupTable(table_of(colour_range))

    def remove(self) -> None:
        self._view.remove_actor(self.actor)
