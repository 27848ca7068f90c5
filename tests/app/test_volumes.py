"""Volumes in the window: their boundary is drawn, coloured, pointed at."""

from __future__ import annotations

import numpy as np
import pytest
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot

from tests.app.conftest import Hand, pixel_of
from tests.app.fake_engine import solid_mesh
from workbench.app.main_window import MainWindow
from workbench.app.views.drawn_faces import drawn_faces, faces_between
from workbench.core.facets import facet_table, neighbouring_simplices


@pytest.fixture
def solid_window(window: MainWindow, qtbot: QtBot) -> MainWindow:
    """The window with a solid in it."""
    window.open("solid")
    qtbot.waitUntil(lambda: window.document.kind == "volume" and window.document.positions is not None)
    qtbot.waitUntil(lambda: window.target.view.geometry_shown is not None)
    QTest.qWait(30)
    window.commands.fit()
    return window


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_the_faces_of_any_set_of_tetrahedra_are_a_closed_surface_round_its_volume(seed: int) -> None:
    mesh = solid_mesh()
    neighbours = neighbouring_simplices(facet_table(mesh.simplices))
    visible = np.random.default_rng(seed).random(mesh.simplex_count) < 0.5
    triangles, owners = faces_between(mesh.simplices, neighbours, visible)
    assert visible[owners].all()
    a, b, c = (mesh.vertices[triangles[:, corner]] for corner in range(3))
    enclosed = np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0
    corners = mesh.vertices[mesh.simplices[visible]]
    assert enclosed == pytest.approx(np.linalg.det(corners[:, 1:] - corners[:, :1]).sum() / 6.0)
    directed = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    forth, back = (directed @ [1000, 1], directed @ [1, 1000])
    assert np.array_equal(np.sort(forth), np.sort(back)), "every edge is passed in both directions alike"


def test_neighbours_share_three_vertices_and_see_each_other() -> None:
    mesh = solid_mesh((2, 2, 2))
    neighbours = neighbouring_simplices(facet_table(mesh.simplices))
    for simplex, row in enumerate(neighbours.tolist()):
        for corner, other in enumerate(row):
            if other >= 0:
                assert simplex in neighbours[other]
                shared = set(mesh.simplices[simplex].tolist()) & set(mesh.simplices[other].tolist())
                assert shared == set(np.delete(mesh.simplices[simplex], corner).tolist())
    assert (neighbours < 0).sum() == 6 * 4 * 2


def test_a_solid_opens_in_both_views_and_all_panels(solid_window: MainWindow, qtbot: QtBot) -> None:
    window = solid_window
    boundary = drawn_faces(solid_mesh().simplices)
    for view in (window.source.view, window.target.view, *(dock.view for dock in window.maps)):
        assert np.array_equal(view.geometry_shown.triangles, boundary.triangles)
    assert "324 tetrahedra" in window.source.caption.text()
    qtbot.waitUntil(lambda: window.histogram.counts.sum() == 324)
    qtbot.waitUntil(lambda: all(dock.legend.numbers.text() for dock in window.maps))


def test_faces_have_the_colour_of_their_tetrahedron(solid_window: MainWindow, qtbot: QtBot) -> None:
    window = solid_window
    window.set_target_style("det")
    qtbot.waitUntil(lambda: "det" in window.document.snapshot.fields)
    view = window.target.view
    values = np.arange(324, dtype=np.float32)
    inverted = np.zeros(324, bool)
    inverted[7] = True
    view.surface.set_values(values, inverted)
    shown, owners = view.surface._values, view.geometry_shown.faces.simplices
    assert np.array_equal(np.isnan(shown), owners == 7)
    assert np.array_equal(shown[owners != 7], values[owners[owners != 7]])
    assert view.surface._inverted.GetNumberOfPolys() == 4, "all faces of an inverted tetrahedron are drawn"


def test_a_click_anchors_the_vertex_of_the_boundary_that_is_seen(solid_window: MainWindow) -> None:
    window = solid_window
    view = window.source.view
    front = int(view.camera.project(view.geometry_shown.points, view.size_in_pixels)[1].argmax())
    Hand(view).click(pixel_of(view, front))
    assert window.document.anchors.vertices.tolist() == [front]
    assert window.document.anchors.target_array(3).shape == (1, 3)


def test_what_lies_under_the_pointer_is_a_tetrahedron(solid_window: MainWindow) -> None:
    view = solid_window.target.view
    pixel = (0.5 * view.width(), 0.5 * view.height())
    simplex = view.simplex_at(pixel)
    assert set(view.geometry_shown.triangles[view.triangle_at(pixel)].tolist()) <= set(solid_mesh().simplices[simplex].tolist())


def test_a_brush_marks_the_faces_of_its_tetrahedra(solid_window: MainWindow) -> None:
    window = solid_window
    owners = window.target.view.geometry_shown.faces.simplices
    hidden = np.setdiff1d(np.arange(324), owners)
    window.brush.brush([owners[0], hidden[0]], "a test")
    for view in (window.source.view, window.target.view):
        assert view.surface._brush._area.GetNumberOfPolys() == (owners == owners[0]).sum()
    window.brush.brush(hidden, "a test")
    assert not view.surface._brush.actors[0].GetVisibility()
    window.brush.clear()
