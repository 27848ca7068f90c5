"""Pulling, turning and choosing: plain geometry, against what a ray and a projection say."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tests.app.fake_engine import solid_mesh
from workbench.app.handling.gizmo import ARROW, RADIUS, Gizmo
from workbench.app.handling.lasso import box_outline, in_outline
from workbench.app.handling.locks import FREE, axis_lock, normal_lock, pulled, toggled
from workbench.app.handling.normals import faces_away, mean_normal
from workbench.app.handling.rigid_motion import RigidMotion
from workbench.app.handling.turning import Turning, snapped
from workbench.app.handling.visible_points import visible_points
from workbench.app.views.camera import ViewCamera
from workbench.core.solid_look.drawn_faces import drawn_faces

SIZE = (800, 600)


def slanted(seed: int) -> ViewCamera:
    return ViewCamera(axes=Rotation.random(rng=np.random.default_rng(seed)).as_matrix(), half_height=0.7)


@pytest.mark.parametrize("seed", range(8))
def test_a_locked_pull_stays_under_the_pointer_as_far_as_its_lock_lets_it(seed: int) -> None:
    camera, rng = slanted(seed), np.random.default_rng(seed)
    offset = rng.normal(size=2) @ camera.axes[:2]
    np.testing.assert_array_equal(pulled(offset, FREE, camera.axes), offset)
    for name, unit in zip("xyz", np.eye(3), strict=True):
        on_line = pulled(offset, axis_lock(name), camera.axes)
        np.testing.assert_allclose(np.cross(on_line, unit), 0.0, atol=1e-12)
        nearby = [on_line + step * unit for step in (-1e-3, 1e-3)]
        away = [np.linalg.norm((point - offset) @ camera.axes[:2].T) for point in (on_line, *nearby)]
        assert away[0] < min(away[1:]), "no other point of the line is nearer to the pointer"
        in_plane = pulled(offset, axis_lock(name, plane=True), camera.axes)
        assert abs(in_plane @ unit) < 1e-12
        if abs(unit @ camera.axes[2]) > 0.1:  # else the plane is a line on the screen
            np.testing.assert_allclose((in_plane - offset) @ camera.axes[:2].T, 0.0, atol=1e-9)
    along = pulled(offset, normal_lock(np.array([0.0, 3.0, 0.0])), camera.axes)
    np.testing.assert_allclose(along, pulled(offset, axis_lock("y"), camera.axes))


def test_a_line_along_the_sight_is_pulled_up_and_down_and_a_plane_on_edge_stays_finite() -> None:
    offset = np.array([0.3, 0.2, 0.0])
    np.testing.assert_allclose(pulled(offset, axis_lock("z"), np.eye(3)), [0.0, 0.0, 0.2])
    np.testing.assert_allclose(pulled(offset, axis_lock("x", plane=True), np.eye(3)), [0.0, 0.2, 0.0])
    assert toggled(FREE, axis_lock("x")) == axis_lock("x")
    assert toggled(axis_lock("x"), axis_lock("x")) == FREE
    assert toggled(axis_lock("x"), axis_lock("x", plane=True)) == axis_lock("x", plane=True)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("axis", np.eye(3), ids="xyz")
def test_a_pointer_that_follows_a_ring_turns_by_the_ring_s_angle(seed: int, axis: np.ndarray) -> None:
    camera = slanted(seed)
    if abs(axis @ camera.axes[2]) < 0.2:  # on edge, which the next test is about: look a little more from its end
        camera = ViewCamera(axes=camera.axes @ Rotation.from_rotvec(0.5 * np.cross(axis, camera.axes[2])).as_matrix())
        assert abs(axis @ camera.axes[2]) > 0.2
    u = np.cross(axis, [0.6, 0.8, 0.3])
    u /= np.linalg.norm(u)

    def pixel(angle: float) -> tuple[float, float]:
        arm = Rotation.from_rotvec(angle * axis).apply(0.2 * u)
        x, y = camera.project(arm[None], SIZE)[0][0]
        return float(x), float(y)

    centre = camera.project(np.zeros((1, 3)), SIZE)[0][0]
    turning = Turning(axis, camera.axes, (centre[0], centre[1]), pixel(0.4), RADIUS)
    for angle in np.linspace(0.4, 0.4 + 2.5 * 2 * math.pi, 120):
        turning.move(pixel(angle))
    assert turning.angle == pytest.approx(2.5 * 2 * math.pi)
    for angle in np.linspace(0.4 + 5 * math.pi, 0.1, 120):
        turning.move(pixel(angle))
    assert turning.angle == pytest.approx(-0.3)


@pytest.mark.parametrize("tilt", [-0.1, 0.0, 0.1])
def test_a_ring_on_edge_turns_as_its_front_does(tilt: float) -> None:
    axes = Rotation.from_rotvec([tilt, 0.0, 0.0]).as_matrix()
    turning = Turning(np.array([0.0, 1.0, 0.0]), axes, (400.0, 300.0), (400.0, 300.0), 50.0)
    turning.move((425.0, 300.0))
    # the front of a ring about y goes to the right when it turns counter-clockwise, seen from above
    assert turning.angle == pytest.approx(0.5, rel=0.02)
    assert snapped(math.radians(97.0)) == pytest.approx(math.radians(90.0))


def test_handles_are_met_where_they_are_drawn_and_nowhere_else() -> None:
    camera = slanted(3)
    gizmo = Gizmo(np.array([0.1, -0.05, 0.2]), has_rings=True, is_flat=False)
    handles = gizmo.handles(camera, SIZE)
    assert sorted((h.kind, h.axis) for h in handles) == sorted((kind, axis) for kind in ("arrow", "ring") for axis in range(3))
    centre = camera.project(gizmo.centre[None], SIZE)[0][0]
    for handle in handles:
        reach = np.linalg.norm(handle.pixels - centre, axis=1).max()
        assert reach <= (ARROW if handle.kind == "arrow" else RADIUS) + 1e-6, "pixels, whatever the camera"
        if handle.kind == "arrow":
            found = gizmo.handle_at(tuple(handle.pixels[-1]), camera, SIZE)
            assert found is not None and (found.kind, found.axis) == ("arrow", handle.axis)
    assert gizmo.handle_at((float(centre[0]) + 200.0, float(centre[1])), camera, SIZE) is None
    flat = Gizmo(np.zeros(3), has_rings=True, is_flat=True).handles(ViewCamera(), SIZE)
    assert [(h.kind, h.axis) for h in flat] == [("ring", 2), ("arrow", 0), ("arrow", 1)]
    towards_the_eye = Gizmo(np.zeros(3), has_rings=False, is_flat=False).handles(ViewCamera(), SIZE)
    assert [h.axis for h in towards_the_eye] == [0, 1]


def test_a_motion_is_rigid_and_its_parts_lead_to_it() -> None:
    rng = np.random.default_rng(0)
    points = rng.normal(size=(9, 3))
    motion = RigidMotion(rng.normal(size=3), np.array([0.0, 5.0, 0.0]), rng.normal(size=3))
    assert motion.angle == pytest.approx(5.0)
    for part in (0.0, 0.3, 1.0):
        moved = motion.part(part).of(points)
        assert np.allclose(np.linalg.norm(moved[1:] - moved[:-1], axis=1), np.linalg.norm(points[1:] - points[:-1], axis=1))
        centre = motion.part(part).of(motion.centre[None])
        np.testing.assert_allclose(centre[0], motion.centre + part * motion.shift, atol=1e-12)
    np.testing.assert_array_equal(motion.part(0.0).of(points), points)
    flat = RigidMotion(turn=np.array([0.0, 0.0, math.pi / 2])).of(np.array([[1.0, 0.0]]))
    np.testing.assert_allclose(flat, [[0.0, 1.0]], atol=1e-15)


def test_what_is_at_the_back_or_inside_is_known() -> None:
    mesh = solid_mesh()
    triangles = drawn_faces(mesh.simplices).triangles
    sight = np.array([0.6, 0.64, 0.48])
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    away = faces_away(mesh.vertices, triangles, np.arange(mesh.vertex_count), sight)
    np.testing.assert_array_equal(~away, (mesh.vertices == high).any(axis=1))
    some = np.array([5, 3])
    np.testing.assert_array_equal(faces_away(mesh.vertices, triangles, some, -sight), ~(mesh.vertices[some] == low).any(axis=1))
    for axis in range(3):
        face = np.flatnonzero(mesh.vertices[:, axis] == high[axis])
        np.testing.assert_allclose(mean_normal(mesh.vertices, triangles, face), np.eye(3)[axis], atol=1e-12)
    assert mean_normal(mesh.vertices, triangles, np.arange(mesh.vertex_count)) is None, "a closed surface has no mean normal"


def test_a_box_takes_what_is_seen_in_it() -> None:
    # two squares, one before the other, and the corners of the one behind a little farther out
    square = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
    pixels = np.concatenate([square, 1.5 * (square - 5.0) + 5.0, [[5.0, 5.0]]])
    heights = np.array([0.0] * 4 + [1.0] * 4 + [0.5])
    triangles = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])
    everything = np.arange(9)
    chosen = everything[in_outline(pixels, box_outline(np.array([-3.0, -3.0]), np.array([13.0, 6.0])))]
    assert chosen.tolist() == [0, 1, 4, 5, 8]
    assert visible_points(chosen, pixels, heights, triangles).tolist() == [4, 5]
    assert visible_points(chosen, pixels, -heights, triangles).tolist() == [0, 1, 4, 5]
    assert visible_points(everything[:0], pixels, heights, triangles).tolist() == []
