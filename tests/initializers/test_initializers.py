"""Laws of every initializer, and of each."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from workbench.core.convex_map import cotangent_weights, laplacian, map_disc, uniform_weights
from workbench.core.definite_solve import DefiniteFactor, solve_with_fixed
from workbench.core.disc_boundary import convex_outline
from workbench.core.errors import MeshError, WorkbenchError
from workbench.core.initializer import StartRequest
from workbench.core.injectivity import global_injectivity
from workbench.core.jacobians import build_elements, determinants, signed_singular_values
from workbench.core.linear_maps import dirichlet_matrix
from workbench.core.mesh import Mesh
from workbench.core.registry import registry
from workbench.core.samples import make_sample, sample_info
from workbench.core.samples.grids import hexagonal_disc

FLAT, BENT, SOLID = ("gingerbread", "bar"), ("bumpy-disc", "fingers", "hilbert"), ("bar-3d", "ball")
SUITABLE = {"rest": FLAT + SOLID, "tutte": FLAT + BENT, "harmonic": FLAT + BENT + SOLID, "lscm": BENT}
DISCS = {
    "BFF": "face cowhead hemisphere maze",
    "OptCuts": "bimba bunny_decim_noInputUV camel_vova_f10000 hencky_f20000 cat planck1",
    "odedstein-meshes": "hand/hand_lowres mountain/mountain cube/cube_no_bottom",
    "TinyAD-Examples": "bunny_cut",
    "AcceleratedQuadraticProxy": "schaeffer_cow",
}
TO_CUT = (
    ("OptCuts/with_uv_seams/camel_f_withSUV.obj", "seams"),
    ("odedstein-meshes/spot/spot_low_resolution.obj", "cut"),
    ("odedstein-meshes/goathead/goathead.obj", "cut"),
    ("odedstein-meshes/torus/torus.obj", "cut"),
)


def start(id: str, mesh: Mesh, kind: str, file: str = "", **parameters: object) -> np.ndarray:
    return registry().initializer(id).configured(parameters).start(StartRequest(mesh, kind, file))


def inverted(mesh: Mesh, positions: np.ndarray) -> int:
    return int(np.count_nonzero(~(determinants(build_elements(mesh), positions) > 0)))


def disc_with_tubes(length: int) -> Mesh:
    """A flat disc with three closed tubes of radius about 1 on it: their tips shrink by exp(-length) and worse."""
    flat, triangles = hexagonal_disc(20)
    vertices = [np.column_stack([5.0 * flat, np.zeros(len(flat))])]
    sides = np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    graph = coo_array((np.ones(len(sides)), sides.T), shape=(len(flat), len(flat))).tocsr()
    count = len(flat)
    for place in ((0.5, 0.1), (-0.4, 0.35), (-0.1, -0.55)):
        middle = int(np.argmin(np.linalg.norm(flat - place, axis=1)))
        patch = (dijkstra(graph, indices=middle) <= 4)[np.minimum(triangles, len(flat) - 1)].all(axis=1)
        patch &= (triangles < len(flat)).all(axis=1)
        below = Mesh(np.vstack(vertices), triangles[patch]).topology.boundary_loops[0]
        triangles = triangles[~patch]
        base, around = vertices[0][below], len(below)
        for step in range(1, 4 * length + 1):
            above = count + np.arange(around)
            vertices.append(base + (0.0, 0.0, 0.25 * step))
            nexts = np.roll(below, -1), np.roll(above, -1)
            triangles = np.vstack(
                [triangles, np.column_stack([below, nexts[0], above]), np.column_stack([nexts[0], nexts[1], above])]
            )
            below, count = above, count + around
        vertices.append(base.mean(axis=0, keepdims=True) + (0.0, 0.0, length + 0.3))
        tip = np.full(around, count)
        triangles = np.vstack([triangles, np.column_stack([below, np.roll(below, -1), tip])])
        count += 1
    used, renumbered = np.unique(triangles, return_inverse=True)
    return Mesh(np.vstack(vertices)[used], renumbered.reshape(-1, 3))


# ------------------------------------------------------------------------------------------- every initializer


@pytest.mark.parametrize(("id", "sample"), [(id, sample) for id, samples in SUITABLE.items() for sample in samples])
def test_starts_are_finite_upright_and_repeatable(id: str, sample: str) -> None:
    mesh, kind = make_sample(sample), sample_info(sample).kind
    assert kind in registry().initializer(id).kinds
    positions = start(id, mesh, kind)
    assert positions.shape == (mesh.vertex_count, mesh.dimension)
    assert np.isfinite(positions).all()
    assert inverted(mesh, positions) == 0
    assert np.array_equal(positions, start(id, mesh, kind))


def test_the_built_in_initializers_are_found_without_failures() -> None:
    assert {"rest", "file", "tutte", "harmonic", "lscm"} <= set(registry().initializers)
    assert not [failure for failure in registry().failures if failure.path.parent.name == "initializers"]


# ------------------------------------------------------------------------------------------- tutte


@pytest.mark.parametrize("boundary", ["circle", "square"])
@pytest.mark.parametrize("sample", ["fingers", "hilbert", "gingerbread"])
def test_tutte_is_injective_and_puts_inner_vertices_at_the_mean_of_their_neighbours(boundary: str, sample: str) -> None:
    mesh, kind = make_sample(sample), sample_info(sample).kind
    positions = start("tutte", mesh, kind, boundary=boundary)
    verdict = global_injectivity(mesh, positions)
    assert verdict.holds is True, verdict.reason
    inner = np.setdiff1d(np.arange(mesh.vertex_count), mesh.topology.boundary_vertices)
    residual = laplacian(mesh.simplices, uniform_weights(mesh), mesh.vertex_count) @ positions
    assert np.abs(residual[inner]).max() < 1e-12


def test_tutte_repairs_what_falls_below_rounding() -> None:
    mesh = disc_with_tubes(40)
    assert mesh.topology.is_disc
    assert inverted(mesh, start("tutte", mesh, "parameterize", repair=False)) > 0
    assert inverted(mesh, start("tutte", mesh, "parameterize")) == 0


@pytest.mark.parametrize("boundary", ["circle", "square"])
def test_tutte_without_inner_vertices_and_with_ears(boundary: str) -> None:
    for corners in (3, 4, 5, 24):
        angle = 2.0 * np.pi * np.arange(corners) / corners
        vertices = np.stack([np.cos(angle), np.sin(angle), 0.1 * np.cos(3.0 * angle)], axis=1)
        fan = [(0, i, i + 1) for i in range(1, corners - 1)]
        mesh = Mesh(vertices, fan)
        assert inverted(mesh, start("tutte", mesh, "parameterize", boundary=boundary)) == 0


def test_tutte_of_boundary_edges_of_no_length() -> None:
    mesh = make_sample("bumpy-disc", 600)
    vertices = mesh.vertices.copy()
    loop = mesh.topology.boundary_loops[0]
    vertices[loop[1]] = vertices[loop[0]] + 1e-13
    squeezed = Mesh(vertices, mesh.simplices)
    outline = convex_outline(squeezed, loop, "circle")
    assert np.linalg.norm(outline[1] - outline[0]) > 1e-4


def test_the_square_is_exact_where_nothing_would_be_flattened() -> None:
    mesh = make_sample("bumpy-disc", 2000)
    outline = convex_outline(mesh, mesh.topology.boundary_loops[0], "square")
    half = np.abs(outline).max()
    assert np.abs(np.abs(outline).max(axis=1) - half).max() < 1e-12
    assert (2.0 * half) ** 2 == pytest.approx(np.pi)


def test_tutte_of_a_clockwise_source_keeps_its_orientation_and_stance() -> None:
    figure = make_sample("gingerbread")
    clockwise = Mesh(figure.vertices, figure.simplices[:, ::-1])
    for mesh in (figure, clockwise):
        positions = start("tutte", mesh, "plane")
        assert inverted(mesh, positions) == 0
        top = positions[np.argmax(mesh.vertices[:, 1])] - positions.mean(axis=0)
        assert top[1] > 3.0 * abs(top[0])


def test_tutte_refuses_what_is_no_disc_and_names_the_fix() -> None:
    with pytest.raises(MeshError, match="2 boundary loops") as caught:
        start("tutte", make_sample("annulus"), "plane")
    assert caught.value.fixes == ("cut",)
    with pytest.raises(MeshError):
        start("tutte", make_sample("torus"), "parameterize")


@pytest.mark.parametrize("name", [f"{folder}/{name}" for folder, names in DISCS.items() for name in names.split()])
def test_tutte_inverts_nothing_on_discs(data_folder: Path, name: str) -> None:
    from workbench.io.opening import open_source

    path = next(path for ending in (".obj", ".off") if (path := data_folder / f"{name}{ending}").exists())
    mesh = open_source(str(path), kind="parameterize").mesh
    assert inverted(mesh, start("tutte", mesh, "parameterize")) == 0


@pytest.mark.parametrize(("name", "fix"), TO_CUT)
def test_tutte_inverts_nothing_on_surfaces_cut_to_discs(data_folder: Path, name: str, fix: str) -> None:
    from workbench.io.opening import open_source

    mesh = open_source(str(data_folder / name), kind="parameterize", fixes=(fix,)).mesh
    for boundary in ("circle", "square"):
        assert inverted(mesh, start("tutte", mesh, "parameterize", boundary=boundary)) == 0


# ------------------------------------------------------------------------------------------- harmonic


@pytest.mark.parametrize("sample", ["gingerbread", "annulus", "bar-3d", "ball"])
def test_the_harmonic_map_with_its_boundary_at_rest_is_the_identity(sample: str) -> None:
    mesh = make_sample(sample)
    positions = start("harmonic", mesh, sample_info(sample).kind)
    assert np.abs(positions - mesh.vertices).max() < 1e-11 * mesh.diameter


@pytest.mark.parametrize("sample", ["gingerbread", "ball", "bar-3d"])
def test_the_dirichlet_matrix_gives_the_energy(sample: str) -> None:
    mesh = make_sample(sample)
    elements = build_elements(mesh)
    positions = mesh.vertices + 0.1 * np.sin(3.0 * mesh.vertices[:, ::-1])
    by_values = elements.rest_measures @ (signed_singular_values(elements, positions) ** 2).sum(axis=1)
    matrix = dirichlet_matrix(mesh)
    assert np.sum(positions * (matrix @ positions)) == pytest.approx(by_values, rel=1e-10)


def test_the_harmonic_map_has_less_energy_than_tutte_on_the_same_boundary() -> None:
    mesh = make_sample("bumpy-disc", 2000)
    matrix = dirichlet_matrix(mesh)
    energies = [np.sum(x * (matrix @ x)) for x in (start(id, mesh, "parameterize") for id in ("harmonic", "tutte"))]
    assert energies[0] < energies[1]


def test_the_harmonic_map_is_repaired_where_cotangents_are_negative() -> None:
    mesh = make_sample("bumpy-disc", 2000)
    heights = np.random.default_rng(5).normal(scale=0.3, size=mesh.vertex_count)
    stretched = Mesh(np.column_stack([mesh.vertices[:, :2] * (1.0, 12.0), heights]), mesh.simplices)
    assert (cotangent_weights(stretched) < 0).any()
    assert inverted(stretched, start("harmonic", stretched, "parameterize", repair=False)) > 0
    assert inverted(stretched, start("harmonic", stretched, "parameterize")) == 0


# ------------------------------------------------------------------------------------------- lscm, rest, file


def test_lscm_of_a_flat_disc_is_a_similarity() -> None:
    flat = make_sample("gingerbread")
    tilt = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))[0][:2]
    mesh = Mesh(flat.vertices @ tilt, flat.simplices)
    positions = start("lscm", mesh, "parameterize")
    sigma = signed_singular_values(build_elements(mesh), positions)
    assert np.allclose(sigma, 1.0, atol=1e-8)


def test_lscm_is_mirrored_when_the_triangles_are_listed_the_other_way_round() -> None:
    mesh = make_sample("bumpy-disc", 2000)
    turned = Mesh(mesh.vertices, mesh.simplices[:, ::-1])
    assert inverted(turned, start("lscm", turned, "parameterize")) == 0


def test_rest_refuses_a_surface_in_space() -> None:
    with pytest.raises(WorkbenchError, match="tutte"):
        start("rest", make_sample("bumpy-disc"), "parameterize")


def test_file_reads_a_map(tmp_path: Path, square: Mesh) -> None:
    np.savez(tmp_path / "map.npz", V=square.vertices, S=square.simplices, X=2.0 * square.vertices)
    assert np.array_equal(start("file", square, "plane", str(tmp_path / "map.npz")), 2.0 * square.vertices)
    with pytest.raises(WorkbenchError, match="file"):
        start("file", square, "plane")


# ------------------------------------------------------------------------------------------- linear algebra


def test_the_definite_factor_solves_badly_scaled_systems() -> None:
    mesh = make_sample("bar", 300)
    weights = 10.0 ** np.random.default_rng(2).uniform(-20.0, 0.0, (mesh.simplex_count, 3))
    matrix = laplacian(mesh.simplices, weights, mesh.vertex_count)
    fixed = mesh.topology.boundary_vertices
    positions = solve_with_fixed(matrix, fixed, mesh.vertices[fixed])
    low, high = mesh.vertices[fixed].min(axis=0), mesh.vertices[fixed].max(axis=0)
    assert (positions >= low - 1e-12).all()  # means of neighbours: never outside the boundary
    assert (positions <= high + 1e-12).all()


def test_an_indefinite_matrix_is_refused_with_a_sentence() -> None:
    for diagonal in ([1.0, -1.0], [1.0, 0.0], [[1.0, 2.0], [2.0, 1.0]]):
        matrix = np.diag(diagonal) if np.ndim(diagonal) == 1 else np.array(diagonal)
        with pytest.raises(WorkbenchError, match="singular"):
            DefiniteFactor(coo_array(matrix))


def test_map_disc_with_indefinite_weights_is_repaired() -> None:
    mesh = make_sample("bumpy-disc", 600)
    weights = uniform_weights(mesh)
    weights[::3] = -2.0
    with pytest.raises(WorkbenchError):
        map_disc(mesh, weights, "circle", repair=False)
    assert inverted(mesh, map_disc(mesh, weights, "circle", repair=True)) == 0
