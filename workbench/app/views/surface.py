"""The actors of one view: triangles in the colour of their simplex, inverted ones outlined, cut edges, brushed ones marked."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData

from workbench.app.appearance.theme import INVERTED, INVERTED_OUTLINE, Theme
from workbench.app.colouring.colour_range import ColourRange
from workbench.app.views import drawing_style
from workbench.app.views.actors import THROUGH, actor_of, cells, mapper_of, surface_actor
from workbench.app.views.brush_mark import BrushedPart, BrushMark
from workbench.app.views.canvas import draws_with_card
from workbench.app.views.colours import single_colour, table_of
from workbench.app.views.feature_lines import FeatureLines
from workbench.app.views.geometry import Geometry
from workbench.app.views.ghost import Ghost
from workbench.app.views.solid_texture import SolidTexture
from workbench.app.views.textures import Texture, repeating
from workbench.core.arrays import Booleans, Integers
from workbench.core.solid_look.drawn_faces import DrawnFaces

MAP_SCALARS = 1
"""VTK_COLOR_MODE_MAP_SCALARS, which Python does not name."""


class Surface:
    """A `Geometry` with colours, in place; add `actors` to a renderer once.

    Colours come from one number a simplex through a table; NaN marks an inverted one.
    """

    def __init__(self, geometry: Geometry, theme: Theme, *, edges: bool | None = None) -> None:
        self.geometry = geometry
        self._theme = theme
        self._polydata = vtkPolyData()
        self._polydata.SetPoints(geometry.vtk_points)
        self._polydata.SetPolys(geometry.vtk_cells)
        self._make_scalars()
        self._latest: tuple[NDArray[Any] | None, Booleans] | None = None
        self._texture_points: NDArray[np.float32] = np.empty((0, 2), np.float32)
        self._texture_data: Any = None
        self._tile: NDArray[np.uint8] = np.empty((0, 0, 3), np.uint8)
        self._texture: Texture | None = None
        self._mapper = mapper_of(self._polydata)
        self._mapper.SetScalarModeToUseCellData()
        self._mapper.SetColorModeToMapScalars()
        self._mapper.UseLookupTableScalarRangeOn()
        self._actor: Any = actor_of(self._mapper)
        self._solid_texture = SolidTexture(self._actor, self._polydata)
        self._inverted = vtkPolyData()
        self._inverted.SetPoints(geometry.vtk_points)
        is_solid = geometry.simplices.shape[1] == 4
        self._inverted_actor = _inverted_actor(self._inverted, nearer=THROUGH if is_solid else 6.0)
        self._inverted_shown: tuple[DrawnFaces, Integers] = (geometry.faces, np.empty(0, np.int64))
        self.lines = FeatureLines(geometry, theme)
        self._brush = BrushMark(geometry)
        self.ghost = Ghost(geometry, theme)
        self.actors = (self._actor, self._inverted_actor, *self.lines.actors, *self._brush.actors, self.ghost.actor)
        self._is_wireframe = False
        self._style(edges if edges is not None else len(geometry.triangles) <= drawing_style.edges_up_to)
        self.show_plain()

    def _make_scalars(self) -> None:
        """One number a triangle, in memory that VTK reads."""
        self._values: NDArray[np.float32] = np.zeros(len(self.geometry.triangles), np.float32)
        self._scalars = numpy_to_vtk(self._values, deep=0)
        self._scalars.SetName("colour")
        self._polydata.GetCellData().SetScalars(self._scalars)

    def faces_changed(self) -> None:
        """The geometry draws other triangles: they take the colours of their simplices."""
        self._make_scalars()
        if self._texture is not None:
            self.show_pattern(self._texture)
        if self._latest is not None:
            self.set_values(*self._latest)

    def _style(self, edges: bool) -> None:
        style = self._actor.GetProperty()
        style.SetLighting(not self.geometry.is_flat)
        style.SetInterpolationToFlat()
        style.SetAmbient(0.35)
        style.SetDiffuse(0.65)
        style.SetEdgeColor(*self._theme.edges)
        style.SetLineWidth(drawing_style.edge_width)
        self.set_edges(edges)

    def set_edges(self, visible: bool) -> None:
        self._actor.GetProperty().SetEdgeVisibility(visible)

    def set_wireframe(self, wanted: bool) -> None:
        """Draw the sides of triangles in their colours, and nothing within."""
        style = self._actor.GetProperty()
        style.SetRepresentationToWireframe() if wanted else style.SetRepresentationToSurface()
        style.SetLighting(not (wanted or self.geometry.is_flat))
        self._is_wireframe = wanted
        if self._is_plain:
            self.show_plain()

    def set_opacity(self, opacity: float) -> None:
        """Draw the triangles as a veil before what is behind them; 1 hides it, 0 hides the triangles."""
        style = self._actor.GetProperty()
        style.SetOpacity(opacity)
        style.SetBackfaceCulling(opacity < 1.0 and not self.geometry.is_flat)  # one layer of the veil, not two

    @property
    def has_edges(self) -> bool:
        return bool(self._actor.GetProperty().GetEdgeVisibility())

    def set_theme(self, theme: Theme) -> None:
        self._theme = theme
        self.ghost.set_theme(theme)
        self.lines.set_theme(theme)
        self._actor.GetProperty().SetEdgeColor(*theme.edges)
        self._actor.GetProperty().SetLineWidth(drawing_style.edge_width)
        if self._texture is not None:
            self.show_pattern(self._texture)
        elif self._is_plain:
            self.show_plain()

    # ------------------------------------------------------------------------------------------ colours

    def show_plain(self) -> None:
        """One colour for all triangles but the inverted."""
        self._drop_texture()
        self._actor.GetProperty().SetEdgeOpacity(1.0)
        self._is_plain = True
        self._mapper.SetLookupTable(single_colour(self._theme.edges if self._is_wireframe else self._theme.fill))
        self._values[:] = np.where(np.isnan(self._values), np.nan, 0.0)
        self._scalars.Modified()

    def show_range(self, colour_range: ColourRange) -> None:
        """Colours of a quantity over its range."""
        self._drop_texture()
        self._actor.GetProperty().SetEdgeOpacity(0.3)
        self._is_plain = False
        self._mapper.SetLookupTable(table_of(colour_range))

    def show_pattern(self, texture: Texture) -> None:
        """A pattern laid over the triangles; `lay_texture` says where."""
        if texture.pattern == "plain":
            self.show_plain()
            return
        self._is_plain = False
        self._texture = texture
        self._actor.GetProperty().SetEdgeOpacity(0.25)
        self._solid_texture.hide()
        self._actor.SetTexture(None)
        if self.geometry.simplices.shape[1] == 4 and not texture.is_picture:
            self._solid_texture.show(texture, len(self.geometry.points), self._theme.is_dark)
        else:
            self._make_texture_points()
            tile = texture.tile(self._theme.is_dark)
            self._tile = np.ascontiguousarray(tile[::-1])
            self._actor.SetTexture(repeating(tile, draws_with_card()))
        self._mapper.SetLookupTable(single_colour((1.0, 1.0, 1.0)))
        self._values[:] = np.where(np.isnan(self._values), np.nan, 0.0)
        self._scalars.Modified()
        self.lay_texture()

    def _make_texture_points(self) -> None:
        self._texture_points = np.zeros((len(self.geometry.points), 2), np.float32)
        self._texture_data = numpy_to_vtk(self._texture_points, deep=0)
        self._polydata.GetPointData().SetTCoords(self._texture_data)

    def _drop_texture(self) -> None:
        self._texture = None
        self._solid_texture.hide()
        self._actor.SetTexture(None)

    @property
    def has_texture(self) -> bool:
        return self._texture is not None

    def lay_texture(self) -> None:
        """Lay the texture where its points are now."""
        texture, places = self._texture, self._texture_points
        if texture is None:
            return
        points = self.geometry.points if texture.points is None else texture.points()
        if points is None:
            return
        self._solid_texture.lay(points)
        if len(points) == len(places):
            np.copyto(places, texture.coordinates(points))
            self._texture_data.Modified()

    def set_values(self, values: NDArray[Any] | None, inverted: Booleans) -> None:
        """One number a simplex (m,), or None for plain; `inverted` (m,) bool are drawn yellow, outlined dark."""
        self._latest = (values, inverted)
        owners = self.geometry.faces.simplices
        if values is None or self.has_texture or self._is_plain:
            self._values[:] = 0.0
        else:
            np.copyto(self._values, values if owners is None else values[owners], casting="same_kind")
            # an infinite distortion lies beyond the table; NaN is kept for inverted triangles alone
            np.nan_to_num(self._values, copy=False, nan=3e38, posinf=3e38, neginf=-3e38)
        if inverted.any():
            self._values[inverted if owners is None else inverted[owners]] = np.nan
        self._scalars.Modified()
        self._show_inverted(np.flatnonzero(inverted))

    def flat_colours(self) -> NDArray[np.uint32] | None:
        """Colour of each triangle (m,), packed; None where more is shown than flat triangles in a colour each."""
        if self.has_texture or not self._is_bare:
            return None
        colours = self._mapper.GetLookupTable().MapScalars(self._scalars, MAP_SCALARS, 0)
        packed: NDArray[np.uint32] = vtk_to_numpy(colours).view(np.uint32)[:, 0]
        return packed

    def flat_texture(self) -> tuple[NDArray[np.float32], NDArray[np.uint8]] | None:
        """Where the texture lies (n, 2), and its tile, rows from below; None where more is shown than it on flat triangles."""
        return (self._texture_points, self._tile) if self.has_texture and self._is_bare else None

    @property
    def _is_bare(self) -> bool:
        """Whether flat triangles are all there is: no edges, no lines, nothing inverted or marked, nothing seen through."""
        is_filled = self.geometry.is_flat and not self.has_edges and not self._is_wireframe
        is_opaque = self._actor.GetProperty().GetOpacity() == 1.0
        return is_filled and is_opaque and not any(actor.GetVisibility() for actor in self.actors[1:])

    # ------------------------------------------------------------------------------------------ lines

    def _show_inverted(self, simplices: Integers) -> None:
        """Draw these simplices once more above the others: a map folds them below what they overlap."""
        drawn = (self.geometry.faces, simplices)
        if drawn[0] is self._inverted_shown[0] and np.array_equal(simplices, self._inverted_shown[1]):
            return
        self._inverted_shown = drawn
        self._inverted_actor.SetVisibility(len(simplices) > 0)
        self._inverted.SetPolys(cells(self.geometry.faces.all_sides(simplices)))

    def set_cut_edges(self, edges: Integers) -> None:
        """Edges (k, 2) that a cut opened: green."""
        self.lines.set_cut(edges)

    def show_brushed(self, part: BrushedPart) -> None:
        """Triangles that are brushed: tinted and outlined, above all others."""
        self._brush.show(part)


def _inverted_actor(polydata: vtkPolyData, nearer: float) -> Any:
    """Yellow with dark edges."""
    actor = surface_actor(polydata, INVERTED, nearer=nearer)
    style = actor.GetProperty()
    style.EdgeVisibilityOn()
    style.SetEdgeColor(*INVERTED_OUTLINE)
    style.SetLineWidth(1.4)
    return actor
