"""Every sample is what its description says."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from workbench.core.carried_surface import carry
from workbench.core.errors import WorkbenchError
from workbench.core.injectivity import global_injectivity
from workbench.core.mesh import Mesh
from workbench.core.samples import make_sample, sample_ids, sample_info
from workbench.core.samples.__main__ import main, object_text, stored_ids
from workbench.core.samples.catalogue import _made
from workbench.core.samples.subdivision import subdivide

FLAT = ("gingerbread", "bar", "annulus")
DISCS = ("gingerbread", "bar", "bumpy-disc", "fingers", "hilbert")
SOLIDS = ("bar-3d", "ball")


def smallest_angles(mesh: Mesh) -> np.ndarray:
    """Smallest angle of each triangle in degrees."""
    points = mesh.vertices[mesh.simplices]
    angles = []
    for i in range(3):
        a, b = points[:, (i + 1) % 3] - points[:, i], points[:, (i + 2) % 3] - points[:, i]
        cosine = np.einsum("ij,ij->i", a, b) / np.linalg.norm(a, axis=1) / np.linalg.norm(b, axis=1)
        angles.append(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
    return np.min(angles, axis=0)


@pytest.mark.parametrize("id", sample_ids())
def test_every_sample_is_a_clean_manifold(id: str) -> None:
    mesh, info = make_sample(id), sample_info(id)
    topology = mesh.topology
    assert mesh.dimension == (3 if info.kind == "volume" else 2)
    assert mesh.vertices.shape[1] == (2 if info.kind == "plane" else 3)
    assert topology.component_count == 1
    assert topology.is_manifold
    assert topology.is_consistently_oriented
    for offenders in (topology.degenerate, topology.repeated, topology.negative, topology.unreferenced):
        assert len(offenders) == 0
    assert 0.75 * info.simplex_count < mesh.simplex_count < 1.25 * info.simplex_count
    assert info.label
    assert info.description
    assert all(0 <= vertex < mesh.vertex_count for vertex in info.anchors)
    assert len(set(info.anchors)) == len(info.anchors)


@pytest.mark.parametrize("id", DISCS)
def test_discs_are_discs(id: str) -> None:
    assert make_sample(id).topology.is_disc


def test_the_others_have_their_topology() -> None:
    assert len(make_sample("annulus").topology.boundary_loops) == 2
    for id, genus in (("blob", 0), ("torus", 1), ("salamander", 0)):
        topology = make_sample(id).topology
        assert topology.genus == genus
        assert not len(topology.boundary_vertices)
        assert sample_info(id).fixes == ("cut",)


@pytest.mark.parametrize("id", FLAT)
def test_flat_samples_are_embedded_counter_clockwise(id: str) -> None:
    mesh = make_sample(id)
    verdict = global_injectivity(mesh, mesh.vertices)
    assert verdict.holds is True, verdict.reason


@pytest.mark.parametrize(("id", "degrees"), [("gingerbread", 25), ("bar", 25), ("annulus", 50), ("blob", 40), ("torus", 40)])
def test_triangles_are_well_shaped(id: str, degrees: float) -> None:
    assert smallest_angles(make_sample(id)).min() > degrees


@pytest.mark.parametrize("id", ["bumpy-disc", "fingers", "hilbert", "salamander"])
def test_triangles_of_bent_surfaces_are_not_slivers(id: str) -> None:
    assert smallest_angles(make_sample(id)).min() > 12


@pytest.mark.parametrize("triangles", range(1200, 2400, 50))
def test_coarse_fingers_have_no_slivers(triangles: int) -> None:
    """As soon as the grid resolves the fingers; with fewer triangles the sample is refused."""
    assert smallest_angles(make_sample("fingers", triangles)).min() > 7


@pytest.mark.parametrize(("id", "volume"), [("bar-3d", 4.0), ("ball", 4.0 / 3.0 * np.pi)])
def test_solids_fill_their_shape(id: str, volume: float) -> None:
    mesh = make_sample(id)
    corners = mesh.vertices[mesh.simplices]
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6.0
    assert volumes.min() > 0
    assert volumes.sum() == pytest.approx(volume, rel=0.02)


def test_the_salamander_lies_in_the_solid_bar_whose_maps_carry_it() -> None:
    surface, bar = make_sample("salamander"), make_sample("bar-3d")
    carried = carry(surface, bar)
    assert carried.outside_count == 0
    np.testing.assert_allclose(carried.at(bar.vertices), surface.vertices, atol=1e-14)
    assert np.abs(surface.vertices[:, 1].mean() - 0.5) < 1e-12, "its halves are mirror images"
    corners = surface.vertices[surface.simplices]
    assert np.linalg.det(corners).sum() > 0, "its triangles look outwards"


@pytest.mark.parametrize(("id", "triangles"), [("bumpy-disc", 100_000), ("gingerbread", 20_000), ("fingers", 12_000)])
def test_samples_come_at_other_resolutions(id: str, triangles: int) -> None:
    mesh = make_sample(id, triangles)
    assert 0.9 * triangles < mesh.simplex_count < 1.1 * triangles
    assert mesh.topology.is_disc


def test_the_same_call_gives_the_same_mesh() -> None:
    for id in sample_ids():
        first = make_sample(id)
        _made.cache_clear()
        again = make_sample(id)
        assert again is not first
        assert np.array_equal(first.vertices, again.vertices)
        assert np.array_equal(first.simplices, again.simplices)


def test_the_anchors_of_the_figure_are_in_its_limbs() -> None:
    mesh, info = make_sample("gingerbread"), sample_info("gingerbread")
    places = mesh.vertices[list(info.anchors)]
    assert len(places) == 5
    assert np.ptp(places, axis=0).min() > 0.7 * np.ptp(mesh.vertices, axis=0).min()
    finer = sample_info("gingerbread", 8000)
    assert np.abs(make_sample("gingerbread", 8000).vertices[list(finer.anchors)] - places).max() < 0.05


def test_what_cannot_be_made_is_refused_with_a_sentence() -> None:
    with pytest.raises(WorkbenchError, match="gingerbread"):
        make_sample("gingerbred")
    with pytest.raises(WorkbenchError, match="cannot be made"):
        make_sample("bar", 3)
    with pytest.raises(WorkbenchError, match="1200"):
        make_sample("fingers", 300)


def test_stored_files_are_what_the_generator_makes(project_root: Path) -> None:
    stored = {path.stem for path in (project_root / "assets" / "meshes").glob("*.obj")}
    assert stored == set(stored_ids())
    for id in stored:
        mesh = make_sample(id)
        lines = (project_root / "assets" / "meshes" / f"{id}.obj").read_text(encoding="ascii").splitlines()
        vertices = np.array([line.split()[1:] for line in lines if line.startswith("v ")], dtype=np.float64)
        faces = np.array([line.split()[1:] for line in lines if line.startswith("f ")], dtype=np.int64)
        # the last digits of sines and roots differ between machines
        assert np.abs(vertices[:, : mesh.vertices.shape[1]] - mesh.vertices).max() < 1e-9
        assert np.array_equal(faces - 1, mesh.simplices)


def test_the_generator_writes_its_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([str(tmp_path)]) == 0
    assert {path.stem for path in tmp_path.iterdir()} == set(stored_ids())
    assert (tmp_path / "bar.obj").read_text(encoding="ascii") == object_text(make_sample("bar"))
    assert len(capsys.readouterr().out.splitlines()) == len(stored_ids())
    assert main([]) == 2


@pytest.mark.parametrize("parts", [1, 2, 3, 5])
def test_subdivision_keeps_shape_orientation_and_neighbours(parts: int) -> None:
    vertices = np.vstack([np.zeros(3), np.eye(3), np.ones(3)])
    simplices = np.array([(0, 1, 2, 3), (1, 3, 2, 4)])
    before = np.linalg.det(vertices[simplices[:, 1:]] - vertices[simplices[:, :1]])
    finer, parts_of = subdivide(vertices, simplices, parts)
    assert len(parts_of) == 2 * parts**3
    after = np.linalg.det(finer[parts_of[:, 1:]] - finer[parts_of[:, :1]]).reshape(2, -1)
    assert np.allclose(after, before[:, None] / parts**3)
    topology = Mesh(finer, parts_of).topology
    assert topology.component_count == 1
    assert len(topology.boundary_facets) == 6 * parts**2
