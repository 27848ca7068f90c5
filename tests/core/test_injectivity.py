"""Verdicts on maps, on cases made by hand."""

from __future__ import annotations

import numpy as np
import pytest

from workbench.core.injectivity import global_injectivity, local_injectivity, orientation_signs
from workbench.core.mesh import Mesh
from workbench.core.samples import make_sample


def fan(angles: np.ndarray, closed: bool) -> tuple[Mesh, np.ndarray]:
    """A star of triangles round vertex 0 in the map; the source is the same star with a single turn, or part of one."""
    count = len(angles)
    rest = 2.0 * np.pi * np.arange(count) / (count if closed else count + 1)
    ring = np.arange(1, count + 1)
    following = np.roll(ring, -1) if closed else ring[1:]
    triangles = np.stack([np.zeros_like(following), ring[: len(following)], following], axis=1)
    source = np.vstack([[0.0, 0.0], np.stack([np.cos(rest), np.sin(rest)], axis=1)])
    target = np.vstack([[0.0, 0.0], np.stack([np.cos(angles), np.sin(angles)], axis=1)])
    return Mesh(source, triangles), target


def strip(centre: np.ndarray, width: float) -> np.ndarray:
    """Positions of a strip of quadrilaterals along a polyline."""
    tangent = np.gradient(centre, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1)
    return np.vstack([centre - 0.5 * width * normal, centre + 0.5 * width * normal])


def strip_mesh(count: int) -> Mesh:
    """The straight strip with `count` stations."""
    i = np.arange(count - 1)
    triangles = np.vstack([np.stack([i, i + 1, i + 1 + count], 1), np.stack([i, i + 1 + count, i + count], 1)])
    centre = np.stack([np.linspace(0.0, 10.0, count), np.zeros(count)], axis=1)
    return Mesh(strip(centre, 0.2), triangles)


def test_the_identity_is_injective(square: Mesh) -> None:
    assert local_injectivity(square, square.vertices).holds is True
    assert global_injectivity(square, square.vertices).holds is True


def test_a_star_that_winds_twice_is_positive_but_not_locally_injective() -> None:
    mesh, positions = fan(np.arange(9) * 4.0 * np.pi / 9.0, closed=True)
    assert (orientation_signs(mesh, positions) == 1).all()
    verdict = local_injectivity(mesh, positions)
    assert verdict.holds is False
    assert verdict.vertices.tolist() == [0]
    assert "vertex 0" in verdict.reason
    assert global_injectivity(mesh, positions).holds is False


@pytest.mark.parametrize("turn", np.linspace(0.0, 6.0, 7))
def test_a_star_that_winds_once_passes_however_it_is_turned(turn: float) -> None:
    mesh, positions = fan(np.sort(np.random.default_rng(3).uniform(0.0, 2.0 * np.pi, 40)) + turn, closed=True)
    assert local_injectivity(mesh, positions).holds is True


@pytest.mark.parametrize(("full", "holds"), [(1.98 * np.pi, True), (2.02 * np.pi, False), (3.5 * np.pi, False)])
def test_the_star_of_a_boundary_vertex_must_not_overlap_itself(full: float, holds: bool) -> None:
    mesh, positions = fan(np.linspace(0.0, full, 12), closed=False)
    verdict = local_injectivity(mesh, positions)
    assert verdict.holds is holds
    assert verdict.vertices.tolist() == ([] if holds else [0])


@pytest.mark.parametrize(("nudge", "holds"), [(-1e-300, True), (0.0, False), (1e-300, False)])
def test_a_boundary_star_of_nearly_a_full_turn_is_decided_exactly(nudge: float, holds: bool) -> None:
    mesh, positions = fan(np.linspace(0.0, 2.0 * np.pi, 5), closed=False)
    positions[1:] = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0), (1.0, nudge)]
    assert local_injectivity(mesh, positions).holds is holds


def test_a_spiral_that_overlaps_itself_is_locally_but_not_globally_injective() -> None:
    mesh = strip_mesh(200)
    angle = np.linspace(0.0, 4.0 * np.pi, 200)
    for growth, holds in ((0.10, True), (0.02, False)):
        centre = (1.0 + growth * angle)[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        positions = strip(centre, 0.2)
        assert local_injectivity(mesh, positions).holds is True
        verdict = global_injectivity(mesh, positions)
        assert verdict.holds is holds
        assert (len(verdict.boundary_pairs) == 0) is holds


def test_a_boundary_that_touches_itself_in_one_point_is_found() -> None:
    vertices = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)])
    touching = Mesh(np.vstack([vertices, vertices[:3] + 4.0]), [(0, 1, 2), (0, 2, 3), (4, 5, 6)])
    positions = touching.vertices.copy()
    positions[4:] = [(0.5, 1.0), (1.0, 2.0), (0.0, 2.0)]
    verdict = global_injectivity(touching, positions)
    assert verdict.holds is False
    assert len(verdict.boundary_pairs) == 2
    positions[4, 1] = np.nextafter(1.0, 2.0)
    assert global_injectivity(touching, positions).holds is True


def test_two_fans_at_one_vertex_must_not_lie_along_each_other() -> None:
    mesh = Mesh([(0, 0), (1, 0), (1, 1), (-1, 0), (-1, -1)], [(0, 1, 2), (0, 3, 4)])
    assert global_injectivity(mesh, mesh.vertices).holds is True
    positions = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (2.0, 2.0), (-1.0, 3.0)])
    verdict = global_injectivity(mesh, positions)
    assert verdict.holds is False
    # side 0-2 lies along side 0-3, and its end, as that of side 1-2, touches it
    assert len(verdict.boundary_pairs) == 2


def test_components_may_lie_side_by_side_but_not_on_top_of_each_other() -> None:
    triangle = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])
    mesh = Mesh(np.vstack([triangle, triangle + 5.0]), [(0, 1, 2), (3, 4, 5)])
    assert global_injectivity(mesh, mesh.vertices).holds is True
    inside = np.vstack([triangle, 0.1 * triangle + 0.2])
    for positions in (inside, inside[[3, 4, 5, 0, 1, 2]]):
        verdict = global_injectivity(mesh, positions)
        assert verdict.holds is False
        assert "on top of" in verdict.reason


def test_a_component_in_the_hole_of_another_is_fine() -> None:
    ring = make_sample("annulus", 200)
    vertices = np.vstack([ring.vertices, 0.1 * np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)])])
    last = len(ring.vertices) + np.arange(3)
    mesh = Mesh(vertices, np.vstack([ring.simplices, last]))
    assert global_injectivity(mesh, vertices).holds is True
    filled = vertices.copy()
    filled[last] += (0.5, 0.4)
    assert global_injectivity(mesh, filled).holds is False


def test_inverted_and_degenerate_triangles_are_listed(square: Mesh) -> None:
    positions = square.vertices.copy()
    positions[24] += (0.4, 0.0)
    verdict = local_injectivity(square, positions)
    assert verdict.holds is False
    assert len(verdict.inverted)
    assert (orientation_signs(square, positions)[verdict.inverted] == -1).all()
    flat = square.vertices * [1.0, 0.0]
    verdict = global_injectivity(square, flat)
    assert verdict.holds is False
    assert len(verdict.degenerate) == square.simplex_count


def test_signs_are_those_relative_to_the_source(square: Mesh) -> None:
    turned = Mesh(square.vertices, square.simplices[:, ::-1])
    assert local_injectivity(turned, turned.vertices).holds is True
    assert len(local_injectivity(turned, turned.vertices).inverted) == 0
    verdict = global_injectivity(square, square.vertices * [-1.0, 1.0])
    assert verdict.holds is True
    assert "mirrored" in verdict.reason
    assert len(verdict.inverted) == square.simplex_count


def test_three_triangles_at_an_edge_cannot_all_be_apart() -> None:
    mesh = Mesh([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1)], [(0, 1, 2), (1, 0, 3), (0, 1, 4)])
    positions = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.0, -1.0), (0.5, 2.0)])
    verdict = local_injectivity(mesh, positions)
    assert verdict.holds is False
    assert verdict.edges.tolist() == [[0, 1]]


def test_positions_that_are_not_finite_are_refused(square: Mesh) -> None:
    positions = square.vertices.copy()
    positions[3, 1] = np.nan
    assert local_injectivity(square, positions).holds is False
    assert "vertex 3" in global_injectivity(square, positions).reason


def test_a_long_winding_boundary() -> None:
    mesh = make_sample("hilbert", 20_000)
    flat = np.ascontiguousarray(mesh.vertices[:, :2])
    assert len(mesh.topology.boundary_loops[0]) > 3000
    assert global_injectivity(mesh, flat).holds is True
    # turned about its middle by an angle that grows with the distance: still one-to-one
    radius = np.linalg.norm(flat, axis=1)
    turn = np.exp(1j * radius)
    swirled = (flat @ [1.0, 1j]) * turn
    assert global_injectivity(mesh, np.stack([swirled.real, swirled.imag], axis=1)).holds is True
    # squares of complex numbers cover a disc twice, save where the source lies on one side of a line
    squared = (flat @ [1.0, 1j]) ** 2
    doubled = global_injectivity(mesh, np.stack([squared.real, squared.imag], axis=1))
    assert doubled.holds is False
    assert len(doubled.boundary_pairs)
