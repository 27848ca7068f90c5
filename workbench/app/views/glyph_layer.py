"""Glyphs in a view: lines along principal stretches, images of circles, images of balls."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtGui import QColor
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.vtkCommonCore import vtkLookupTable, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData

from workbench.app.views.actors import actor_of, cells, line_actor, mapper_of
from workbench.app.views.mesh_view import MeshView
from workbench.core.arrays import Integers
from workbench.core.glyph_places import PlacedGlyphs
from workbench.core.glyph_shapes import ball, ellipses, ellipsoids, stretch_lines
from workbench.figures.glyph_colours import BODY, EQUAL, LONGER, SHORTER

NEARER = 40.0
"""How far lines are put before the triangles that they lie in."""
WIDTH = 2.0
CASING = 2.0
"""Width of lines, and how much wider what is seen of their background is, pixels."""


class GlyphLayer:
    """Actors of one view, written in place while the number of glyphs stays."""

    def __init__(self, view: MeshView) -> None:
        self._view = view
        self._lines, self._bodies = vtkPolyData(), vtkPolyData()
        self._casing = line_actor(self._lines, (1.0, 1.0, 1.0), WIDTH + CASING, nearer=NEARER)
        self._core = line_actor(self._lines, LONGER, WIDTH, nearer=1.1 * NEARER)
        self._core.GetMapper().SetLookupTable(_three_colours())
        self._core.GetMapper().UseLookupTableScalarRangeOn()
        self._core.GetMapper().SetScalarModeToUseCellData()
        self._body: Any = actor_of(mapper_of(self._bodies))
        self._body.GetProperty().SetColor(*BODY)
        self._body.GetProperty().SetAmbient(0.35)
        self._body.GetProperty().SetDiffuse(0.65)
        self._body.PickableOff()
        self._shape: tuple[object, ...] = ()
        self._arrays: tuple[NDArray[Any], ...] = ()
        self._data: tuple[Any, ...] = ()
        self.actors = (self._casing, self._core, self._body)
        for actor in self.actors:
            actor.SetVisibility(False)
            view.add_actor(actor)

    def show(self, glyphs: PlacedGlyphs | None, *, as_lines: bool) -> None:
        """Draw glyphs, in units of the display, at the next picture of the view, or none.

        `as_lines`: one line an axis, or else the ellipse or ellipsoid with these axes.
        """
        has_bodies = glyphs is not None and not as_lines and glyphs.axes.shape[1] == 3
        self._body.SetVisibility(has_bodies)
        self._core.SetVisibility(glyphs is not None and not has_bodies)
        # rings have many sides, and each costs where no graphics card draws: they have no casing
        self._casing.SetVisibility(glyphs is not None and as_lines)
        if glyphs is None:
            return
        if has_bodies:
            self._write(self._bodies, *ellipsoids(glyphs.centres, glyphs.axes), ball()[1])
        elif as_lines:
            self._write(self._lines, stretch_lines(glyphs.centres, glyphs.axes), None, np.array([[0, 1]]))
            self._paint(glyphs.signs)
        else:
            rings = ellipses(glyphs.centres, glyphs.axes)
            self._write(self._lines, rings, None, np.append(np.arange(rings.shape[1]), 0)[None])
            self._core.GetMapper().ScalarVisibilityOff()
        self._dress(as_lines)

    def _dress(self, as_lines: bool) -> None:
        """Colours that are seen on this theme."""
        theme = self._view.theme
        ink, paper = QColor(theme.text), QColor(theme.view)
        if not as_lines:
            self._core.GetProperty().SetColor(ink.redF(), ink.greenF(), ink.blueF())
        self._casing.GetProperty().SetColor(paper.redF(), paper.greenF(), paper.blueF())

    def _paint(self, signs: Integers) -> None:
        values = signs.astype(np.float32).ravel()
        self._lines.GetCellData().SetScalars(numpy_to_vtk(values, deep=1))
        self._core.GetMapper().ScalarVisibilityOn()

    def _write(self, data: Any, points: NDArray[Any], normals: NDArray[Any] | None, template: Integers) -> None:
        """Points (…, p, 3) of shapes that are joined alike: `template` (r, c) are the cells between the p of each."""
        shape = (points.shape, template.shape)
        flat = points.reshape(-1, 3)
        if shape != self._shape:
            self._shape = shape
            per_shape = points.shape[-2]
            begins = per_shape * np.arange(len(flat) // per_shape)
            joined = cells((begins[:, None, None] + template).reshape(-1, template.shape[1]))
            self._arrays = tuple(np.empty_like(flat, dtype=np.float32) for _ in (points, normals))
            # VTK refers to these arrays and does not own them: the attributes keep them alive
            self._data = tuple(numpy_to_vtk(array, deep=0) for array in self._arrays)
            places = vtkPoints()
            places.SetData(self._data[0])
            data.SetPoints(places)
            data.GetCellData().SetScalars(None)
            data.GetPointData().SetNormals(None if normals is None else self._data[1])
            data.SetPolys(joined) if normals is not None else data.SetLines(joined)
        for array, values in zip(self._arrays, (flat, normals), strict=True):
            if values is not None:
                np.copyto(array, values.reshape(-1, 3), casting="same_kind")
        for item in self._data:
            item.Modified()
        data.GetPoints().Modified()

    def remove(self) -> None:
        """Take it out of the view."""
        for actor in self.actors:
            self._view.remove_actor(actor)


def _three_colours() -> vtkLookupTable:
    table = vtkLookupTable()
    table.SetNumberOfTableValues(3)
    table.SetTableRange(-1.0, 1.0)
    for row, colour in enumerate((SHORTER, EQUAL, LONGER)):
        table.SetTableValue(row, *colour, 1.0)
    return table
