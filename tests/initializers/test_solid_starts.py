"""Starts for solids, and as-rigid-as-possible ones: laws of each."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from workbench.core.constraints import Anchors
from workbench.core.distortion import Distortion
from workbench.core.errors import MeshError
from workbench.core.injectivity import global_injectivity
from workbench.core.jacobians import build_elements, determinants, signed_singular_values, simplex_measures
from workbench.core.linear_maps import dirichlet_matrix
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.ray_hits import farthest_hits
from workbench.core.rigid_start import rigid_map
from workbench.core.samples import make_sample, sample_info
from workbench.core.solid_boundary import boundary_images, gauge, solid_boundary
from workbench.core.sphere_map import balanced_map, flipped_triangles, spherical_map, without_flips
from workbench.engine.starts import make_start


def inverted(mesh: Mesh, positions: np.ndarray) -> int:
    return int(np.count_nonzero(~(determinants(build_elements(mesh), positions) > 0)))


def lump(mesh: Mesh) -> Mesh:
    """A ball made star-shaped but far from round: some rays are three times as long as others."""
    directions = mesh.vertices / np.maximum(np.linalg.norm(mesh.vertices, axis=1, keepdims=True), 1e-12)
    x, y, z = directions.T
    radius = 1.0 + 0.4 * np.sin(3.0 * x + 1.0) * np.cos(2.0 * y) + 0.3 * z
    return Mesh(mesh.vertices * radius[:, None] * (1.6, 1.0, 0.8), mesh.simplices)


# ------------------------------------------------------------------------------------------- the sphere


@pytest.mark.parametrize("id", ["blob", "ball", "bar-3d"])
def test_the_spherical_map_folds_nothing(id: str) -> None:
    mesh = make_sample(id)
    surface = mesh if mesh.dimension == 2 else solid_boundary(mesh).surface
    sphere = spherical_map(surface)
    assert np.allclose(np.linalg.norm(sphere, axis=1), 1.0)
    assert len(flipped_triangles(surface.simplices, sphere)) == 0
    corners = sphere[surface.simplices]
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    dots = [np.einsum("ij,ij->i", u, v) for u, v in ((a, b), (b, c), (c, a))]
    solid = 2.0 * np.arctan2(np.einsum("ij,ij->i", a, np.cross(b, c)), 1.0 + sum(dots))
    assert solid.sum() == pytest.approx(4.0 * np.pi)  # covered once


def test_the_spherical_map_of_a_sphere_is_a_rotation_or_nearly() -> None:
    surface = solid_boundary(make_sample("ball", 20_000)).surface
    sphere = spherical_map(surface)
    left, _, right = np.linalg.svd(sphere.T @ surface.vertices)
    assert np.abs(sphere @ (left @ right) - surface.vertices).max() < 0.05


def test_the_balanced_map_gives_arms_more_room_and_folds_nothing() -> None:
    surface = make_sample("salamander", 2500)
    stretches = []
    for map_to_sphere in (spherical_map, balanced_map):
        sphere = map_to_sphere(surface)
        assert np.allclose(np.linalg.norm(sphere, axis=1), 1.0)
        assert len(flipped_triangles(surface.simplices, sphere)) == 0
        areas = [simplex_measures(Mesh(x, surface.simplices)) for x in (surface.vertices, sphere)]
        factors = areas[1] / areas[0]
        stretches.append(factors.min() / np.median(factors))
    assert stretches[1] > 20.0 * stretches[0]


def test_flips_are_relaxed_away() -> None:
    surface = solid_boundary(make_sample("ball")).surface
    shaken = surface.vertices + np.random.default_rng(1).normal(scale=0.15, size=surface.vertices.shape)
    shaken /= np.linalg.norm(shaken, axis=1, keepdims=True)
    assert len(flipped_triangles(surface.simplices, shaken)) > 20
    relaxed = without_flips(surface.simplices, shaken)
    assert len(flipped_triangles(surface.simplices, relaxed)) == 0
    untouched = surface.vertices
    assert without_flips(surface.simplices, untouched) is untouched


# ------------------------------------------------------------------------------------------- the boundary


def test_the_centre_of_a_star_sees_all_of_it() -> None:
    boundary = solid_boundary(lump(make_sample("ball")))
    assert boundary.is_star
    assert len(flipped_triangles(boundary.surface.simplices, boundary.surface.vertices - boundary.centre)) == 0


def test_a_solid_that_bends_back_is_no_star() -> None:
    bar = make_sample("bar-3d")
    turn = 1.5 * np.pi * bar.vertices[:, 0] / 4.0
    x, y = (2.0 - bar.vertices[:, 1]) * np.sin(turn), (bar.vertices[:, 1] - 2.0) * np.cos(turn)
    boundary = solid_boundary(Mesh(np.column_stack([x, y, bar.vertices[:, 2]]), bar.simplices))
    assert not boundary.is_star


def test_what_has_no_sphere_for_a_boundary_is_refused(cube: Mesh) -> None:
    doubled = Mesh(np.vstack([cube.vertices, cube.vertices + 3.0]), np.vstack([cube.simplices, cube.simplices + 27]))
    bar = make_sample("bar-3d", 3000)
    cells = np.floor(5.0 * bar.vertices[bar.simplices].mean(axis=1))
    hollow = Mesh(bar.vertices, bar.simplices[(cells != (10, 2, 2)).any(axis=1)])
    drilled = Mesh(bar.vertices, bar.simplices[(cells[:, :2] != (10, 2)).any(axis=1)])
    flat = make_sample("gingerbread")
    for mesh, word in ((flat, "triangles"), (doubled, "2 comp"), (hollow, "2 comp"), (drilled, "genus 1")):
        with pytest.raises(MeshError, match=word):
            solid_boundary(mesh)


def test_rays_leave_a_sphere_at_its_radius() -> None:
    boundary = solid_boundary(make_sample("ball")).surface
    directions = np.random.default_rng(2).normal(size=(500, 3))
    directions[:3] = np.eye(3)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    hit, shares, distances = farthest_hits(np.zeros(3), directions, boundary.simplices, boundary.vertices)
    assert (hit >= 0).all() and np.allclose(shares.sum(axis=1), 1.0) and shares.min() > -1e-8
    points = np.einsum("ki,kij->kj", shares, boundary.vertices[boundary.simplices[hit]])
    assert np.allclose(points, distances[:, None] * directions)
    assert distances.max() <= 1.0 + 1e-12 and distances.min() > 0.95
    # two spheres, one in the other: the ray goes on to the last
    both = np.vstack([boundary.simplices, boundary.simplices + boundary.vertex_count])
    vertices = np.vstack([3.0 * boundary.vertices, boundary.vertices])
    assert np.allclose(farthest_hits(np.zeros(3), directions, both, vertices)[2], 3.0 * distances)
    outside = farthest_hits(np.array([9.0, 0.0, 0.0]), np.eye(3), boundary.simplices, boundary.vertices)
    assert (outside[0] == -1).all()


# ------------------------------------------------------------------------------------------- radial stretch


@pytest.mark.parametrize("boundary", ["rays", "harmonic", "balanced"])
@pytest.mark.parametrize("shape", ["ball", "cube"])
def test_radial_stretch_puts_the_boundary_on_the_shape(shape: str, boundary: str) -> None:
    mesh = lump(make_sample("ball", 8000))
    positions = make_start(mesh, "volume", "radial-stretch", {"shape": shape, "boundary": boundary})
    sizes = gauge(positions, shape)[mesh.topology.boundary_vertices]
    assert np.ptp(sizes) < 1e-9 * sizes.mean()
    assert gauge(positions, shape).max() <= sizes.max() * (1.0 + 1e-12)
    volume = build_elements(mesh).rest_measures
    assert np.abs(determinants(build_elements(mesh), positions)) @ volume == pytest.approx(volume.sum())


def test_radial_stretch_of_a_star_inverts_nothing_and_keeps_directions() -> None:
    mesh = lump(make_sample("ball", 8000))
    positions = make_start(mesh, "volume", "radial-stretch")
    assert inverted(mesh, positions) == 0
    verdict = global_injectivity(mesh, positions)
    assert verdict.holds is True, verdict.reason
    offsets = mesh.vertices - solid_boundary(mesh).centre
    sizes = np.linalg.norm(offsets, axis=1) * np.linalg.norm(positions, axis=1)
    assert np.einsum("ij,ij->i", offsets, positions) == pytest.approx(sizes)


def test_radial_stretch_of_a_ball_onto_a_ball_moves_the_middle_alone() -> None:
    mesh = make_sample("ball", 8000)
    positions = make_start(mesh, "volume", "radial-stretch")
    assert np.abs(positions - mesh.vertices).max() < 0.02  # flat triangles are stretched to the sphere


def test_radial_stretch_then_symmetric_dirichlet_inverts_nothing() -> None:
    from workbench.core.registry import registry
    from workbench.core.run import run

    mesh = lump(make_sample("ball", 2500))
    positions = make_start(mesh, "volume", "radial-stretch")
    held = mesh.topology.boundary_vertices
    problem = Problem.create(mesh, "volume", Distortion.resolve("symmetric-dirichlet"), Anchors(held, positions[held]))
    result = run(registry().solver("projected-newton").configured({}), problem, positions)
    assert result.state.inverted == 0
    assert result.state.energy < problem.energy(positions)
    assert np.abs(result.state.positions[held] - positions[held]).max() < 1e-9


def test_repair_leaves_fewer_inverted_and_the_boundary_alone() -> None:
    mesh = make_sample("gingerbread-3d", 2000)
    boundary = mesh.topology.boundary_vertices
    for id in ("radial-stretch", "volumetric-harmonic"):
        bare, repaired = (make_start(mesh, "volume", id, {"repair": r}, match_area=False) for r in (False, True))
        assert np.array_equal(bare[boundary], repaired[boundary])
        assert inverted(mesh, repaired) <= inverted(mesh, bare)
    assert inverted(mesh, make_start(mesh, "volume", "radial-stretch", {"repair": False})) > 10
    assert inverted(mesh, make_start(mesh, "volume", "radial-stretch")) <= 5


@pytest.mark.parametrize("sample", ["blob-3d", "gingerbread-3d", "bar-3d", "ball"])
@pytest.mark.parametrize("id", ["radial-stretch", "volumetric-harmonic"])
def test_solid_samples_of_genus_0_come_out_upright(sample: str, id: str) -> None:
    mesh = make_sample(sample)
    positions = make_start(mesh, "volume", id)
    assert inverted(mesh, positions) <= (sample == "gingerbread-3d")


# ------------------------------------------------------------------------------------------- volumetric harmonic


@pytest.mark.parametrize("sample", ["ball", "bar-3d"])
def test_the_volumetric_harmonic_map_has_its_boundary_and_means_inside(sample: str) -> None:
    mesh = make_sample(sample)
    boundary = solid_boundary(mesh)
    for shape in ("ball", "cube"):
        positions = make_start(mesh, "volume", "volumetric-harmonic", {"shape": shape, "repair": False}, match_area=False)
        images = boundary_images(mesh, boundary, shape, "harmonic")
        assert np.array_equal(positions[boundary.vertices], images)
        residual = np.asarray(dirichlet_matrix(mesh) @ positions)
        inner = np.setdiff1d(np.arange(mesh.vertex_count), boundary.vertices)
        assert np.abs(residual[inner]).max() < 1e-10


def test_the_volumetric_harmonic_map_at_rest_is_linear() -> None:
    mesh = lump(make_sample("ball"))
    positions = make_start(mesh, "volume", "volumetric-harmonic", {"shape": "rest"})
    assert np.abs(positions - mesh.vertices).max() < 1e-10


# ------------------------------------------------------------------------------------------- as rigid as possible


@pytest.mark.parametrize("sample", ["bumpy-disc", "fingers"])
def test_the_rigid_start_is_more_rigid_with_each_round(sample: str) -> None:
    mesh = make_sample(sample, 2000)
    problem = Problem.create(mesh, "parameterize", Distortion.resolve("arap"))
    lscm = make_start(mesh, "parameterize", "lscm")
    energies = [problem.energy(lscm)]
    energies += [problem.energy(make_start(mesh, "parameterize", "arap-start", {"rounds": n})) for n in (1, 3, 10, 60)]
    assert all(after < before for before, after in pairwise(energies))
    tutte = make_start(mesh, "parameterize", "arap-start", {"begin": "tutte"})
    assert problem.energy(tutte) < problem.energy(make_start(mesh, "parameterize", "tutte"))


@pytest.mark.parametrize("sample", ["gingerbread", "bar-3d"])
def test_the_rigid_start_follows_rigid_anchors_exactly(sample: str) -> None:
    mesh, kind = make_sample(sample), sample_info(sample).kind
    d = mesh.dimension
    turn = np.linalg.qr(np.random.default_rng(4).normal(size=(d, d)))[0]
    turn[:, 0] *= np.sign(np.linalg.det(turn))
    moved = mesh.vertices @ turn.T + 2.0
    held = np.array(sample_info(sample).anchors)
    problem = Problem.create(mesh, kind, Distortion.resolve("mips"), Anchors(held, moved[held]))
    start = make_start(mesh, kind, "arap-start", {"rounds": 400}, problem=problem)
    assert np.abs(start[held] - moved[held]).max() == 0.0
    assert np.abs(start - moved).max() < 2e-3 * mesh.diameter


def test_the_rigid_start_of_a_twisted_bar_is_upright_and_near_rigid() -> None:
    mesh = make_sample("bar-3d")
    ends = np.flatnonzero((mesh.vertices[:, 0] == 0.0) | (mesh.vertices[:, 0] == 4.0))
    angle = 0.5 * np.pi * mesh.vertices[ends, 0] / 4.0
    y, z = (mesh.vertices[ends, 1:] - 0.5).T
    turned = np.stack([np.cos(angle) * y - np.sin(angle) * z, np.sin(angle) * y + np.cos(angle) * z], axis=1) + 0.5
    anchors = Anchors(ends, np.column_stack([mesh.vertices[ends, 0], turned]))
    problem = Problem.create(mesh, "volume", Distortion.resolve("symmetric-dirichlet"), anchors)
    positions = make_start(mesh, "volume", "arap-start", problem=problem)
    assert inverted(mesh, positions) == 0
    assert np.array_equal(positions[ends], anchors.targets)
    sigma = signed_singular_values(problem.elements, positions)
    assert np.abs(sigma - 1.0).max() < 0.4


def test_rounds_undo_inversions_that_nothing_holds(cube: Mesh) -> None:
    shaken = cube.vertices + np.random.default_rng(7).normal(scale=0.3, size=cube.vertices.shape)
    assert inverted(cube, shaken) > 5
    problem = Problem.create(cube, "volume", Distortion.resolve("arap"))
    assert problem.energy(rigid_map(problem, shaken, 500, tolerance=0.0)) < 1e-3 * problem.energy(shaken)
