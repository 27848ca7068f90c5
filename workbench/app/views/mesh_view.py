"""One view of a mesh: a canvas for VTK, our camera, the layer above."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import Signal
from PySide6.QtGui import QColor, QPixmap, QResizeEvent
from PySide6.QtWidgets import QWidget

from workbench.app.appearance.theme import Theme
from workbench.app.views.camera import Pixel, Points, Size, ViewCamera, axes_for_solid, axes_that_face
from workbench.app.views.canvas import make_canvas
from workbench.app.views.drawing_choices import DrawingChoices
from workbench.app.views.flat_picture import FlatPicture, packed
from workbench.app.views.geometry import Geometry
from workbench.app.views.overlay import Overlay
from workbench.app.views.picking import ScreenTriangles, nearest_pixel
from workbench.app.views.surface import Surface
from workbench.core.arrays import Floats, Integers

REACH = 14.0
"""How far from a vertex, in pixels, the pointer may be over the background."""
REACH_INSIDE = 60.0
"""The same over the mesh, where large triangles leave vertices far apart."""
LEAST_SHOWN = 0.02
"""Size of what is shown at least where a place is looked at, of the size of the mesh."""
LEAST_FILLED, LEAST_WHILE_MOVING = 0.75, 0.45
"""Part of a view, in its tighter direction, below which a map that rests, or one that moves, counts as shrunk."""
LEAST_SEEN = 0.1
"""Part of the box round a map below which a view counts as empty."""
PAINTED_FROM = 12_000
"""Triangles of a flat map from which OpenGL without a graphics card would hold up the window."""


class MeshView(QWidget):
    """A view of one `Geometry`; the canvas is composed, so that no framework's names meet ours."""

    camera_changed = Signal()
    drawn = Signal()

    def __init__(self, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.theme = theme
        self.camera = ViewCamera()
        self.geometry_shown: Geometry | None = None
        self.surface: Surface | None = None
        self._is_closed = False
        self.is_drawing = True
        self.drawing = DrawingChoices()
        self._edges_unasked: bool | None = None
        self._wants_fit = True
        self._version = 0
        self._screen: tuple[int, Size, ScreenTriangles] | None = None
        self.canvas = make_canvas(self)
        self.canvas.drawn.connect(self.drawn)
        self._renderer: Any = self.canvas.renderer
        self._picture = FlatPicture()
        self._painted_from = PAINTED_FROM
        self.canvas.painter = self._flat_pixels
        self.overlay = Overlay(self)
        self.setMinimumSize(120, 100)
        self.set_theme(theme)

    # ------------------------------------------------------------------------------------------ content

    def show_geometry(self, geometry: Geometry, *, edges: bool | None = None) -> Surface:
        """Draw another mesh; the camera fits it at the next chance."""
        self.clear()
        self.geometry_shown = geometry
        self._edges_unasked = edges
        self.surface = Surface(geometry, self.theme, edges=edges)
        self._draw_lines(self.surface)
        for actor in self.surface.actors:
            self._renderer.AddActor(actor)
        self.camera = _first_look(geometry)
        self.fit()
        return self.surface

    def clear(self) -> None:
        if self.surface is not None:
            for actor in self.surface.actors:
                self._renderer.RemoveActor(actor)
        self.surface = None
        self.geometry_shown = None
        self._screen = None
        self.refresh()

    def set_drawing(self, choices: DrawingChoices) -> None:
        """Draw edges, wires and other lines as they are wanted, now and for meshes to come."""
        self.drawing = choices
        if self.surface is not None:
            self._draw_lines(self.surface)
        self.refresh()

    def set_lines(self, seams: Integers, boundary: Integers) -> None:
        """Edges (k, 2) of the mesh, drawn while they are wanted."""
        if self.surface is not None:
            self.surface.lines.set_seams(seams)
            self.surface.lines.set_boundary(boundary)
            self.refresh()

    def _draw_lines(self, surface: Surface) -> None:
        choices = self.drawing
        if choices.edges is not None and self._edges_unasked is not False:
            surface.set_edges(choices.edges)
        elif choices.edges:
            surface.set_edges(True)
        surface.set_wireframe(choices.wireframe)
        surface.lines.want(seams=choices.seams, boundary=choices.boundary)

    def add_actor(self, actor: Any) -> None:
        """Draw something beside the mesh, in the units of its display; it stays when another mesh comes."""
        self._renderer.AddActor(actor)

    def remove_actor(self, actor: Any) -> None:
        self._renderer.RemoveActor(actor)
        self.refresh()

    def set_theme(self, theme: Theme) -> None:
        self.theme = theme
        self.overlay.theme = theme
        colour = QColor(theme.view)
        self._renderer.SetBackground(colour.redF(), colour.greenF(), colour.blueF())
        if self.surface is not None:
            self.surface.set_theme(theme)
        self.refresh()

    def points_changed(self) -> None:
        """The geometry was written: what is known of its place on the screen no longer holds."""
        self._version += 1

    def faces_changed(self) -> None:
        """The geometry draws other triangles now."""
        if self.surface is not None:
            self.surface.faces_changed()
        self.points_changed()

    def paint_flat_maps(self) -> None:
        """Draw small flat maps, too, without OpenGL where no graphics card does it: for windows of many views."""
        self._painted_from = 0

    def _flat_pixels(self, width: int, height: int) -> NDArray[np.uint32] | None:
        surface, geometry = self.surface, self.geometry_shown
        if surface is None or geometry is None or not FlatPicture.is_ready or len(geometry.triangles) < self._painted_from:
            return None
        colours = surface.flat_colours()
        texture = surface.flat_texture() if colours is None else None
        if (colours is None and texture is None) or self._draws_more(surface):
            return None
        pixels = self.camera.project(geometry.points, (width, height))[0]
        pixels[:, 1] = height - pixels[:, 1]
        page = packed(QColor(self.theme.view).getRgbF()[:3]), width, height  # type: ignore[arg-type]
        if colours is not None:
            return self._picture.paint(pixels, geometry.triangles, colours, *page)
        assert texture is not None
        return self._picture.paint_texture(pixels, geometry.triangles, *texture, *page)

    def _draws_more(self, surface: Surface) -> bool:
        """Whether there is anything to see but the surface: glyphs, a carried figure."""
        return any(prop.GetVisibility() for prop in self._renderer.GetViewProps() if prop not in surface.actors)

    def refresh(self) -> None:
        """Draw at the next turn of the event loop, where the view is to be seen at all."""
        if self.is_drawing and not self._is_closed and self.is_shown():
            self.canvas.draw_again()
            self.overlay.update()

    def is_shown(self) -> bool:
        return self.isVisible() and not self.window().isMinimized()

    # ------------------------------------------------------------------------------------------ camera

    @property
    def size_in_pixels(self) -> Size:
        return max(self.width(), 1), max(self.height(), 1)

    @property
    def shows_everything(self) -> bool:
        """Whether it fits the whole mesh into the view, and goes on doing so."""
        return self._wants_fit

    def set_camera(self, camera: ViewCamera, *, fits: bool = False) -> None:
        """Look in another way; `fits` where that is to show everything from now on."""
        self.camera = camera
        self._wants_fit = fits
        camera.apply_to(self._renderer.GetActiveCamera())
        self.points_changed()
        self.refresh()
        self.camera_changed.emit()

    def turn(self, camera: ViewCamera) -> None:
        """Look from elsewhere; a view that shows everything goes on doing so."""
        if self._wants_fit:
            self.camera = camera
            self.fit()
        else:
            self.set_camera(camera)

    def look_at(self, vertices: Integers, around: float) -> None:
        """Bring vertices (k,) into the middle, and `around` times as much of what is round them, at most the whole mesh."""
        if self.geometry_shown is not None and len(vertices):
            points, size = self.geometry_shown.vertices[vertices], self.size_in_pixels
            margin = max(around, LEAST_SHOWN / max(float(np.ptp(points, axis=0).max()), 1e-6))
            near, whole = self.camera.fitted(points, size, margin), self.camera.fitted(self.geometry_shown.points, size)
            self.set_camera(replace(near, half_height=min(near.half_height, whole.half_height)))

    def fit(self) -> None:
        """Bring the whole mesh into the view."""
        if self.geometry_shown is not None:
            self.set_camera(self.camera.fitted(self.geometry_shown.points, self.size_in_pixels), fits=True)
        self._wants_fit = True

    def fit_if_it_left(self, phase: str = "running") -> None:
        """Fit once more where the map has grown out of a view whose camera nobody has touched, or shrunk in it.

        The larger the part of the view that it has to fill in this phase of a snapshot, the nearer to the middle it has to be.
        """
        if not self._wants_fit or self.geometry_shown is None:
            return
        least = LEAST_FILLED if phase in ("idle", "finished") else LEAST_WHILE_MOVING
        width, height = self.size_in_pixels
        corners = self.project(box_corners(self.geometry_shown.points))
        (left, top), (right, bottom) = corners.min(axis=0), corners.max(axis=0)
        has_left = left < 0 or top < 0 or right > width or bottom > height
        off_centre = max(abs(left + right - width) / width, abs(top + bottom - height) / height)
        if has_left or off_centre > 1.0 - least or max((right - left) / width, (bottom - top) / height) < least:
            self.fit()

    def fit_if_it_is_gone(self) -> None:
        """Fit once more where next to nothing is to be seen of the map, in a view whose camera nobody has touched."""
        if not self._wants_fit or self.geometry_shown is None:
            return
        corners = self.project(box_corners(self.geometry_shown.points))
        low, high = corners.min(axis=0), corners.max(axis=0)
        seen = np.minimum(high, self.size_in_pixels) - np.maximum(low, 0.0)
        if (seen < 0).any() or np.prod(seen) < LEAST_SEEN * np.prod(high - low):
            self.fit()

    def resizeEvent(self, event: QResizeEvent) -> None:
        self.canvas.setGeometry(self.rect())
        self.overlay.setGeometry(self.rect())
        self.overlay.raise_()
        if self._wants_fit:
            self.fit()  # a view that shows everything goes on doing so while it is resized
        self.points_changed()

    @property
    def pixels_per_unit(self) -> float:
        """Pixels of a unit of the mesh across the line of sight."""
        assert self.geometry_shown is not None
        return self.camera.pixels_per_unit(self.size_in_pixels) * self.geometry_shown.frame.scale

    def project(self, points: Points) -> Floats:
        """(n, 3) of the display -> (n, 2) pixels, y downwards."""
        return self.camera.project(points, self.size_in_pixels)[0]

    def position_at(self, pixel: Pixel) -> Floats:
        """Place (d,) in the mesh's own units under a pixel."""
        assert self.geometry_shown is not None
        return self.geometry_shown.frame.from_display(self.camera.unproject(pixel, self.size_in_pixels))

    # ------------------------------------------------------------------------------------------ picking

    def vertex_at(self, pixel: Pixel) -> int:
        """Vertex meant by a pointer, -1 where there is none near."""
        if self.geometry_shown is None:
            return -1
        point = self._on_screen().vertex_at(pixel, REACH, REACH_INSIDE)
        return self.geometry_shown.faces.vertex_of(point, self.geometry_shown.vertex_count)

    def triangle_at(self, pixel: Pixel) -> int:
        """Triangle of the geometry in front under a pointer, -1 where there is none."""
        return -1 if self.geometry_shown is None else self._on_screen().triangle_at(pixel)

    def simplex_at(self, pixel: Pixel) -> int:
        """Simplex in front under a pointer, -1 where there is none."""
        return -1 if self.geometry_shown is None else self.geometry_shown.faces.simplex_of(self.triangle_at(pixel))

    def is_over_mesh(self, pixel: Pixel) -> bool:
        return self.triangle_at(pixel) >= 0

    def anchor_at(self, pixel: Pixel, reach: float = 11.0) -> int:
        """Vertex of the anchor whose disc is under the pointer, -1 where there is none."""
        scene = self.overlay.scene
        row = nearest_pixel(self.project(scene.anchor_points), pixel, reach)
        return int(scene.anchor_vertices[row]) if row >= 0 else -1

    def _on_screen(self) -> ScreenTriangles:
        """The mesh as it lies in the widget, kept while neither camera nor points change."""
        assert self.geometry_shown is not None
        size = self.size_in_pixels
        if self._screen is None or self._screen[:2] != (self._version, size):
            pixels, heights = self.camera.project(self.geometry_shown.points, size)
            self._screen = (self._version, size, ScreenTriangles(pixels, heights, self.geometry_shown.triangles))
        return self._screen[2]

    # ------------------------------------------------------------------------------------------ end

    def picture(self) -> QPixmap:
        """The view with its anchors, as it is on the screen."""
        return self.grab()

    def close_view(self) -> None:
        """Give the graphics memory back; nothing may be drawn afterwards."""
        if not self._is_closed:
            self._is_closed = True
            self.canvas.close_canvas()


def _first_look(geometry: Geometry) -> ViewCamera:
    if geometry.is_flat:
        return ViewCamera()
    is_solid = geometry.simplices.shape[1] == 4
    return ViewCamera(axes=axes_for_solid(geometry.points) if is_solid else axes_that_face(geometry.points, geometry.triangles))


def box_corners(points: NDArray[np.float32]) -> Floats:
    """Corners (8, 3) of the box round points (n, 3)."""
    ends = np.array([(column.min(), column.max()) for column in points.T])  # ten times quicker than along an axis
    low, high = ends.T
    return np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
