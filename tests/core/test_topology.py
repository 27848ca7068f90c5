"""Laws of the topology of a mesh, over surfaces whose topology is known."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from workbench.core.load_report import report_lines
from workbench.core.mesh import Mesh
from workbench.core.topology import analyse_topology

TETRAHEDRON = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])


def sphere() -> Mesh:
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    return Mesh(corners, TETRAHEDRON)


def tube(around: int = 9, along: int = 7, *, close: bool = False, twist: bool = False) -> Mesh:
    """A cylinder of two loops; its ends joined, a torus; joined against each other, a Klein bottle."""
    rows = along if close else along + 1
    index = np.arange(rows * around).reshape(rows, around)
    if close:
        last = index[:1, (-np.arange(around)) % around] if twist else index[:1]
        index = np.vstack([index, last])
    here, right = index[:-1], np.roll(index, -1, axis=1)[:-1]
    above, corner = index[1:], np.roll(index, -1, axis=1)[1:]
    if close and twist:
        corner[-1] = np.roll(index[-1], -1)
    triangles = np.concatenate([np.stack([here, right, corner], -1), np.stack([here, corner, above], -1)]).reshape(-1, 3)
    u, v = np.meshgrid(np.arange(around) * 2 * np.pi / around, np.arange(rows) * 2 * np.pi / along)
    radius = 3 + np.cos(u)
    vertices = np.column_stack(
        [(radius * np.cos(v)).ravel(), (radius * np.sin(v)).ravel(), np.sin(u).ravel() + 0.01 * v.ravel()]
    )
    return Mesh(vertices, triangles)


def moebius(cells: int = 12) -> Mesh:
    """A strip joined to itself after half a turn."""
    index = np.arange(2 * cells).reshape(cells, 2)
    index = np.vstack([index, index[:1, ::-1]])
    low, high, low_next, high_next = index[:-1, 0], index[:-1, 1], index[1:, 0], index[1:, 1]
    triangles = np.concatenate([np.stack([low, low_next, high_next], -1), np.stack([low, high_next, high], -1)])
    angle = np.repeat(np.arange(cells) * 2 * np.pi / cells, 2)
    side = np.tile([-0.3, 0.3], cells)
    radius = 2 + side * np.cos(angle / 2)
    vertices = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), side * np.sin(angle / 2)])
    return Mesh(vertices, triangles)


def joined(*meshes: Mesh) -> Mesh:
    """Several meshes as one."""
    offsets = np.cumsum([0, *(m.vertex_count for m in meshes)])
    vertices = np.vstack([m.vertices + 10.0 * i for i, m in enumerate(meshes)])
    return Mesh(vertices, np.vstack([m.simplices + o for m, o in zip(meshes, offsets, strict=False)]))


KNOWN = {
    # surface: components, loops, Euler characteristic, genus, orientable
    "sphere": (sphere(), 1, 0, 2, 0, True),
    "cylinder": (tube(), 1, 2, 0, 0, True),
    "torus": (tube(close=True), 1, 0, 0, 1, True),
    "klein": (tube(close=True, twist=True), 1, 0, 0, None, False),
    "moebius": (moebius(), 1, 1, 0, None, False),
    "three": (joined(sphere(), tube(), tube(close=True)), 3, 2, 2, 1, True),
}


@pytest.mark.parametrize("name", KNOWN)
def test_known_surfaces(name: str) -> None:
    mesh, components, loops, euler, genus, orientable = KNOWN[name]
    found = mesh.topology
    assert (found.component_count, len(found.boundary_loops)) == (components, loops)
    assert (found.euler_characteristic, found.genus, found.is_orientable) == (euler, genus, orientable)
    assert found.is_manifold
    assert not found.is_disc


@pytest.mark.parametrize("name", KNOWN)
def test_nothing_depends_on_the_numbering(name: str) -> None:
    mesh = KNOWN[name][0]
    random = np.random.default_rng(5)
    renumber = random.permutation(mesh.vertex_count)
    vertices = np.empty_like(mesh.vertices)
    vertices[renumber] = mesh.vertices
    turns = random.integers(0, 3, mesh.simplex_count)
    simplices = np.array([np.roll(row, shift) for row, shift in zip(mesh.simplices, turns, strict=True)])
    shuffled = Mesh(vertices, random.permutation(renumber[simplices])).topology
    known = mesh.topology
    for fact in ("component_count", "euler_characteristic", "genus", "is_orientable", "is_consistently_oriented"):
        assert getattr(shuffled, fact) == getattr(known, fact)
    assert sorted(map(len, shuffled.boundary_loops)) == sorted(map(len, known.boundary_loops))
    assert set(shuffled.boundary_vertices) == set(renumber[known.boundary_vertices])


def test_loops_follow_the_orientation_of_the_triangles(square: Mesh) -> None:
    (loop,) = square.topology.boundary_loops
    edges = {(a, b) for row in square.simplices.tolist() for a, b in itertools.pairwise([*row, row[0]])}
    assert all(pair in edges for pair in itertools.pairwise([*loop.tolist(), int(loop[0])]))
    x, y = square.vertices[loop].T
    assert 0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1)) == pytest.approx(1.0)  # counter-clockwise round the square
    assert square.topology.is_disc
    mirrored = Mesh(square.vertices, square.simplices[:, ::-1])
    assert set(map(tuple, mirrored.topology.boundary_facets)) == {(b, a) for a, b in square.topology.boundary_facets}


def test_loops_of_disagreeing_triangles_are_still_loops(square: Mesh) -> None:
    simplices = square.simplices.copy()
    simplices[::3] = simplices[::3, ::-1]
    found = Mesh(square.vertices, simplices).topology
    assert not found.is_consistently_oriented
    assert found.is_orientable
    assert found.is_disc
    assert sorted(found.boundary_loops[0]) == sorted(square.topology.boundary_loops[0])


def test_the_boundary_of_a_boundary_is_empty(cube: Mesh) -> None:
    found = cube.topology
    surface = Mesh(cube.vertices, found.boundary_facets)
    assert not len(surface.topology.boundary_facets)
    assert surface.topology.is_consistently_oriented
    corners = cube.vertices[found.boundary_facets]
    enclosed = np.linalg.det(corners).sum() / 6  # outward: the divergence theorem gives the volume, with its sign
    assert enclosed == pytest.approx(1.0)
    assert found.euler_characteristic == 1
    assert found.component_count == 1
    assert found.is_consistently_oriented


def test_negative_tetrahedra_are_counted(cube: Mesh) -> None:
    simplices = cube.simplices.copy()
    simplices[[3, 7]] = simplices[[3, 7]][:, [0, 1, 3, 2]]
    mixed = Mesh(cube.vertices, simplices)
    assert mixed.topology.negative.tolist() == [3, 7]
    assert any("2 tetrahedra are negatively oriented: 3, 7" in line for line in report_lines(mixed))


def test_an_edge_of_three_triangles_and_a_vertex_of_two_fans() -> None:
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1.0]])
    book = Mesh(points, np.array([[0, 1, 2], [1, 0, 3], [0, 1, 4]])).topology
    assert book.nonmanifold_edges.tolist() == [[0, 1]]
    assert not len(book.nonmanifold_vertices)
    bow_tie = Mesh(points, np.array([[0, 1, 2], [0, 3, 4]])).topology
    assert bow_tie.nonmanifold_vertices.tolist() == [0]
    assert bow_tie.component_count == 2
    assert not len(bow_tie.nonmanifold_edges)


@pytest.mark.parametrize("scale", [1e-90, 1.0, 1e90])
@pytest.mark.parametrize("shift", [0.0, 1e3])
def test_degenerate_whatever_the_scale_and_the_place(scale: float, shift: float) -> None:
    line = np.array([[0.1, 0.7], [0.2, 0.8], [0.4, 1.0], [0.4, 0.2]]) + shift
    mesh = Mesh(line * scale, np.array([[0, 1, 2], [0, 1, 3], [0, 3, 3], [2, 3, 1]]))
    assert mesh.topology.degenerate.tolist() == [0, 2]


def test_thin_is_not_degenerate() -> None:
    thin = Mesh(np.array([[0, 0], [1, 0], [0.5, 1e-9]]), np.array([[0, 1, 2]]))
    assert not len(thin.topology.degenerate)


def test_leftovers_are_found(square: Mesh) -> None:
    vertices = np.vstack([square.vertices[:1] + 9, square.vertices, square.vertices[:2] - 9])
    simplices = np.vstack([square.simplices + 1, square.simplices[5:6] + 1])
    found = analyse_topology(Mesh(vertices, simplices))
    assert found.unreferenced.tolist() == [0, len(vertices) - 2, len(vertices) - 1]
    assert found.repeated.tolist() == [square.simplex_count]


def test_report_says_what_is_wrong() -> None:
    report = " ".join(report_lines(KNOWN["three"][0]))
    assert "3 components" in report
    assert "2 boundary loops" in report
    assert "genus 1" in report
    assert "Not orientable" in " ".join(report_lines(moebius()))
    assert "a disc" not in report
