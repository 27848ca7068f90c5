"""Points and triangles in VTK's memory, written in place and shared by every view that shows them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray

from workbench.core.arrays import Floats, Integers
from workbench.core.solid_look.drawn_faces import DrawnFaces, drawn_faces


@dataclass(frozen=True, eq=False)
class DisplayFrame:
    """Shift and scale that bring a mesh to diameter 1 about the origin, so that single precision suffices.

    `centre` : (d,) float64;  `scale` : float, units of the display in one unit of the mesh
    """

    centre: Floats
    scale: float

    @classmethod
    def around(cls, positions: Floats) -> DisplayFrame:
        low, high = positions.min(axis=0), positions.max(axis=0)
        diameter = float(np.linalg.norm(high - low))
        return cls(0.5 * (low + high), 1.0 / diameter if diameter > 0 and np.isfinite(diameter) else 1.0)

    def to_display(self, positions: Floats) -> Floats:
        """(n, d) positions of the mesh -> (n, 3) of the display, z = 0 in the plane."""
        shown = np.zeros((len(positions), 3))
        shown[:, : positions.shape[1]] = (positions - self.centre) * self.scale
        return shown

    def from_display(self, point: Floats) -> Floats:
        """(3,) of the display -> (d,) of the mesh."""
        return np.asarray(point[: len(self.centre)] / self.scale + self.centre)


class Geometry:
    """A mesh in single precision: its vertices, then the points that are made of them, and the triangles between both.

    Parameters
    ----------
    positions : (n, 2|3) float64     of the mesh; `frame` is taken from them
    simplices : (m, 3|4) int64
    faces : DrawnFaces               what is drawn; the triangles, or the boundary of tetrahedra, where it is not given
    """

    def __init__(self, positions: Floats, simplices: Integers, faces: DrawnFaces | None = None) -> None:
        self.frame = DisplayFrame.around(positions)
        self.simplices = simplices
        self.vertex_count = len(positions)
        self.points: NDArray[np.float32] = self.frame.to_display(positions).astype(np.float32)
        self.vtk_points = vtkPoints()
        self.vtk_cells = vtkCellArray()
        self.show_faces(faces or drawn_faces(simplices))

    @property
    def is_flat(self) -> bool:
        return len(self.frame.centre) == 2

    @property
    def triangles(self) -> Integers:
        """(k, 3) int64, rows of `points`"""
        return self.faces.triangles

    @property
    def vertices(self) -> NDArray[np.float32]:
        """(n, 3): where the vertices of the mesh are, without the points that are made of them."""
        return self.points[: self.vertex_count]

    def show_faces(self, faces: DrawnFaces) -> None:
        """Draw other triangles. Views that show this geometry must be told (`MeshView.faces_changed`) before they draw."""
        self.faces = faces
        made = faces.made
        vertices = self.vertices
        self.points = vertices if made is None else np.concatenate([vertices, made.at(vertices)], dtype=np.float32)
        # VTK refers to this memory and does not own it: the references here keep it alive
        self._data = numpy_to_vtk(self.points, deep=0)
        self.vtk_points.SetData(self._data)
        self._connectivity = np.array(faces.triangles, dtype=np.int64).ravel()
        self.vtk_cells.SetData(3, numpy_to_vtkIdTypeArray(self._connectivity, deep=0))
        self.vtk_cells.Modified()

    def write(self, positions: Floats) -> None:
        """Take new positions (n, d); views show them at their next `refresh`."""
        columns = positions.shape[1]
        self.points[: self.vertex_count, :columns] = (positions - self.frame.centre) * self.frame.scale
        if self.faces.made is not None:
            self.points[self.vertex_count :] = self.faces.made.at(self.vertices)
        self._data.Modified()
        self.vtk_points.Modified()
