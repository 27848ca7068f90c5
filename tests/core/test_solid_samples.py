"""Solid samples are what their descriptions say."""

from __future__ import annotations

import numpy as np
import pytest

from workbench.core.injectivity import global_injectivity
from workbench.core.mesh import Mesh
from workbench.core.samples import make_sample, sample_info
from workbench.core.samples.solids import blob_distance

SOLIDS = ("bar-3d", "ball", "beam-3d", "gingerbread-3d", "blob-3d")


def dihedral_angles(mesh: Mesh) -> np.ndarray:
    """The six dihedral angles of each tetrahedron in degrees."""
    angles = []
    for i, j, k, m in ((0, 1, 2, 3), (0, 2, 1, 3), (0, 3, 1, 2), (1, 2, 0, 3), (1, 3, 0, 2), (2, 3, 0, 1)):
        a, b, c, d = (mesh.vertices[mesh.simplices[:, corner]] for corner in (i, j, k, m))
        u, v = np.cross(b - a, c - a), np.cross(b - a, d - a)
        cosine = np.einsum("ij,ij->i", u, v) / np.linalg.norm(u, axis=1) / np.linalg.norm(v, axis=1)
        angles.append(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))
    return np.array(angles)


@pytest.mark.parametrize(
    ("id", "volume"),
    [("beam-3d", (4.0 - np.pi * 0.28**2) * 0.6), ("blob-3d", None)],
)
def test_solids_fill_their_shape(id: str, volume: float | None) -> None:
    mesh = make_sample(id)
    corners = mesh.vertices[mesh.simplices]
    volumes = np.linalg.det(corners[:, 1:] - corners[:, :1]) / 6.0
    assert volumes.min() > 0
    if volume is None:  # that of the closed surface
        surface = make_sample("blob")
        volume = float(np.linalg.det(surface.vertices[surface.simplices]).sum() / 6.0)
    assert volumes.sum() == pytest.approx(volume, rel=0.02)


@pytest.mark.parametrize("id", SOLIDS)
def test_solids_are_embedded_and_no_slivers(id: str) -> None:
    mesh = make_sample(id)
    verdict = global_injectivity(mesh, mesh.vertices)
    assert verdict.holds is True, verdict.reason
    angles = dihedral_angles(mesh)
    assert angles.min() > 10.0
    assert angles.max() < 160.0
    anchors = list(sample_info(id).anchors)
    assert len(anchors) >= 2
    assert np.isin(anchors, mesh.topology.boundary_vertices).all()


@pytest.mark.parametrize(("id", "holes"), [("gingerbread-3d", 0), ("blob-3d", 0), ("beam-3d", 1)])
@pytest.mark.parametrize("tetrahedra", [900, 20_000])
def test_solids_come_at_other_resolutions(id: str, holes: int, tetrahedra: int) -> None:
    mesh = make_sample(id, tetrahedra)
    assert 0.75 * tetrahedra < mesh.simplex_count < 1.25 * tetrahedra
    topology = mesh.topology
    assert topology.is_manifold and topology.component_count == 1
    assert not len(topology.negative) and not len(topology.degenerate)
    assert topology.euler_characteristic == 1 - holes
    assert dihedral_angles(mesh).min() > 8.0


def test_stuffing_follows_the_level_set() -> None:
    mesh = make_sample("blob-3d")
    boundary = mesh.topology.boundary_vertices
    assert np.abs(blob_distance(mesh.vertices[boundary])).max() < 1e-6
    inner = np.setdiff1d(np.arange(mesh.vertex_count), boundary)
    assert (blob_distance(mesh.vertices[inner]) < 0.0).all()
