"""Laws of the camera and of picking; no window needed."""

from __future__ import annotations

import numpy as np
import pytest

from workbench.app.views.camera import ViewCamera, axes_for_solid, axes_that_face, slanted_axes
from workbench.app.views.picking import ScreenTriangles, nearest_pixel

SIZE = (500, 400)


@pytest.fixture
def camera() -> ViewCamera:
    return ViewCamera(focal=np.array([0.1, -0.2, 0.3]), axes=slanted_axes(), half_height=0.8)


def test_axes_are_a_rotation(camera: ViewCamera) -> None:
    np.testing.assert_allclose(camera.axes @ camera.axes.T, np.eye(3), atol=1e-14)
    assert np.linalg.det(camera.axes) == pytest.approx(1.0)


def test_projecting_undoes_unprojecting(camera: ViewCamera) -> None:
    for pixel in ((0.0, 0.0), (123.0, 321.0), (499.0, 399.0)):
        point = camera.unproject(pixel, SIZE)
        np.testing.assert_allclose(camera.project(point[None], SIZE)[0][0], pixel, atol=1e-9)


def test_zoom_holds_the_point_under_the_pointer(camera: ViewCamera) -> None:
    pixel = (60.0, 310.0)
    held = camera.unproject(pixel, SIZE)
    closer = camera.zoomed(1.7, pixel, SIZE)
    assert closer.pixels_per_unit(SIZE) == pytest.approx(1.7 * camera.pixels_per_unit(SIZE))
    np.testing.assert_allclose(closer.project(held[None], SIZE)[0][0], pixel, atol=1e-9)


def test_pan_moves_the_picture_with_the_pointer(camera: ViewCamera) -> None:
    points = np.random.default_rng(1).normal(size=(20, 3))
    before = camera.project(points, SIZE)[0]
    after = camera.panned(13.0, -7.0, SIZE).project(points, SIZE)[0]
    np.testing.assert_allclose(after - before, np.tile([13.0, -7.0], (20, 1)), atol=1e-9)


def test_many_turns_remain_a_rotation(camera: ViewCamera) -> None:
    for _ in range(500):
        camera = camera.rotated(3.0, -2.0, SIZE)
    np.testing.assert_allclose(camera.axes @ camera.axes.T, np.eye(3), atol=1e-12)


@pytest.mark.parametrize("size", [(500, 400), (200, 700)])
def test_fit_shows_everything(camera: ViewCamera, size: tuple[int, int]) -> None:
    points = np.random.default_rng(2).normal(size=(50, 3))
    pixels = camera.fitted(points, size).project(points, size)[0]
    assert (pixels > 0).all()
    assert (pixels < size).all()
    extent = np.ptp(pixels, axis=0) / size
    assert extent.max() == pytest.approx(1 / 1.12, rel=1e-6)


def test_the_triangle_in_front_is_picked() -> None:
    pixels = np.array([[0.0, 0], [100, 0], [0, 100], [0, 0], [100, 0], [0, 100]])
    heights = np.array([0.0, 0, 0, 1, 1, 1])
    screen = ScreenTriangles(pixels, heights, np.array([[0, 1, 2], [3, 4, 5]]))
    assert screen.triangle_at((20, 20)) == 1
    assert screen.vertex_at((5, 90), reach=5, reach_inside=50) == 5
    assert screen.triangle_at((90, 90)) == -1


def test_over_the_background_the_reach_decides() -> None:
    pixels = np.array([[0.0, 0], [100, 0], [0, 100]])
    screen = ScreenTriangles(pixels, np.zeros(3), np.array([[0, 1, 2]]))
    assert screen.vertex_at((106, 4), reach=10, reach_inside=10) == 1
    assert screen.vertex_at((120, 4), reach=10, reach_inside=10) == -1
    assert nearest_pixel(np.empty((0, 2)), (0, 0), 10) == -1


@pytest.mark.parametrize("normal", [[0.0, 0, 1], [0, 1, 0], [-1, 0, 0], [1, 2, -3]])
def test_an_open_surface_is_looked_at_from_its_front(normal: list[float]) -> None:
    right = np.cross(normal, [0.3, 0.5, 0.7])
    corners = np.array([np.zeros(3), right, np.cross(normal, right)])
    axes = axes_that_face(corners, np.array([[0, 1, 2]]))
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) > 0
    assert axes[2] @ normal > 0.8 * np.linalg.norm(normal)


def test_a_surface_without_a_front_is_looked_at_from_a_corner() -> None:
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    closed = np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    np.testing.assert_array_equal(axes_that_face(corners, closed), slanted_axes())


@pytest.mark.parametrize("thin", [0, 1, 2])
def test_the_first_look_at_a_flat_solid_is_at_its_broad_face(thin: int) -> None:
    points = np.random.default_rng(thin).random((200, 3))
    points[:, thin] *= 0.2
    axes = axes_for_solid(points)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) > 0
    assert axes[2][thin] > 0.8
    assert np.array_equal(axes_for_solid(np.random.default_rng(thin).random((200, 3))), slanted_axes())
