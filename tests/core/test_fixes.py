"""Laws of the fixes: what they make, what they keep, and that nothing is done unasked."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from workbench.core.errors import MeshError, WorkbenchError
from workbench.core.fixes import FIXES, apply_fixes
from workbench.core.kinds import check_for_kind, helpful_fixes, resolve_kind, source_for_kind
from workbench.core.mesh import Mesh, TextureCoordinates
from workbench.core.plane_frame import into_plane_of
from workbench.io.read import read_mesh


def ball(level: int = 6) -> Mesh:
    """A closed surface of genus 0: the boundary of a cube of `level`^2 cells a side, blown up."""
    side = np.linspace(-1, 1, level + 1)
    points: dict[tuple[float, ...], int] = {}
    triangles = []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            for i in range(level):
                for j in range(level):
                    quad = []
                    for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                        point = np.insert([side[a], side[b]], axis, sign)
                        quad.append(points.setdefault(tuple(point), len(points)))
                    if sign < 0:
                        quad.reverse()
                    if axis == 1:
                        quad.reverse()
                    triangles += [[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]
    vertices = np.array(list(points))
    return Mesh(vertices / np.linalg.norm(vertices, axis=1, keepdims=True), np.array(triangles))


def torus(n: int = 12) -> Mesh:
    i, j = (index.ravel() for index in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    u, v = 2 * np.pi * i / n, 2 * np.pi * j / n
    vertices = np.column_stack([(3 + np.cos(v)) * np.cos(u), (3 + np.cos(v)) * np.sin(u), np.sin(v)])

    def at(a: np.ndarray, b: np.ndarray) -> np.ndarray:
        return (a % n) * n + b % n

    lower = np.column_stack([at(i, j), at(i + 1, j), at(i + 1, j + 1)])
    upper = np.column_stack([at(i, j), at(i + 1, j + 1), at(i, j + 1)])
    return Mesh(vertices, np.concatenate([lower, upper]))


def beside(*meshes: Mesh) -> Mesh:
    offsets = np.cumsum([0, *(m.vertex_count for m in meshes)])
    vertices = np.vstack([m.vertices + 10.0 * i for i, m in enumerate(meshes)])
    return Mesh(vertices, np.vstack([m.simplices + o for m, o in zip(meshes, offsets, strict=False)]))


def touching(first: Mesh, second: Mesh) -> Mesh:
    """Two surfaces that share one vertex."""
    shifted = np.where(second.simplices == 0, 0, second.simplices + first.vertex_count - 1)
    return Mesh(np.vstack([first.vertices, second.vertices[1:] + 5]), np.vstack([first.simplices, shifted]))


def without(mesh: Mesh, *triangles: int) -> Mesh:
    return Mesh(mesh.vertices, np.delete(mesh.simplices, triangles, axis=0))


def pinned_book() -> Mesh:
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1.0]])
    return Mesh(points, np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]]))


TO_CUT = {
    "tetrahedron": Mesh(
        np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]]),
        np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]),
    ),
    "two triangles": Mesh(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]), np.array([[0, 1, 2], [0, 2, 1]])),
    "ball": ball(),
    "torus": torus(),
    "ball with two holes": without(ball(), 0, 70),
    "ball with adjacent holes": without(ball(), 0, 1, 70, 71, 100),
    "torus with a hole": without(torus(), 17),
}


@pytest.mark.parametrize("name", TO_CUT)
def test_cut_makes_a_disc_of_the_same_surface(name: str) -> None:
    mesh = TO_CUT[name]
    fixed = apply_fixes(mesh, ("cut",))
    disc = fixed.mesh
    assert disc.topology.is_disc
    assert disc.topology.is_consistently_oriented
    assert disc.vertex_origin is not None
    np.testing.assert_array_equal(disc.vertex_origin[disc.simplices], mesh.simplices)
    np.testing.assert_array_equal(disc.vertices, mesh.vertices[disc.vertex_origin])
    assert len(fixed.cut_edges) == len(disc.topology.boundary_facets) - len(mesh.topology.boundary_facets)
    assert len(fixed.cut_edges) >= 4


@pytest.mark.parametrize("name", TO_CUT)
def test_what_is_offered_helps(name: str) -> None:
    mesh = TO_CUT[name]
    with pytest.raises(MeshError) as refusal:
        check_for_kind(mesh, "parameterize")
    assert refusal.value.fixes == ("cut",)
    assert "--fix cut" in refusal.value.sentence
    check_for_kind(apply_fixes(mesh, refusal.value.fixes).mesh, "parameterize")


@pytest.mark.parametrize(
    ("mesh", "fixes"),
    [
        (beside(torus(6), ball(8)), ("largest", "cut")),
        (touching(ball(), torus(6)), ("largest", "cut")),
        (pinned_book(), ("cut", "largest")),
        (replace(ball(), simplices=np.where(np.arange(432)[:, None] % 3, ball().simplices, ball().simplices[:, ::-1])),
         ("reorient", "cut")),
    ],
    ids=["components", "touching", "book", "disagreeing"],
)  # fmt: skip
def test_several_fixes_in_the_order_offered(mesh: Mesh, fixes: tuple[str, ...]) -> None:
    assert helpful_fixes(mesh, "parameterize") == fixes
    check_for_kind(apply_fixes(mesh, fixes).mesh, "parameterize")


@pytest.mark.parametrize("name", FIXES)
def test_a_fix_that_is_not_needed_changes_nothing(name: str, dome: Mesh, cube: Mesh) -> None:
    for mesh in (dome, cube):
        fixed = apply_fixes(mesh, (name,))
        assert fixed.mesh is mesh
        assert len(fixed.notes) == 1
        assert fixed.cut_edges.shape == (0, 2)


def test_a_fix_twice_is_the_fix_once() -> None:
    mesh = beside(torus(6), ball(8))
    once = apply_fixes(mesh, ("largest", "cut"))
    twice = apply_fixes(mesh, ("largest", "cut", "largest", "cut", "reorient", "unreferenced"))
    np.testing.assert_array_equal(once.mesh.simplices, twice.mesh.simplices)
    np.testing.assert_array_equal(once.cut_edges, twice.cut_edges)
    assert len(twice.notes) == 6


def test_reorient_turns_the_fewer(dome: Mesh) -> None:
    turned = [3, 20, 21, 50]
    simplices = dome.simplices.copy()
    simplices[turned] = simplices[turned][:, [0, 2, 1]]
    corners = dome.simplices.copy()
    corners[turned] = corners[turned][:, [0, 2, 1]]
    texture = TextureCoordinates(dome.vertices[:, :2], corners)
    fixed = apply_fixes(Mesh(dome.vertices, simplices, texture=texture), ("reorient",)).mesh
    np.testing.assert_array_equal(fixed.simplices, dome.simplices)
    assert fixed.texture is not None
    np.testing.assert_array_equal(fixed.texture.corners, dome.simplices)
    assert fixed.vertex_origin is None


def test_reorient_turns_negative_tetrahedra(cube: Mesh) -> None:
    simplices = cube.simplices.copy()
    simplices[4:9] = simplices[4:9][:, [1, 0, 2, 3]]
    fixed = apply_fixes(Mesh(cube.vertices, simplices), ("reorient",)).mesh
    assert not len(fixed.topology.negative)
    assert fixed.topology.is_consistently_oriented


def test_unreferenced_keeps_the_order_and_the_origin(square: Mesh) -> None:
    vertices = np.vstack([[[9.0, 9.0]], square.vertices[:5], [[8.0, 8.0]], square.vertices[5:]])
    number = np.concatenate([np.arange(1, 6), np.arange(7, len(vertices))])
    mesh = Mesh(vertices, number[square.simplices])
    with pytest.raises(MeshError) as refusal:
        check_for_kind(mesh, "plane")
    assert refusal.value.fixes == ("unreferenced",)
    fixed = apply_fixes(mesh, ("unreferenced",)).mesh
    np.testing.assert_array_equal(fixed.vertices, square.vertices)
    np.testing.assert_array_equal(fixed.simplices, square.simplices)
    np.testing.assert_array_equal(fixed.vertex_origin, number)


def test_seams_compare_coordinates_not_their_numbers(dome: Mesh) -> None:
    corners = np.arange(dome.simplices.size).reshape(-1, 3)
    repeated = TextureCoordinates(dome.vertices[dome.simplices.ravel(), :2], corners)
    mesh = replace(dome, texture=repeated)
    assert apply_fixes(mesh, ("seams",)).mesh is mesh
    assert repeated.coordinates is not None
    shifted = repeated.coordinates.copy()
    right = dome.vertices[dome.simplices].mean(axis=1)[:, 0] > 0.5
    shifted[np.repeat(right, 3)] += 5.0
    fixed = apply_fixes(replace(dome, texture=TextureCoordinates(shifted, corners)), ("seams",))
    assert fixed.mesh.topology.component_count == 2
    assert len(fixed.cut_edges) == 2 * 8
    x = fixed.mesh.vertices[np.unique(fixed.cut_edges), 0]
    np.testing.assert_allclose(x, 0.5)


@pytest.mark.parametrize("count", [1, 2, 6])
def test_words_tell_of_a_map_in_several_charts(count: int) -> None:
    mesh = ball()
    corners = np.arange(mesh.simplices.size).reshape(-1, 3)
    coordinates = mesh.vertices[mesh.simplices.ravel(), :2]
    of_chart = np.minimum(np.arange(len(mesh.simplices)) // 72, count - 1)  # sides of the cube that the ball was
    coordinates[:, 0] += 5.0 * np.repeat(of_chart, 3)
    with pytest.raises(MeshError) as refusal:
        check_for_kind(replace(mesh, texture=TextureCoordinates(coordinates, corners)), "parameterize")
    assert (f"{count} charts" in refusal.value.sentence) == (count > 1) and refusal.value.fixes == ("cut",)


def test_one_sided_surfaces_are_cut_and_then_oriented() -> None:
    n = 12
    index = np.vstack([np.arange(2 * n).reshape(n, 2), [[1, 0]]])
    lower = np.column_stack([index[:-1, 0], index[1:, 0], index[1:, 1]])
    upper = np.column_stack([index[:-1, 0], index[1:, 1], index[:-1, 1]])
    angle = np.repeat(np.arange(n) * 2 * np.pi / n, 2)
    width = np.tile([-0.3, 0.3], n)
    radius = 2 + width * np.cos(angle / 2)
    vertices = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), width * np.sin(angle / 2)])
    mesh = Mesh(vertices, np.vstack([lower, upper]))
    assert not mesh.topology.is_orientable
    assert helpful_fixes(mesh, "parameterize") == ("cut", "reorient")
    check_for_kind(apply_fixes(mesh, ("cut", "reorient")).mesh, "parameterize")
    assert "one-sided" in apply_fixes(mesh, ("reorient",)).notes[0]


def test_unknown_fixes_are_refused(dome: Mesh) -> None:
    with pytest.raises(WorkbenchError, match="largest"):
        apply_fixes(dome, ("repair",))


def test_kinds_by_the_mesh(square: Mesh, dome: Mesh, cube: Mesh) -> None:
    tilted = Mesh(into_space(square), square.simplices)
    assert [resolve_kind(m) for m in (square, tilted, dome, cube)] == ["plane", "plane", "parameterize", "volume"]
    assert resolve_kind(square, "parameterize") == "parameterize"
    for mesh, kind in ((dome, "plane"), (dome, "volume"), (cube, "plane"), (cube, "parameterize"), (dome, "free")):
        with pytest.raises(MeshError):
            resolve_kind(mesh, kind)


def into_space(square: Mesh) -> np.ndarray:
    turn, _ = np.linalg.qr(np.array([[2.0, 1, 0.5], [-1, 3, 1], [0.2, -1, 2]]))
    return np.column_stack([square.vertices, np.zeros(square.vertex_count)]) @ turn + [3.0, -1.0, 2.0]


def test_flat_surfaces_in_space_keep_lengths_and_come_back(square: Mesh) -> None:
    space = into_space(square)
    for simplices in (square.simplices, square.simplices[:, ::-1]):
        mesh = Mesh(space, simplices)
        flat = source_for_kind(mesh, "plane")
        assert flat.vertices.shape[1] == 2
        ends = simplices[:, :2]
        lengths = [np.linalg.norm(np.diff(v[ends], axis=1), axis=2) for v in (space, flat.vertices)]
        np.testing.assert_allclose(*lengths, rtol=1e-13)
        assert not len(flat.topology.negative)
        np.testing.assert_allclose(into_plane_of(space, flat.vertices, flat.vertices), space, atol=1e-14)


def test_constant_z_keeps_x_and_y_to_the_last_digit(square: Mesh) -> None:
    space = np.column_stack([square.vertices / 3, np.full(square.vertex_count, 0.1)])
    mesh = Mesh(space, square.simplices[:, ::-1])
    flat = source_for_kind(mesh, "plane")
    np.testing.assert_array_equal(flat.vertices, square.vertices / 3)
    moved = flat.vertices + 0.125
    np.testing.assert_array_equal(into_plane_of(space, flat.vertices, moved), np.column_stack([moved, space[:, 2]]))


def test_degenerate_simplices_are_refused_by_name(square: Mesh, cube: Mesh) -> None:
    flattened = square.vertices.copy()
    flattened[square.simplices[7]] = [[0.0, 0.0], [0.5, 0.5], [1.0, 1.0]]
    with pytest.raises(MeshError, match="7"):
        check_for_kind(Mesh(flattened, square.simplices), "plane")
    sunk = cube.vertices.copy()
    sunk[cube.simplices[0, 3]] = sunk[cube.simplices[0, :3]].mean(axis=0)
    with pytest.raises(MeshError, match="without volume"):
        check_for_kind(Mesh(sunk, cube.simplices), "volume")


def test_plane_takes_parts_holes_and_any_orientation(square: Mesh) -> None:
    parts = np.vstack([square.simplices[:20], square.simplices[25:, ::-1]])
    mesh = apply_fixes(Mesh(square.vertices, parts), ("unreferenced",)).mesh
    check_for_kind(mesh, "plane")
    assert mesh.topology.component_count >= 1


USABLE = {
    "geometry-central/moebius.obj": ("cut", "reorient"),
    "geometry-central/hourglass_ico.obj": ("largest", "cut"),
    "geometry-central/fan3.obj": ("cut", "largest"),
    "geometry-central/platonic_shelf.obj": ("largest", "cut"),
    "OptCuts/robustness/torus.obj": ("cut",),
    "OptCuts/robustness/torus_with_hole.obj": ("cut",),
    "OptCuts/robustness/multiComp.obj": ("largest", "cut"),
    "OptCuts/robustness/double_triangles.obj": ("largest",),
    "OptCuts/robustness/triangle_clockwise.obj": (),
    "OptCuts/robustness/toy.obj": ("cut", "largest"),
    "OptCuts/with_uv_seams/camel_f_withSUV.obj": ("seams", "cut"),
    "BFF/teapot.obj": ("largest",),
    "BFF/triple_vierbein.obj": ("reorient", "cut", "largest"),
    "BFF/inverted_triangles.obj": ("reorient", "cut"),
    "BFF/punctured-torus.obj": ("cut",),
    "odedstein-meshes/spot/spot_low_resolution.obj": ("cut",),
    "odedstein-meshes/goathead/goathead.obj": ("cut",),
    "odedstein-meshes/torus/torus.obj": ("cut",),
}


@pytest.mark.parametrize("name", USABLE)
def test_trial_meshes_can_be_used_after_what_is_offered(name: str, data_folder: Path) -> None:
    mesh = read_mesh(data_folder / name).mesh
    kind = resolve_kind(mesh)
    if not USABLE[name]:
        check_for_kind(mesh, kind)
        return
    with pytest.raises(MeshError) as refusal:
        check_for_kind(mesh, kind)
    assert refusal.value.fixes == USABLE[name]
    fixed = apply_fixes(mesh, refusal.value.fixes).mesh
    check_for_kind(fixed, kind)
    assert fixed.topology.is_disc


def test_texture_seams_open_a_closed_surface(data_folder: Path) -> None:
    mesh = read_mesh(data_folder / "OptCuts/with_uv_seams/camel_f_withSUV.obj").mesh
    for fixes in (("seams",), ("cut",), ("seams", "cut")):
        assert apply_fixes(mesh, fixes).mesh.topology.is_disc
