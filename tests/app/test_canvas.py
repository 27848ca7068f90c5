"""Both ways of drawing: into memory, and through pyvistaqt's widget."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtGui import QImage
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot
from vtkmodules.vtkCommonDataModel import vtkPolyData

from tests.app.fake_engine import bumpy_mesh, grid_mesh
from workbench.app.appearance.theme import LIGHT
from workbench.app.colouring.colour_range import ColourRange
from workbench.app.quantities.quantities import LIVE_QUANTITIES
from workbench.app.views import mesh_view
from workbench.app.views.actors import actor_of, mapper_of
from workbench.app.views.canvas import CardCanvas, MemoryCanvas
from workbench.app.views.flat_picture import compile_pictures
from workbench.app.views.geometry import Geometry
from workbench.app.views.mesh_view import MeshView
from workbench.app.views.textures import Texture
from workbench.core.mesh import Mesh

CANVASES = {"memory": MemoryCanvas, "card": CardCanvas}
PICTURE = Texture("picture", picture=np.random.default_rng(3).integers(0, 255, (7, 10, 3), np.uint8).repeat(9, 0).repeat(9, 1))


@pytest.fixture
def make_view(qtbot: QtBot, monkeypatch: pytest.MonkeyPatch) -> Iterator:
    views = []

    def make(way: str, mesh: Mesh) -> MeshView:
        monkeypatch.setattr(mesh_view, "make_canvas", CANVASES[way])
        view = MeshView(LIGHT)
        qtbot.addWidget(view)
        view.resize(240, 180)
        view.show()
        qtbot.waitExposed(view)
        view.show_geometry(Geometry(mesh.vertices, mesh.simplices), edges=False)
        views.append(view)
        return view

    yield make
    for view in views:
        view.close_view()


def pixels(view: MeshView) -> np.ndarray:
    QTest.qWait(60)
    image = view.grab().toImage().convertToFormat(QImage.Format.Format_RGB888)
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    return rows[:, : 3 * image.width()].reshape(image.height(), -1, 3).astype(int).copy()


@pytest.mark.parametrize("mesh", [grid_mesh(), bumpy_mesh()], ids=["flat", "in space"])
def test_both_ways_draw_the_same_picture(make_view, mesh: Mesh) -> None:
    colour_range = ColourRange(LIVE_QUANTITIES[0])
    colour_range.set_ends(0.0, 1.0)
    pictures = []
    for way in CANVASES:
        view = make_view(way, mesh)
        view.surface.show_range(colour_range)
        view.surface.set_values(np.linspace(0, 1, mesh.simplex_count), np.zeros(mesh.simplex_count, bool))
        view.refresh()
        pictures.append(pixels(view))
    assert pictures[0].std() > 10, "there is something in the picture"
    assert np.abs(pictures[0] - pictures[1]).mean() < 2.0


@pytest.mark.parametrize("way", CANVASES)
def test_points_written_in_place_are_drawn(make_view, way: str) -> None:
    mesh = grid_mesh()
    view = make_view(way, mesh)
    before = pixels(view)
    view.geometry_shown.write(mesh.vertices * [0.3, 1.0])
    view.points_changed()
    view.refresh()
    after = pixels(view)
    paper = (255, 255, 255)
    assert ((after != paper).any(axis=2)).sum() < 0.6 * ((before != paper).any(axis=2)).sum()


@pytest.mark.parametrize("way", CANVASES)
def test_the_camera_draws_vertices_where_it_says(make_view, way: str) -> None:
    mesh = grid_mesh()
    view = make_view(way, mesh)
    picture = pixels(view)
    corners = view.project(view.geometry_shown.points[[0, 20, 252, 272]])
    drawn = np.argwhere((picture != (255, 255, 255)).any(axis=2))[:, ::-1]
    np.testing.assert_allclose(drawn.min(axis=0), corners.min(axis=0), atol=1.6)
    np.testing.assert_allclose(drawn.max(axis=0), corners.max(axis=0), atol=1.6)


@pytest.mark.parametrize("way", CANVASES)
def test_a_closed_view_draws_no_more(make_view, way: str) -> None:
    view = make_view(way, grid_mesh())
    view.close_view()
    view.refresh()
    view.close_view()
    QTest.qWait(20)


def by_opengl_and_painted(view: MeshView) -> list[np.ndarray]:
    drawn = []
    for paints in (False, True):
        if paints:
            view.paint_flat_maps()
            assert view.canvas.painter(240, 180) is not None
        view.refresh()
        drawn.append(pixels(view))
    assert drawn[0].std() > 10, "there is something in the picture"
    return drawn


@pytest.mark.parametrize("zoom", [1.0, 6.0])
def test_a_flat_picture_is_that_of_opengl(make_view, zoom: float) -> None:
    compile_pictures()
    mesh = grid_mesh()
    view = make_view("memory", mesh)
    colour_range = ColourRange(LIVE_QUANTITIES[0])
    colour_range.set_ends(0.0, 1.0)
    view.surface.show_range(colour_range)
    view.geometry_shown.write(mesh.vertices * [1.0, 0.9] + 0.03 * np.sin(7.0 * mesh.vertices[:, ::-1]))
    view.surface.set_values(np.linspace(-0.1, 1.2, mesh.simplex_count), np.zeros(mesh.simplex_count, bool))
    view.set_camera(view.camera.zoomed(zoom, (60.3, 41.7), view.size_in_pixels))
    drawn = by_opengl_and_painted(view)
    differs = (np.abs(drawn[0] - drawn[1]) > 1).any(axis=2)
    assert differs.mean() < 0.01  # where a centre lies on an edge either triangle may have it


@pytest.mark.parametrize("texture", [Texture("circles"), Texture("checkerboard", size=0.7, degrees=30.0), PICTURE], ids=str)
def test_a_texture_is_laid_as_opengl_does(make_view, texture: Texture) -> None:
    compile_pictures()
    mesh = grid_mesh()
    view = make_view("memory", mesh)
    view.geometry_shown.write(mesh.vertices * [1.0, 0.9] + 0.03 * np.sin(7.0 * mesh.vertices[:, ::-1]))
    rest = view.geometry_shown.points.copy()
    view.surface.show_pattern(replace(texture, points=lambda: rest[::-1]))  # not where the triangles are
    drawn = by_opengl_and_painted(view)
    differs = (np.abs(drawn[0] - drawn[1]) > 4).any(axis=2)  # drivers round places in a tile
    assert differs.mean() < 0.01


def test_large_flat_maps_are_painted_unasked_but_not_what_lies_over_them(make_view, monkeypatch: pytest.MonkeyPatch) -> None:
    compile_pictures()
    view = make_view("memory", grid_mesh())
    assert view.canvas.painter(240, 180) is None
    monkeypatch.setattr(view, "_painted_from", view.surface.geometry.simplices.shape[0])
    assert view.canvas.painter(240, 180) is not None
    figure = actor_of(mapper_of(vtkPolyData()))
    view.add_actor(figure)
    assert view.canvas.painter(240, 180) is None
    figure.SetVisibility(False)
    assert view.canvas.painter(240, 180) is not None
    view.surface.set_opacity(0.0)
    assert view.canvas.painter(240, 180) is None


def test_what_is_more_than_flat_colours_is_left_to_opengl(make_view) -> None:
    compile_pictures()
    mesh = grid_mesh()
    view = make_view("memory", mesh)
    view.paint_flat_maps()
    surface = view.surface
    inverted = np.zeros(mesh.simplex_count, bool)
    assert surface.flat_colours() is not None
    surface.set_edges(True)
    assert surface.flat_colours() is None
    surface.set_edges(False)
    inverted[7] = True
    surface.set_values(None, inverted)
    assert surface.flat_colours() is None  # their outlines
    surface.set_values(None, ~inverted & False)
    surface.show_pattern(Texture("checkerboard"))
    assert surface.flat_colours() is None
    assert make_view("memory", bumpy_mesh()).surface.flat_colours() is None  # light


@pytest.mark.parametrize("size", [(240, 180), (241, 180), (240, 183), (243, 181)])
def test_a_screen_that_is_scaled_by_a_fraction_is_painted_to_its_last_row_and_column(make_view, monkeypatch, size) -> None:
    canvas = make_view("memory", grid_mesh()).canvas
    monkeypatch.setattr(canvas, "devicePixelRatioF", lambda: 1.5)
    canvas.resize(*size)
    screen = QImage(*(int(np.ceil(1.5 * side)) for side in size), QImage.Format.Format_RGB888)
    screen.fill("black")
    screen.setDevicePixelRatio(1.5)
    canvas.render(screen)
    rows = np.frombuffer(screen.constBits(), np.uint8).reshape(screen.height(), screen.bytesPerLine())
    colours = rows[:, : 3 * screen.width()].reshape(screen.height(), -1, 3)
    assert (colours.max(axis=2) > 60).all()
