"""Laws of refinement: shapes and energies that stay, smooth schemes that are affine, seams, what is refused."""

from __future__ import annotations

from dataclasses import replace

import igl
import numpy as np
import pytest

from tests.conftest import grid
from workbench.core.distortion import Distortion
from workbench.core.errors import FormulaError, WorkbenchError
from workbench.core.jacobians import build_elements, signed_singular_values
from workbench.core.mesh import Mesh, TextureCoordinates
from workbench.core.refine import FIGURE_20, MOST_SIMPLICES, SCHEMES, measure_levels, refine, refined_count
from workbench.core.refine.catmull_clark import catmull_clark_step
from workbench.core.refine.loop import loop_step
from workbench.core.registry import registry
from workbench.core.samples import make_sample
from workbench.core.seams import seam_pairs


def bent(mesh: Mesh) -> np.ndarray:
    """A map of the mesh that is far from rigid, with no inverted simplex."""
    x = mesh.vertices[:, : mesh.dimension]
    return x * np.linspace(1.4, 0.8, mesh.dimension) + 0.08 * np.sin(3.0 * x[:, ::-1] + 1.0)


@pytest.fixture(params=["square", "dome", "cube"])
def any_mesh(request: pytest.FixtureRequest) -> Mesh:
    """Plane, surface, volume."""
    return request.getfixturevalue(request.param)


def measures(mesh: Mesh) -> np.ndarray:
    return build_elements(mesh).rest_measures


# ------------------------------------------------------------------------------------------ linear


@pytest.mark.parametrize("id", sorted(registry().distortions))
def test_energies_survive_linear_refinement(id: str, any_mesh: Mesh) -> None:
    distortion = registry().distortions[id]
    try:
        distortion.compiled(any_mesh.dimension)
    except FormulaError:
        pytest.skip("there is none in this dimension")
    energies = []
    for levels in (0, 1, 2):
        refined = refine(any_mesh, bent(any_mesh), "linear", levels)
        elements = build_elements(refined.mesh)
        energies.append(elements.rest_measures @ distortion.value(signed_singular_values(elements, refined.positions)))
    assert np.isfinite(energies[0])
    np.testing.assert_allclose(energies[1:], energies[0], rtol=1e-12)


def test_linear_children_fill_their_parent_and_are_oriented_as_it_is(any_mesh: Mesh) -> None:
    order = np.arange(any_mesh.dimension + 1)
    mixed = any_mesh.simplices.copy()
    mixed[::2] = mixed[::2][:, np.r_[1, 0, order[2:]]]  # half of them turned over
    refined = refine(replace(any_mesh, simplices=mixed), None, "linear", 1).mesh
    parts = 2**any_mesh.dimension
    np.testing.assert_allclose(measures(refined), np.repeat(measures(any_mesh) / parts, parts), rtol=1e-12)

    def directions(mesh: Mesh) -> np.ndarray:
        corners = mesh.vertices[mesh.simplices]
        edges = np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2)
        if edges.shape[1] == edges.shape[2]:
            return np.sign(np.linalg.det(edges))[:, None]
        normals = np.cross(edges[:, :, 0], edges[:, :, 1])
        return normals / np.linalg.norm(normals, axis=1)[:, None]

    np.testing.assert_allclose(
        directions(refined), np.repeat(directions(replace(any_mesh, simplices=mixed)), parts, 0), atol=1e-9
    )


def test_old_vertices_come_first_and_stay(any_mesh: Mesh) -> None:
    refined = refine(any_mesh, bent(any_mesh), "linear", 2)
    np.testing.assert_array_equal(refined.mesh.vertices[: any_mesh.vertex_count], any_mesh.vertices)
    np.testing.assert_array_equal(refined.positions[: any_mesh.vertex_count], bent(any_mesh))


def test_tetrahedra_are_split_by_the_source_alone_and_keep_their_shape(cube: Mesh) -> None:
    random = np.random.default_rng(5)
    source = replace(cube, vertices=cube.vertices + 0.05 * random.standard_normal(cube.vertices.shape))
    straight = refine(source, source.vertices, "linear", 3).mesh
    twisted = refine(source, bent(source) * [1.0, 9.0, 1.0], "linear", 3).mesh
    np.testing.assert_array_equal(straight.simplices, twisted.simplices)

    def worst_shape(mesh: Mesh) -> float:
        corners = mesh.vertices[mesh.simplices]
        longest = np.linalg.norm(corners[:, :, None] - corners[:, None], axis=3).max(axis=(1, 2))
        return float((measures(mesh) / longest**3).min())

    for levels in (1, 2, 3):
        assert worst_shape(refine(source, None, "linear", levels).mesh) > 0.4 * worst_shape(source)


# ------------------------------------------------------------------------------------------ smooth schemes


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("id", ["annulus", "bumpy-disc", "torus"])
def test_topology_and_orientation_stay(scheme: str, id: str) -> None:
    mesh = make_sample(id)
    refined = refine(mesh, None, scheme, 2).mesh
    assert refined.simplex_count == refined_count(mesh, scheme, 2)
    for fact in ("euler_characteristic", "component_count", "genus", "is_consistently_oriented", "is_manifold"):
        assert getattr(refined.topology, fact) == getattr(mesh.topology, fact)
    assert len(refined.topology.boundary_loops) == len(mesh.topology.boundary_loops)
    assert not len(refined.topology.negative) and not len(refined.topology.unreferenced)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_schemes_commute_with_affine_maps_and_touch_each_column_for_itself(scheme: str, dome: Mesh) -> None:
    matrix, shift = np.array([[1.0, 2.0, -0.5], [0.3, 1.0, 0.0]]), np.array([7.0, -3.0])
    refined = refine(dome, dome.vertices @ matrix.T + shift, scheme, 2)
    np.testing.assert_allclose(refined.positions, refined.mesh.vertices @ matrix.T + shift, atol=1e-13)
    alone = refine(dome, None, scheme, 2)
    assert alone.positions is None
    np.testing.assert_array_equal(alone.mesh.vertices, refined.mesh.vertices)


def by_place(points: np.ndarray) -> np.ndarray:
    """Rows in the order of their places."""
    return points[np.lexsort(np.round(points, 9).T)]


def test_loop_is_that_of_libigl_where_six_triangles_meet(square: Mesh) -> None:
    lifted = Mesh(np.column_stack([square.vertices, np.sin(4.0 * square.vertices[:, 0])]), square.simplices)
    expected, _ = igl.loop(lifted.vertices, lifted.simplices, 3)
    np.testing.assert_allclose(by_place(refine(lifted, None, "loop", 3).mesh.vertices), by_place(expected), atol=1e-14)


@pytest.mark.parametrize("valence", range(3, 13))
def test_loop_weights_have_their_eigenvalues_at_extraordinary_vertices(valence: int) -> None:
    ring = 1 + np.arange(valence)
    fan = np.column_stack([np.zeros(valence, dtype=int), ring, np.roll(ring, -1)])
    _, weights = loop_step(fan, valence + 1)
    weights = weights.toarray()
    spokes = [row for row in weights[valence + 1 :] if row[0] > 0]
    around = np.stack([weights[0], *spokes])
    order = [0, *(1 + np.argsort([int(np.argmax(row[1:])) for row in spokes]))]
    found = np.sort(np.linalg.eigvals(around[order]).real)[::-1]
    second = 0.375 + 0.25 * np.cos(2.0 * np.pi / valence)
    # the limit has a tangent plane (a double second eigenvalue), and bounded curvature (its square comes next)
    np.testing.assert_allclose(found[:3], [1.0, second, second], atol=1e-12)
    assert np.abs(found - second**2).min() < 1e-12


def test_catmull_clark_of_a_cube() -> None:
    corners = np.array([[x, y, z] for x in (-1.0, 1.0) for y in (-1.0, 1.0) for z in (-1.0, 1.0)])
    faces = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
    children, weights = catmull_clark_step(faces, 8)
    points = weights @ corners
    assert children.shape == (24, 4)
    np.testing.assert_allclose(points[:8], corners * 5 / 9, atol=1e-15)
    np.testing.assert_allclose(np.sort(np.abs(points[8:20]), axis=1), np.tile([0.0, 0.75, 0.75], (12, 1)), atol=1e-15)
    np.testing.assert_allclose(np.sort(np.abs(points[20:]), axis=1), np.tile([0.0, 0.0, 1.0], (6, 1)), atol=1e-15)


@pytest.mark.parametrize("scheme", ["loop", "catmull-clark"])
def test_the_boundary_becomes_the_spline_of_the_boundary_alone(scheme: str, dome: Mesh) -> None:
    loop = dome.topology.boundary_loops[0]
    curve = dome.vertices[loop]
    before, after = np.roll(curve, 1, axis=0), np.roll(curve, -1, axis=0)
    expected = np.concatenate([0.75 * curve + 0.125 * (before + after), 0.5 * (curve + after)])
    refined = refine(dome, None, scheme, 1).mesh
    found = refined.vertices[refined.topology.boundary_vertices]
    np.testing.assert_allclose(by_place(found), by_place(expected), atol=1e-14)


def test_vertices_in_no_triangle_and_pinched_ones_stay() -> None:
    points = np.array([[0.0, 0.0], [1, 0], [2, 1], [-1, 0], [-1, -1], [9, 9]])
    bow = Mesh(points, [[0, 1, 2], [0, 3, 4]])
    for scheme in ("loop", "catmull-clark"):
        for levels in (1, 2):
            moved = refine(bow, None, scheme, levels).mesh.vertices
            np.testing.assert_array_equal(moved[[0, 5]], points[[0, 5]])
            assert (moved[1:5] != points[1:5]).any(axis=1).all()


@pytest.mark.parametrize("scheme", ["loop", "catmull-clark"])
def test_smooth_schemes_lessen_the_distortion_or_keep_it_nearly(scheme: str) -> None:
    mesh = make_sample("bumpy-disc")
    distortions = [registry().distortions[id] for id in FIGURE_20]
    rows = measure_levels(mesh, bent(mesh), scheme, 2, distortions)
    for id in FIGURE_20:
        assert rows[2].measures[id] <= 1.02 * rows[0].measures[id]
        assert rows[2].measures[id] != rows[0].measures[id]


# ------------------------------------------------------------------------------------------ texture


@pytest.fixture
def seamed(square: Mesh) -> Mesh:
    """The square with its own places as texture, those of the right half 10 further, every corner with a row of its own."""
    corners = np.arange(square.simplices.size).reshape(-1, 3)
    coordinates = square.vertices[square.simplices].copy()
    coordinates[coordinates[:, :, 0].max(axis=1) > 0.5 + 1e-9] += [10.0, 0.0]
    return replace(square, texture=TextureCoordinates(coordinates.reshape(-1, 2), corners))


def seam_count(mesh: Mesh) -> int:
    from workbench.core.facets import facet_table

    return int(seam_pairs(mesh.texture, facet_table(mesh.simplices)).sum())


def test_linear_refinement_keeps_the_texture_with_its_seam(seamed: Mesh) -> None:
    refined = refine(seamed, None, "linear", 2).mesh
    assert seam_count(refined) == 4 * seam_count(seamed) == 24
    places = refined.vertices[refined.simplices]
    expected = places + np.where(places[:, :, :1].max(axis=1, keepdims=True) > 0.5 + 1e-9, [10.0, 0.0], 0.0)
    np.testing.assert_allclose(refined.texture.coordinates[refined.texture.corners], expected, atol=1e-13)


@pytest.mark.parametrize("scheme", ["loop", "catmull-clark"])
def test_a_seam_is_a_boundary_of_the_texture_and_nothing_to_the_surface(scheme: str, seamed: Mesh) -> None:
    refined = refine(seamed, None, scheme, 2).mesh
    assert seam_count(refined) == 4 * seam_count(seamed)
    np.testing.assert_array_equal(refined.vertices, refine(replace(seamed, texture=None), None, scheme, 2).mesh.vertices)
    # each half of the texture is refined as if it were alone
    half = seamed.simplices[seamed.vertices[seamed.simplices][:, :, 0].max(axis=1) <= 0.5 + 1e-9]
    alone = refine(Mesh(seamed.vertices, half), None, scheme, 2).mesh
    expected = alone.vertices[np.unique(alone.simplices)]
    left = refined.texture.coordinates[refined.texture.coordinates[:, 0] < 5]
    np.testing.assert_allclose(by_place(np.unique(left, axis=0)), by_place(np.unique(expected, axis=0)), atol=1e-12)


# ------------------------------------------------------------------------------------------ measures of levels


def test_a_texture_is_measured_like_positions_also_mirrored(dome: Mesh) -> None:
    distortions = [registry().distortions[id] for id in ("symmetric-dirichlet", "arap")]
    expected = measure_levels(dome, bent(dome), "loop", 1, distortions)
    for sign in (1.0, -1.0):
        coordinates = bent(dome) * [sign, 1.0]
        textured = replace(dome, texture=TextureCoordinates(coordinates, dome.simplices))
        rows = measure_levels(textured, None, "loop", 1, distortions)
        for row, wanted in zip(rows, expected, strict=True):
            assert (row.level, row.simplices, row.vertices, row.inverted) == (
                wanted.level,
                wanted.simplices,
                wanted.vertices,
                0,
            )
            assert row.measures == pytest.approx(wanted.measures, rel=1e-10)


def test_inverted_simplices_are_counted_at_each_level(square: Mesh) -> None:
    folded = square.vertices.copy()
    folded[24] += 0.6
    rows = measure_levels(square, folded, "linear", 1, [Distortion.resolve("symmetric-dirichlet")])
    assert rows[0].inverted > 0 and rows[1].inverted == 4 * rows[0].inverted
    assert rows[1].measures["symmetric-dirichlet"] == np.inf


# ------------------------------------------------------------------------------------------ what is refused


def test_what_cannot_be_refined_is_refused_with_a_sentence(square: Mesh, cube: Mesh) -> None:
    points = np.vstack([np.eye(3), -np.eye(3)[:2]])
    three_at_an_edge = Mesh(points, [[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    twice = Mesh(square.vertices, [[0, 1, 8], [1, 1, 8]])
    refused = [
        (square, None, "butterfly", 1, "no scheme"),
        (cube, None, "loop", 1, "tetrahedra"),
        (cube, None, "catmull-clark", 1, "tetrahedra"),
        (square, None, "linear", -1, "levels"),
        (square, None, "linear", 10**9, "at most"),
        (square, np.zeros((3, 2)), "linear", 1, "shape"),
        (three_at_an_edge, None, "loop", 1, "more than two triangles"),
        (three_at_an_edge, None, "catmull-clark", 1, "more than two triangles"),
        (twice, None, "loop", 1, "same vertex twice"),
    ]  # fmt: skip
    for mesh, positions, scheme, levels, words in refused:
        with pytest.raises(WorkbenchError, match=words):
            refine(mesh, positions, scheme, levels)
    assert refine(three_at_an_edge, None, "linear", 1).mesh.simplex_count == 12


def test_the_largest_result_is_the_limit() -> None:
    mesh = grid(3)
    for scheme in SCHEMES:
        most = max(k for k in range(20) if refined_count(mesh, scheme, k) <= MOST_SIMPLICES)
        with pytest.raises(WorkbenchError, match=f"take {most} levels at most"):
            refine(mesh, None, scheme, most + 1)
