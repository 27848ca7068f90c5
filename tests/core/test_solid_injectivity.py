"""Verdicts on maps of tetrahedra, on cases made by hand; triangles in space that meet, against brute force in fractions."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from workbench.core.injectivity import global_injectivity, local_injectivity, orientation_signs
from workbench.core.mesh import Mesh
from workbench.core.samples import make_sample
from workbench.core.solid_injectivity import winding_number
from workbench.core.solid_stars import dihedral_range
from workbench.core.triangle_pairs import meeting_triangles

CORNER = np.vstack([np.zeros(3), np.eye(3)])


def pair(*places: tuple[float, float, float], first: tuple = (0, 1, 2), second: tuple = (3, 4, 5)) -> list:
    return meeting_triangles(np.array([first, second]), np.array(places, dtype=np.float64)).tolist()


def fan_of_wedges(turns: float, wedges: int = 12, closed: bool = True) -> tuple[Mesh, np.ndarray]:
    """Tetrahedra round the edge 0-1; in the source they wind once, in the map `turns` times."""
    count = wedges if closed else wedges + 1
    angle = np.arange(count) * 2.0 * np.pi / (wedges if closed else wedges + 2)

    def places(angle: np.ndarray) -> np.ndarray:
        ring = np.stack([np.cos(angle), np.sin(angle), np.full(count, 0.5)], axis=1)
        return np.vstack([[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], ring])

    cells = [(0, 2 + i, 2 + (i + 1) % count, 1) for i in range(wedges)]
    return Mesh(places(angle), cells), places(np.arange(count) * 2.0 * np.pi * turns / wedges)


def bent(mesh: Mesh, angle: float) -> np.ndarray:
    """A bar along x bent to an arc of `angle` in the plane, its inner side 0.6 from the centre."""
    x, y, z = mesh.vertices.T
    turn = angle * x / x.max()
    return np.stack([(1.6 - y) * np.sin(turn), (1.6 - y) * -np.cos(turn), z], axis=1)


# ------------------------------------------------------------------------------------------- verdicts


@pytest.mark.parametrize("size", [1e-65, 1e65])
def test_the_size_of_a_map_changes_nothing(size: float) -> None:
    """Dihedral angles take fourth powers of lengths, which leave the range of numbers long before the lengths do."""
    for turns in (1.0, 2.0):
        mesh, positions = fan_of_wedges(turns)
        for verdict in (local_injectivity, global_injectivity):
            assert verdict(mesh, positions * size).holds is verdict(mesh, positions).holds
    corners = np.vstack([CORNER, [[0.3, 0.3, -0.8]]]) * size
    smallest, largest = dihedral_range(np.array([[0, 1, 2, 3], [0, 2, 1, 4]]), corners)
    assert (smallest, largest) == pytest.approx(dihedral_range(np.array([[0, 1, 2, 3], [0, 2, 1, 4]]), corners / size))


@pytest.mark.parametrize("sample", ["ball", "bar-3d"])
def test_the_identity_is_injective_mirrored_or_not(sample: str) -> None:
    mesh = make_sample(sample)
    for factor, remark in ((1.0, False), (-1.0, True)):
        verdict = global_injectivity(mesh, factor * mesh.vertices)
        assert verdict.holds is True, verdict.reason
        assert ("mirrored" in verdict.reason) is remark
        assert verdict.offenders == ()


def test_an_inverted_and_a_flat_tetrahedron_are_named(cube: Mesh) -> None:
    positions = cube.vertices.copy()
    positions[13] += (0.9, 0.0, 0.0)
    verdict = global_injectivity(cube, positions)
    assert verdict.holds is False and "tetrahedra" in verdict.reason
    assert np.array_equal(verdict.inverted, np.flatnonzero(orientation_signs(cube, positions) < 0))
    assert verdict.offenders[0].kind == "inverted"
    assert np.array_equal(verdict.offenders[0].simplices(cube), verdict.inverted)
    flat = global_injectivity(cube, cube.vertices * (1.0, 1.0, 0.0))
    assert flat.holds is False and len(flat.degenerate) == cube.simplex_count


@pytest.mark.parametrize(("turns", "holds"), [(1, True), (2, False), (3, False)])
def test_wedges_round_an_inner_edge_wind_once(turns: int, holds: bool) -> None:
    mesh, positions = fan_of_wedges(turns)
    assert (orientation_signs(mesh, positions) == 1).all()
    verdict = local_injectivity(mesh, positions)
    assert verdict.holds is holds
    assert (verdict.edges.tolist() == [[0, 1]]) is not holds
    if not holds:
        offenders = verdict.offenders[0]
        assert offenders.kind == "edges" and offenders.vertices(mesh, 0).tolist() == [0, 1]
        assert len(offenders.simplices(mesh)) == 12


@pytest.mark.parametrize(("turns", "holds"), [(0.9, True), (1.0 - 1e-9, True), (1.0 + 1e-9, False), (1.5, False), (2.2, False)])
def test_an_open_fan_of_wedges_must_not_close(turns: float, holds: bool) -> None:
    mesh, positions = fan_of_wedges(turns, closed=False)
    assert (orientation_signs(mesh, positions) == 1).all()
    assert local_injectivity(mesh, positions).holds is holds


def test_an_open_fan_that_closes_exactly_touches_itself() -> None:
    mesh, positions = fan_of_wedges(1.0, closed=False)
    positions[-1] = positions[2]
    verdict = local_injectivity(mesh, positions)
    assert verdict.holds is False
    assert {0, 1} <= set(verdict.vertices.tolist())


def test_a_boundary_vertex_whose_directions_overlap_though_its_edges_do_not() -> None:
    # a fan about the vertex 0 alone: a spiral of tetrahedra, each joined to the next by one face
    steps = 14
    angle = 2.0 * np.pi * 1.2 * np.arange(steps) / (steps - 1)

    def spiral(angle: np.ndarray, rise: float) -> np.ndarray:
        low = np.stack([np.cos(angle), np.sin(angle), rise * angle], axis=1)
        return np.vstack([np.zeros(3), low, low + (0.0, 0.0, 0.25)])

    lower, upper = 1 + np.arange(steps - 1), 1 + steps + np.arange(steps - 1)
    cells = np.vstack(
        [np.column_stack([0 * lower, lower, lower + 1, upper]), np.column_stack([0 * lower, lower + 1, upper + 1, upper])]
    )
    mesh = Mesh(spiral(angle, 0.12), cells)
    assert mesh.topology.component_count == 1
    assert local_injectivity(mesh, mesh.vertices).holds is True
    overlapping = spiral(angle, 0.01)
    assert (orientation_signs(mesh, overlapping) == 1).all()
    verdict = local_injectivity(mesh, overlapping)
    assert verdict.holds is False
    assert 0 in verdict.vertices and not len(verdict.edges)


def test_a_bar_bent_to_a_ring_is_injective_until_its_ends_meet() -> None:
    mesh = make_sample("bar-3d", 1500)
    for angle, holds in ((1.5, True), (1.99, True), (2.0 + 1e-6, False), (2.6, False)):
        positions = bent(mesh, np.pi * angle)
        assert local_injectivity(mesh, positions).holds is True
        verdict = global_injectivity(mesh, positions)
        assert verdict.holds is holds, verdict.reason
        assert (len(verdict.boundary_pairs) > 0) is not holds
    offenders = verdict.offenders[0]
    assert offenders.kind == "boundary" and offenders.indices.shape[1:] == (2, 3)
    marked = offenders.simplices(mesh)
    assert 0 < len(marked) < mesh.simplex_count
    assert np.isin(offenders.vertices(mesh, 0), mesh.simplices[marked]).all()


def test_components_that_touch_overlap_or_nest(cube: Mesh) -> None:
    both = Mesh(np.vstack([cube.vertices, cube.vertices]), np.vstack([cube.simplices, cube.simplices + 27]))
    for scale, shift, holds in (
        (1.0, 1.5, True),
        (1.0, 1.0, False),  # side to side: to touch is to meet
        (1.0, 0.5, False),
        (0.2, 0.4, False),  # inside
        (0.2, 0.8, False),  # inside, touching from there
        (0.2, 1.1, True),
    ):
        positions = np.vstack([cube.vertices, scale * cube.vertices + (shift, 0.4, 0.4)])
        verdict = global_injectivity(both, positions)
        assert verdict.holds is holds, (scale, shift)
    assert "inside" in global_injectivity(both, np.vstack([cube.vertices, 0.2 * cube.vertices + 0.4])).reason


def test_cones_at_one_vertex_must_not_lie_inside_each_other() -> None:
    narrow = CORNER.copy()
    narrow[1:] = 0.4 * CORNER[1:] + 0.2
    source = np.vstack([CORNER, -CORNER[1:]])
    mesh = Mesh(source, [(0, 1, 2, 3), (0, 4, 6, 5)])
    assert global_injectivity(mesh, source).holds is True
    nested = np.vstack([CORNER, narrow[[1, 3, 2]]])
    assert (orientation_signs(mesh, nested) == 1).all()
    verdict = local_injectivity(mesh, nested)
    assert verdict.holds is False and verdict.vertices.tolist() == [0]


def test_two_tetrahedra_on_one_side_of_a_triangle() -> None:
    for x, cell, holds in ((-1.0, (0, 2, 4, 3), True), (1.5, (0, 4, 2, 3), False)):
        mesh = Mesh(np.vstack([CORNER, [[x, 0.3, 0.3]]]), [(0, 1, 2, 3), cell])
        verdict = local_injectivity(mesh, mesh.vertices)
        assert verdict.holds is holds
        assert ("same side" in verdict.reason) is not holds


def test_the_winding_number_counts_spheres_round_a_point() -> None:
    ball = make_sample("ball", 600)
    boundary = ball.topology.boundary_facets
    assert winding_number(np.array([0.1, 0.2, -0.3]), boundary, ball.vertices) == pytest.approx(1.0)
    assert winding_number(np.array([2.0, 0.0, 0.0]), boundary, ball.vertices) == pytest.approx(0.0, abs=1e-12)
    assert winding_number(np.zeros(3), np.vstack([boundary, boundary]), ball.vertices) == pytest.approx(2.0)


# ------------------------------------------------------------------------------------------- pairs of triangles


def test_triangles_without_a_common_vertex() -> None:
    flat = ((0, 0, 0), (2, 0, 0), (0, 2, 0))
    assert pair(*flat, (0.5, 0.5, -1), (0.5, 0.5, 1), (3, 3, 1)) == [[0, 1]]  # through the face
    assert pair(*flat, (0.5, 0.5, 0), (0.5, 0.5, 1), (3, 3, 1)) == [[0, 1]]  # a corner on the face
    assert pair(*flat, (0.5, 0.5, 1e-300), (0.5, 0.5, 1), (3, 3, 1)) == [[0, 1]]  # lost beside the size of the others
    assert pair(*flat, (0.5, 0.5, 1e-60), (0.5, 0.5, 1), (3, 3, 1)) == []
    assert pair(*flat, (1, 0, -1), (1, 0, 1), (1, -3, 0)) == [[0, 1]]  # edge on edge
    assert pair(*flat, (2, 0, 0), (3, 0, 1), (3, 0, -1)) == [[0, 1]]  # corner on corner, two vertices
    assert pair(*flat, (0.4, 0.4, 0), (0.5, 0.4, 0), (0.4, 0.5, 0)) == [[0, 1]]  # in the same plane, inside
    assert pair(*flat, (2, 2, 0), (2, 1, 0), (1, 2, 0)) == []
    assert pair(*flat, (2, 2, 0), (1, 1, 0), (1, 2, 0)) == [[0, 1]]


def test_triangles_with_common_vertices() -> None:
    at_vertex = {"second": (0, 3, 4)}
    flat = ((0, 0, 0), (2, 0, 0), (0, 2, 0))
    assert pair(*flat, (-1, 0, 0), (0, -1, 0), **at_vertex) == []
    assert pair(*flat, (1, 1, 1), (1, 1, -1), **at_vertex) == [[0, 1]]
    assert pair(*flat, (1, 1, 0), (0, 0, 1), **at_vertex) == [[0, 1]]  # an edge runs along the face
    assert pair(*flat, (3, 0, 0), (0, -1, 0), **at_vertex) == [[0, 1]]  # along an edge
    assert pair(*flat, (-3, 0, 0), (0, -1, 0), **at_vertex) == []
    at_edge = {"second": (1, 0, 3)}
    assert pair(*flat, (1, -1, 0), **at_edge) == []
    assert pair(*flat, (1, 5, 0), **at_edge) == [[0, 1]]  # folded onto it
    assert pair(*flat, (1, 5, 1e-30), **at_edge) == []
    assert pair(*flat, (1, 5, 0), first=(0, 1, 2), second=(0, 1, 2)) == [[0, 1]]


COORDINATE = st.one_of(st.integers(-2, 2).map(float), st.integers(-3, 3).map(lambda k: 0.5 + k * 2.0**-53))
POINT = st.tuples(COORDINATE, COORDINATE, COORDINATE)


def cross(u: list, v: list) -> list:
    return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]


def dot(u: list, v: list) -> Fraction:
    return sum((x * y for x, y in zip(u, v, strict=True)), Fraction(0))


def meet_by_separation(first: list, second: list) -> bool:
    """Closed triangles meet unless one of the axes of the separating axis theorem tells them apart; in fractions."""
    first, second = ([list(map(Fraction, p)) for p in triangle] for triangle in (first, second))
    edges = [[[y - x for x, y in zip(t[i], t[(i + 1) % 3], strict=True)] for i in range(3)] for t in (first, second)]
    normals = [cross(e[0], e[1]) for e in edges]
    axes = normals + [cross(u, v) for u in edges[0] for v in edges[1]]
    axes += [cross(n, u) for n, e in zip(normals, edges, strict=True) for u in e]  # for triangles in one plane
    for axis in axes:
        a, b = [dot(axis, p) for p in first], [dot(axis, p) for p in second]
        if max(a) < min(b) or max(b) < min(a):
            return False
    return True


@given(st.lists(POINT, min_size=6, max_size=6))
@settings(max_examples=400)
def test_triangles_meet_as_the_separating_axes_say(points: list) -> None:
    for three in (points[:3], points[3:]):
        u, v = ([Fraction(y) - Fraction(x) for x, y in zip(three[0], three[i], strict=True)] for i in (1, 2))
        if cross(u, v) == [0, 0, 0]:
            return
    assert bool(pair(*points)) == meet_by_separation(points[:3], points[3:])


def test_the_sweep_finds_the_pairs_that_each_pair_alone_gives() -> None:
    generator = np.random.default_rng(3)
    centres = generator.uniform(-1.0, 1.0, (60, 1, 3)) * (1.0, 4.0, 1.0)
    positions = (centres + generator.normal(scale=0.5, size=(60, 3, 3))).reshape(-1, 3)
    triangles = np.arange(180).reshape(60, 3)
    triangles[30:, 0] = triangles[:30, 1]
    found = {tuple(p) for p in meeting_triangles(triangles, positions).tolist()}
    alone = {p for p in combinations(range(60), 2) if len(meeting_triangles(triangles[list(p)], positions))}
    assert found == alone and len(found) > 20
    common = {p for p in found if set(triangles[p[0]]) & set(triangles[p[1]])}
    assert {tuple(p) for p in meeting_triangles(triangles, positions, "joined").tolist()} == common
    assert {tuple(p) for p in meeting_triangles(triangles, positions, "apart").tolist()} == found - common
    assert len(meeting_triangles(triangles, positions, most=7)) == 7
