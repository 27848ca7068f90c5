"""Triangles as pixels: areas, linear functions, nearness, layers; skins and views of meshes."""

from __future__ import annotations

import numpy as np
import pytest

from workbench.figures.mesh_pictures import (
    TEXTURE,
    coloured_picture,
    frame_round,
    skin_of,
    textured_picture,
    view_of,
)
from workbench.figures.raster import rasterise

ONE = np.array([[0, 1, 2]])


@pytest.mark.parametrize("turn", [[0, 1, 2], [0, 2, 1]])
def test_a_triangle_covers_its_area_whichever_way_it_turns(turn):
    points = np.array([[3.2, 5.1], [91.7, 12.4], [40.3, 77.9]])
    raster = rasterise(points, ONE[:, turn], 100, 100)
    edges = points[1:] - points[0]
    area = 0.5 * abs(np.linalg.det(edges))
    assert raster.is_covered.sum() == pytest.approx(area, rel=0.01)
    assert not raster.is_covered[0].any() and not raster.is_covered[:, 0].any()


def test_neighbours_leave_no_gap(square):
    raster = rasterise(square.vertices * 97.3 + 1.1, square.simplices, 100, 100)
    assert raster.is_covered[2:98, 2:98].all()
    assert set(np.unique(raster.triangle)) == {-1, *range(square.simplex_count)}


def test_linear_functions_are_reproduced(square):
    points = square.vertices * 50 + 0.3
    raster = rasterise(points, square.simplices, 50, 50)
    found = raster.of_vertices(square.simplices, points)
    rows, columns = np.nonzero(raster.is_covered)
    np.testing.assert_allclose(found[rows, columns], np.column_stack([columns, rows]) + 0.5, atol=1e-9)


def test_the_nearest_is_seen_and_a_higher_layer_before_it():
    points = np.array([[0, 0, 0.0], [20, 0, 0], [0, 20, 0], [0, 0, 1.0], [20, 0, 1], [0, 20, 1]])
    both = np.array([[3, 4, 5], [0, 1, 2]])
    assert rasterise(points, both, 20, 20).triangle[5, 5] == 0
    assert rasterise(points, both[::-1], 20, 20).triangle[5, 5] == 1
    assert rasterise(points, both, 20, 20, np.array([0, 1])).triangle[5, 5] == 1


def test_what_is_outside_or_flat_is_left_out():
    points = np.array([[-50.0, -50.0], [-10.0, -40.0], [-20.0, -5.0], [3.0, 3.0], [6.0, 6.0], [9.0, 9.0]])
    assert not rasterise(points, np.array([[0, 1, 2], [3, 4, 5]]), 20, 20).is_covered.any()


def test_the_skin_of_tetrahedra_is_their_boundary(cube):
    skin = skin_of(cube)
    assert len(skin.triangles) == 6 * 2 * 4  # two triangles a cell of each side
    on_side = (cube.vertices[skin.triangles] % 1.0 == 0.0).all(axis=1).any(axis=1)
    assert on_side.all()
    assert all(set(t) <= set(cube.simplices[s]) for t, s in zip(skin.triangles.tolist(), skin.simplex, strict=True))


def test_a_view_is_a_turn_that_sees_the_front(dome):
    view = view_of(dome)
    np.testing.assert_allclose(view @ view.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(view) == pytest.approx(1.0)
    p, q, r = (dome.vertices @ view.T)[dome.simplices].transpose(1, 0, 2)
    assert np.cross(q - p, r - p)[:, 2].sum() > 0


def test_pictures_show_the_colours_given_and_nothing_outside(square):
    skin = skin_of(square)
    colours = np.tile([0.2, 0.4, 0.6], (square.simplex_count, 1))
    colours[7] = (1.0, 0.0, 0.0)
    image = coloured_picture(square.vertices, skin, colours, frame_round(square.vertices, (1.0, 0.5)))
    assert image.shape[1] == 2 * image.shape[0]
    full = image[image[..., 3] == 1.0][:, :3]
    assert len(full) / image[..., 3].size == pytest.approx(0.5, abs=0.02)  # the square is half of the frame
    assert {tuple(np.round(c, 9)) for c in full} >= {(0.2, 0.4, 0.6), (1.0, 0.0, 0.0)}


def test_a_texture_has_squares_of_the_size_asked_for(square):
    frame = frame_round(square.vertices, (0.5, 0.5))
    image = textured_picture(square.vertices, skin_of(square), square.vertices * 2.0 / 0.5, frame)
    middle = image[image.shape[0] // 2, :, 0]
    switches = np.flatnonzero(np.abs(np.diff(np.round((middle - TEXTURE[1][0]) / (TEXTURE[0][0] - TEXTURE[1][0])))) > 0.5)
    np.testing.assert_allclose(np.diff(switches) / image.shape[1], 0.25, atol=0.01)
