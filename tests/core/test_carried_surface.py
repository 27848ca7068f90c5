"""A carried surface is where the piecewise linear map of the volume takes it, and measured as a map of its own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from workbench.core.box_tree import LEAF, build_box_tree
from workbench.core.carried_surface import carry
from workbench.core.errors import MeshError
from workbench.core.jacobians import build_elements
from workbench.core.measure import Measure
from workbench.core.mesh import Mesh
from workbench.core.nearest_tetrahedron import locate
from workbench.core.quality import measure_map, simplex_table
from workbench.core.surface_jacobians import surface_singular_values

DIRICHLET = Measure("symmetric-dirichlet")


def rotation(seed: int) -> np.ndarray:
    turn, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return turn * np.sign(np.linalg.det(turn))


@pytest.fixture
def inner(dome: Mesh) -> Mesh:
    """A bent sheet inside the unit cube."""
    return replace(dome, vertices=0.1 + 0.7 * dome.vertices)


def test_every_simplex_is_in_every_box_above_it(cube: Mesh) -> None:
    tree = build_box_tree(cube.vertices, cube.simplices)
    assert sorted(tree.order[tree.order >= 0]) == list(range(cube.simplex_count))
    leaves = len(tree.low) // 2
    for place, simplex in enumerate(tree.order.tolist()):
        node = leaves + place // LEAF
        while simplex >= 0 and node:
            corners = cube.vertices[cube.simplices[simplex]]
            assert (tree.low[node] <= corners).all() and (corners <= tree.high[node]).all()
            node //= 2


def test_points_are_in_the_tetrahedron_that_is_named(cube: Mesh) -> None:
    points = np.random.default_rng(1).random((500, 3))
    turned = replace(cube, simplices=cube.simplices[:, [0, 1, 3, 2]])
    for mesh in (cube, turned):
        places = locate(mesh, points)
        assert places.weights.min() >= 0
        assert not places.distances.any()
        corners = mesh.vertices[mesh.simplices[places.simplices]]
        np.testing.assert_allclose(np.einsum("kj,kjc->kc", places.weights, corners), points, atol=1e-15)
        np.testing.assert_allclose(places.weights.sum(axis=1), 1.0, atol=1e-15)


def test_vertices_edges_and_faces_belong_to_the_volume(cube: Mesh) -> None:
    corners = cube.vertices[cube.simplices]
    shared = np.concatenate([cube.vertices, corners[:, :2].mean(axis=1), corners[:, :3].mean(axis=1)])
    assert carry(Mesh(shared, [[0, 1, 3]]), cube).outside_count == 0


def test_the_distance_of_a_point_outside_is_that_to_the_cube(cube: Mesh) -> None:
    points = np.random.default_rng(2).normal(0.5, 2.0, size=(500, 3))
    beyond = np.maximum(np.maximum(-points, points - 1.0), 0.0)
    np.testing.assert_allclose(locate(cube, points).distances, np.linalg.norm(beyond, axis=1), rtol=1e-12, atol=1e-15)


def test_the_nearest_of_separate_tetrahedra_is_found_as_by_trying_all() -> None:
    rng = np.random.default_rng(3)
    corners = rng.normal(size=(40, 1, 3)) * 3 + rng.normal(size=(40, 4, 3)) * 0.2
    mesh = Mesh(corners.reshape(-1, 3), np.arange(160).reshape(40, 4))
    points = rng.normal(size=(200, 3)) * 3
    found = locate(mesh, points)
    alone = np.stack([locate(Mesh(mesh.vertices, mesh.simplices[[e]]), points).distances for e in range(40)])
    np.testing.assert_array_equal(found.distances, alone.min(axis=0))
    np.testing.assert_array_equal(found.simplices, alone.argmin(axis=0))


def test_affine_maps_carry_inside_and_outside_alike(cube: Mesh, inner: Mesh) -> None:
    matrix, offset = np.random.default_rng(4).normal(size=(3, 3)), np.array([1.0, -2.0, 3.0])
    for surface in (inner, replace(inner, vertices=inner.vertices + [0.4, 0.0, 0.0])):
        carried = carry(surface, cube)
        np.testing.assert_allclose(carried.at(cube.vertices), surface.vertices, atol=1e-14)
        expected = surface.vertices @ matrix.T + offset
        np.testing.assert_allclose(carried.at(cube.vertices @ matrix.T + offset), expected, atol=1e-13)
    assert carry(inner, cube).note == ""
    assert carried.outside_count == int((surface.vertices[:, 0] > 1).sum()) > 1
    assert carried.farthest == pytest.approx(surface.vertices[:, 0].max() - 1)
    assert f"{carried.outside_count} vertices" in carried.note


def test_what_is_a_little_outside_moves_with_the_nearest_face(cube: Mesh) -> None:
    """Of tetrahedra that are equally near, that which extrapolates least: the map goes on without a jump in size."""
    bent = cube.vertices + 0.1 * np.sin(3 * cube.vertices[:, ::-1])
    on_face = np.random.default_rng(5).random((100, 3)) * [0.0, 1.0, 1.0]
    triangle = [[0, 1, 2]]
    inside, outside = carry(Mesh(on_face, triangle), cube), carry(Mesh(on_face - [1e-6, 0, 0], triangle), cube)
    assert outside.outside_count == 100
    assert np.abs(outside.at(bent) - inside.at(bent)).max() < 4e-6


def test_singular_values_of_a_surface_are_those_of_its_jacobian(dome: Mesh) -> None:
    rng = np.random.default_rng(6)
    moved = rng.normal(size=dome.vertices.shape)
    source, target = (v[dome.simplices[:, 1:]] - v[dome.simplices[:, :1]] for v in (dome.vertices, moved))
    found = surface_singular_values(build_elements(dome), moved)
    for e in range(dome.simplex_count):
        jacobian = target[e].T @ np.linalg.pinv(source[e].T)  # of rank two: its third singular value is zero
        np.testing.assert_allclose(found[e], np.linalg.svd(jacobian, compute_uv=False)[:2], rtol=1e-10)


def test_an_isometry_of_the_volume_is_one_of_the_surface(cube: Mesh, inner: Mesh) -> None:
    carried = carry(inner, cube)
    moved = carried.at(cube.vertices @ rotation(7).T + 2.0)
    np.testing.assert_allclose(carried.measures(moved, [DIRICHLET])[DIRICHLET.id], 4.0, rtol=1e-12)
    found = measure_map(inner, moved)
    assert found["min_det"] == pytest.approx(1.0, rel=1e-12)
    assert found["injective"]["local"] is found["injective"]["global"] is None
    assert found["measures"]["arap"]["max"] < 1e-20
    table = simplex_table(inner, 3.0 * moved)
    np.testing.assert_allclose(table["det"], 9.0, rtol=1e-12)
    assert not table["inverted"].any()


def test_a_collapsed_triangle_has_no_area(inner: Mesh) -> None:
    moved = inner.vertices.copy()
    moved[inner.simplices[0, 1]] = moved[inner.simplices[0, 0]]
    found = measure_map(inner, moved)
    assert found["degenerate"] >= 1
    assert found["measures"][DIRICHLET.id]["max"] == np.inf


def test_triangles_without_area_are_carried_and_left_out_of_the_measures(cube: Mesh, inner: Mesh) -> None:
    flat = [[0, 0, 1], [0, 1, 2]]  # the first row of the grid is straight
    surface = replace(inner, simplices=np.vstack([flat, inner.simplices]))
    bent = cube.vertices + 0.1 * np.sin(3 * cube.vertices[:, ::-1])
    carried, clean = carry(surface, cube), carry(inner, cube)
    assert "2 triangles of the carried surface have no area" in carried.note
    moved = carried.at(bent)
    for name, values in carried.table(moved).items():
        assert np.isnan(values[:2]).all()
        np.testing.assert_array_equal(values[2:], clean.table(moved)[name])
    found = carried.measures(moved, [DIRICHLET])[DIRICHLET.id]
    np.testing.assert_array_equal(found, carried.table(moved)[DIRICHLET.id])
    with pytest.raises(MeshError, match="area"):
        carry(replace(inner, simplices=np.array(flat)), cube)


def test_what_cannot_be_carried_is_refused(cube: Mesh, square: Mesh, inner: Mesh) -> None:
    for surface, volume, what in (
        (inner, inner, "tetrahedra"),
        (cube, cube, "triangles in space"),
        (square, cube, "triangles in space"),
        (replace(inner, vertices=1000 * inner.vertices), cube, "scale"),
    ):
        with pytest.raises(MeshError, match=what):
            carry(surface, volume)
