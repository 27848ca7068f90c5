"""Actors of parts of a surface, drawn a little nearer to the eye than the surface itself."""

from __future__ import annotations

from typing import Any

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper

from workbench.app.appearance.theme import Colour
from workbench.core.arrays import Integers

THROUGH = 2e4
"""Nearer to the eye than all that is drawn otherwise: inverted tetrahedra are seen through those in front of them."""


def cells(rows: Integers) -> vtkCellArray:
    """Cells of equal size, one a row."""
    found = vtkCellArray()
    flat = np.ascontiguousarray(rows, dtype=np.int64).ravel()
    found.SetData(rows.shape[1], numpy_to_vtkIdTypeArray(flat, deep=1))
    return found


def mapper_of(polydata: vtkPolyData) -> vtkPolyDataMapper:
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(polydata)
    return mapper


def actor_of(mapper: vtkPolyDataMapper) -> vtkActor:
    actor = vtkActor()
    actor.SetMapper(mapper)
    return actor


def surface_actor(polydata: vtkPolyData, colour: Colour, *, nearer: float) -> Any:
    """Triangles in one colour, hidden at first; the larger `nearer`, the more they lie above others."""
    mapper = mapper_of(polydata)
    mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(0.0, -nearer)
    return _in_colour(mapper, colour)


def line_actor(polydata: vtkPolyData, colour: Colour, width: float, *, nearer: float) -> Any:
    """Lines that lie in triangles, hidden at first; `width` in pixels."""
    mapper = mapper_of(polydata)
    mapper.SetRelativeCoincidentTopologyLineOffsetParameters(0.0, -nearer)
    actor = _in_colour(mapper, colour)
    actor.GetProperty().SetLineWidth(width)
    return actor


def _in_colour(mapper: vtkPolyDataMapper, colour: Colour) -> Any:
    mapper.ScalarVisibilityOff()
    mapper.SetResolveCoincidentTopologyToPolygonOffset()
    actor: Any = actor_of(mapper)
    actor.GetProperty().SetColor(*colour)
    actor.GetProperty().LightingOff()
    actor.SetVisibility(False)
    return actor
