"""Volumes in the window: their faces are drawn, coloured, pointed at; they are cut, peeled and pulled apart."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from pytestqt.qtbot import QtBot
from scipy.spatial import ConvexHull

from tests.app.conftest import Hand, pixel_of, pixels_of
from tests.app.fake_engine import solid_mesh
from workbench.app.main_window import MainWindow
from workbench.core.facets import facet_table, neighbouring_simplices
from workbench.core.solid_look.drawn_faces import DrawnFaces, drawn_faces, faces_between
from workbench.core.solid_look.look import VolumeLook
from workbench.core.solid_look.solid import Solid


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


def test_a_brush_marks_the_faces_of_its_tetrahedra(solid_window: MainWindow, qtbot: QtBot) -> None:
    window = solid_window
    owners = window.target.view.geometry_shown.faces.simplices
    hidden = np.setdiff1d(np.arange(324), owners)
    window.brush.brush([owners[0], hidden[0]], "a test")
    for view in (window.source.view, window.target.view):
        assert view.surface._brush._area.GetNumberOfPolys() == (owners == owners[0]).sum()
        assert view.surface._brush._frames.GetNumberOfLines() == 12, "also what lies inside is found"
    window.brush.brush(owners[:9], "a test")
    assert view.surface._brush.actors[0].GetVisibility()
    window.volume.choose(only_marked=True)
    qtbot.waitUntil(lambda: set(view.geometry_shown.faces.simplices.tolist()) == set(owners[:9].tolist()))
    assert not view.surface._brush.actors[0].GetVisibility(), "nothing else is drawn: colours are not hidden"
    window.volume.choose(only_marked=False)
    qtbot.waitUntil(lambda: view.surface._brush.actors[0].GetVisibility())
    window.brush.brush(hidden, "a test")
    assert not view.surface._brush.actors[0].GetVisibility()
    window.brush.clear()


# ---------------------------------------------------------------------------------------------- looks


def areas(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    a, b, c = (points[triangles[:, corner]] for corner in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def all_points(solid: Solid, faces: DrawnFaces) -> np.ndarray:
    vertices = solid.mesh.vertices
    return vertices if faces.made is None else np.concatenate([vertices, faces.made.at(vertices)])


@pytest.mark.parametrize("normal", [(1.0, 0.0, 0.0), (0.36, 0.48, 0.8), (-0.6, 0.0, 0.8)])
@pytest.mark.parametrize("place", [0.17, 0.5, 0.93])
def test_an_exact_section_is_the_plane_within_the_solid(normal: tuple[float, float, float], place: float) -> None:
    solid = Solid(solid_mesh())
    boundary = areas(solid.mesh.vertices, solid.boundary.triangles).sum()
    outside = 0.0
    for is_flipped in (False, True):
        look = VolumeLook(is_cut=True, is_exact=True, normal=normal, place=place, is_flipped=is_flipped)
        faces = solid.faces(look)
        points = all_points(solid, faces)
        heights = look.heights(solid.mesh.vertices)
        made = faces.made
        share = made.share.astype(float)
        reached = heights[made.first] * (1 - share) + heights[made.second] * share
        np.testing.assert_allclose(reached, 0.0, atol=1e-6)
        shown = np.concatenate([heights, reached])
        assert shown[faces.triangles].max() < 1e-6, "nothing is drawn beyond the plane"
        is_section = (np.abs(shown[faces.triangles]) < 1e-6).all(axis=1)
        section = areas(points, faces.triangles[is_section]).sum()
        frame = np.linalg.svd(np.array([normal]))[2][1:]
        hull = ConvexHull(points[solid.mesh.vertex_count :] @ frame.T)
        assert section == pytest.approx(hull.volume, rel=1e-5), "the solid is convex, and so is its section"
        outside += areas(points, faces.triangles[~is_section]).sum()
    assert outside == pytest.approx(boundary, rel=1e-5), "both halves together have the whole boundary"


def test_points_of_a_section_stay_on_their_edges_when_the_map_moves() -> None:
    solid = Solid(solid_mesh())
    faces = solid.faces(VolumeLook(is_cut=True, is_exact=True, place=0.4))
    matrix = np.random.default_rng(3).normal(size=(3, 3))
    moved = faces.made.at(solid.mesh.vertices @ matrix)
    np.testing.assert_allclose(moved, faces.made.at(solid.mesh.vertices) @ matrix, atol=1e-6)


@pytest.mark.parametrize("look", [VolumeLook(is_cut=True, place=0.3), VolumeLook(is_cut=True, place=0.3, is_flipped=True)])
def test_a_plane_leaves_whole_tetrahedra_on_one_side(look: VolumeLook) -> None:
    solid = Solid(solid_mesh())
    faces = solid.faces(look)
    assert faces.made is None
    middles = look.heights(solid.mesh.vertices)[solid.mesh.simplices].mean(axis=1)
    assert set(faces.simplices.tolist()) <= set(np.flatnonzero(middles < 0).tolist())
    other = solid.faces(replace(look, is_flipped=not look.is_flipped))
    assert not set(faces.simplices.tolist()) & set(other.simplices.tolist())


def test_tetrahedra_pulled_apart_keep_their_shape_and_place() -> None:
    solid = Solid(solid_mesh())
    faces = solid.faces(VolumeLook(spread=1.0))
    points = all_points(solid, faces)
    before, after = solid.mesh.vertices[solid.mesh.simplices], points[faces.corners]
    np.testing.assert_allclose(after.mean(axis=1), before.mean(axis=1), atol=1e-6)
    np.testing.assert_allclose(after[:, 1:] - after[:, :1], 0.5 * (before[:, 1:] - before[:, :1]), atol=1e-6)
    assert len(faces.triangles) == 4 * solid.mesh.simplex_count
    assert faces.vertex_of(int(faces.corners[5, 2]), solid.mesh.vertex_count) == solid.mesh.simplices[5, 2]


def test_of_many_tetrahedra_pulled_apart_the_outer_ones_are_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("workbench.core.solid_look.solid.MOST_SPREAD", 100)
    solid = Solid(solid_mesh((8, 8, 8)))
    drawn = np.unique(solid.faces(VolumeLook(spread=0.5)).simplices)
    assert set(solid.boundary.simplices.tolist()) < set(drawn.tolist())
    assert len(drawn) < solid.mesh.simplex_count


def test_peeling_leaves_what_has_most_and_what_has_no_number() -> None:
    solid = Solid(solid_mesh())
    values = np.arange(solid.mesh.simplex_count, dtype=np.float32)
    values[4] = np.nan
    left = set(solid.faces(VolumeLook(threshold=300.0), values=values).simplices.tolist())
    assert left == {4, *range(300, 324)}
    marked = solid.faces(VolumeLook(threshold=300.0, only_marked=True), values=values, marked=np.array([4, 7, 310]))
    assert set(marked.simplices.tolist()) == {4, 310}
    assert not len(solid.faces(VolumeLook(threshold=1e9), values=np.zeros_like(values)).triangles)


def test_a_cut_shows_the_same_tetrahedra_in_every_view_and_ends(solid_window: MainWindow, qtbot: QtBot) -> None:
    window = solid_window
    views = [window.source.view, window.target.view, *(dock.view for dock in window.maps)]
    window.look.cut_along("x")
    window.look.cut.place.setValue(300)
    qtbot.waitUntil(lambda: window.target.view.surface.ghost.actor.GetVisibility())
    for view in views:
        assert set(view.geometry_shown.faces.simplices.tolist()) < set(range(324))
        assert view.surface._scalars.GetNumberOfTuples() == len(view.geometry_shown.triangles)
        assert view.surface.ghost.actor.GetVisibility()
    window.look.cut.exact.click()
    qtbot.waitUntil(lambda: window.target.view.geometry_shown.faces.made is not None)
    window.look.cut_along("")
    qtbot.waitUntil(lambda: not window.target.view.surface.ghost.actor.GetVisibility())
    for view in views:
        assert np.array_equal(view.geometry_shown.triangles, window.volume.solid.boundary.triangles)
        assert not view.surface.ghost.actor.GetVisibility()


def test_the_veil_lies_over_gaps_and_not_over_colours(solid_window: MainWindow, qtbot: QtBot) -> None:
    window, view = solid_window, solid_window.target.view
    eye = tuple(view.camera.axes[2].tolist())
    pictures = []
    for opacity in (0.0, 0.5):  # what is taken away lies behind what is left
        window.volume.choose(is_cut=True, normal=eye, place=0.5, is_flipped=True, is_exact=False, ghost=opacity)
        qtbot.waitUntil(lambda o=opacity: bool(view.surface.ghost.actor.GetVisibility()) == (o > 0))
        QTest.qWait(60)
        pictures.append(pixels_of(view))
    is_solid = np.abs(pictures[0] - pictures[0][2, 2]).max(axis=2) > 25
    has_changed = np.abs(pictures[1] - pictures[0]).max(axis=2) > 6
    assert has_changed[~is_solid].sum() > 500, "the rest of the solid is seen through the veil"
    assert has_changed[is_solid].mean() < 0.03
    window.volume.choose(ghost=VolumeLook.ghost)


def test_nothing_left_is_no_fault(solid_window: MainWindow, qtbot: QtBot) -> None:
    window, view = solid_window, solid_window.target.view
    for change in ({"threshold": 1e9}, {"is_cut": True, "is_exact": True}, {"spread": 0.5}):
        window.volume.choose(**change)
        window.set_target_style("symmetric-dirichlet")
        qtbot.waitUntil(lambda: not len(view.geometry_shown.triangles))
        assert view.simplex_at((50.0, 50.0)) == -1 and view.vertex_at((50.0, 50.0)) == -1
        view.grab()
    window.volume.show_all()
    qtbot.waitUntil(lambda: len(view.geometry_shown.triangles) > 0)


def test_a_key_cuts_across_the_line_of_sight_and_another_shows_all(solid_window: MainWindow, qtbot: QtBot) -> None:
    window = solid_window
    window.activateWindow()
    QTest.keyClick(window, Qt.Key.Key_C)
    look = window.volume.look
    assert look.is_cut and np.allclose(look.normal, window.source.view.camera.axes[2])
    assert window.actions_by_name["cut"].isChecked() and window.look.cut.axis.currentData() == "view"
    QTest.keyClick(window, Qt.Key.Key_C, Qt.KeyboardModifier.ShiftModifier)
    assert window.volume.look.is_whole and not window.actions_by_name["cut"].isChecked()


def test_the_handle_moves_the_plane(solid_window: MainWindow) -> None:
    window = solid_window
    window.look.cut_along("x")
    QTest.qWait(50)
    handle, hand = window.look.handles[0], Hand(window.source.view)
    place = window.volume.look.place
    begin, way = handle.handle().toPoint(), handle._way()
    end = begin + QPoint(round(0.2 * way[0]), round(0.2 * way[1]))
    hand.drag(begin, end)
    assert window.volume.look.place == pytest.approx(place + 0.2, abs=0.02)
    assert not len(window.document.anchors), "the view has not seen this drag"


def test_peeling_by_the_slider_takes_its_share_away_and_is_held_while_the_map_moves(
    solid_window: MainWindow, qtbot: QtBot
) -> None:
    window = solid_window
    window.document.pin(np.array([0, 40, 111]))
    window.document.move_anchor(0, window.document.positions[0] - 0.4, False)
    qtbot.waitUntil(lambda: abs(window.document.positions[0] - window.document.mesh.vertices[0]).min() > 0.3)
    window.look.peel.peel.setValue(750)
    qtbot.waitUntil(lambda: window.volume.look.threshold is not None)
    qtbot.waitUntil(lambda: len(np.unique(window.target.view.geometry_shown.faces.simplices)) <= 0.26 * 324)
    left = len(set(window.target.view.geometry_shown.faces.simplices.tolist()))
    held = window.volume.look.threshold
    window.document.move_anchor(0, window.document.positions[0] + 0.3, False)
    qtbot.waitUntil(lambda: len(set(window.target.view.geometry_shown.faces.simplices.tolist())) != left)
    assert window.volume.look.threshold == held
    window.volume.show_all()
    assert window.volume.look.is_whole and not window.look.peel.peel.value()


def test_how_solids_are_cut_is_kept_and_nonsense_passed_over(solid_window: MainWindow) -> None:
    window = solid_window
    begins = window.volume.kept()
    window.volume.choose(is_exact=True, cuts_target=True, ghost=0.3)
    window.volume.peel_by_quantity("det")
    kept = window.view_memory.state()["solid"]
    window.volume.take_kept(begins)
    assert window.volume.kept() == begins
    window.volume.take_kept(kept)
    assert window.volume.kept() == kept
    window.volume.take_kept({"section": "yes", "plane": 3, "veil": "thick", "peel_by": 7})
    window.volume.take_kept(begins)
    assert window.volume.kept() == begins


def test_pinning_the_boundary_of_a_solid_leaves_its_inside_free(solid_window: MainWindow, qtbot: QtBot) -> None:
    window = solid_window
    window.actions_by_name["pin"].trigger()
    qtbot.waitUntil(lambda: len(window.document.anchors) > 0)
    x = solid_mesh().vertices
    is_outside = ((x == x.min(axis=0)) | (x == x.max(axis=0))).any(axis=1)
    assert np.array_equal(np.sort(window.document.anchors.vertices), np.flatnonzero(is_outside))
    window.document.clear_anchors()


def test_a_plane_of_the_target_stays_a_plane_there_while_the_map_moves(solid_window: MainWindow, qtbot: QtBot) -> None:
    window, view = solid_window, solid_window.target.view
    window.document.pin(np.array([0, 40, 111]))
    window.volume.choose(is_cut=True, is_exact=True, cuts_target=True, normal=(0.6, 0.0, 0.8), place=0.5)
    window.document.move_anchor(0, window.document.mesh.vertices[0] - np.array([0.5, 0.2, 0.0]), False)
    qtbot.waitUntil(lambda: abs(window.document.positions[0] - window.document.mesh.vertices[0]).max() > 0.4)
    qtbot.waitUntil(lambda: view.geometry_shown.faces.made is not None)
    geometry, normal = view.geometry_shown, np.array([0.6, 0.0, 0.8])
    heights = geometry.points[geometry.vertex_count :] @ normal
    assert np.ptp(heights) < 1e-5
    corners = geometry.points[geometry.triangles] @ normal
    assert corners.max() < heights.max() + 1e-5
    in_source = window.source.view.geometry_shown
    assert np.array_equal(in_source.triangles, geometry.triangles), "the same pieces on both sides"
    assert np.ptp(in_source.points[in_source.vertex_count :] @ normal) > 1e-3
    window.volume.show_all()
    window.volume.choose(cuts_target=False)


def test_turning_one_view_turns_all(solid_window: MainWindow, qtbot: QtBot) -> None:
    window = solid_window
    Hand(window.source.view).drag(QPoint(6, 6), QPoint(60, 20))
    axes = window.source.view.camera.axes
    assert np.array_equal(window.target.view.camera.axes, axes)
    qtbot.waitUntil(lambda: all(np.array_equal(dock.view.camera.axes, axes) for dock in window.maps))


def test_the_controls_are_there_for_solids_only(solid_window: MainWindow, qtbot: QtBot) -> None:
    window = solid_window
    assert window.look.cut.isVisible() and window.look.peel.isVisible()
    window.look.cut_along("y")
    window.open("grid")
    qtbot.waitUntil(lambda: window.document.kind == "plane" and window.target.view.geometry_shown.is_flat)
    assert not window.look.cut.isVisible() and not window.look.peel.isVisible()
    assert not window.actions_by_name["cut"].isEnabled()
    assert len(window.target.view.geometry_shown.triangles) == 480
