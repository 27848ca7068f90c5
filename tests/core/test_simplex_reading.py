"""What is read of one simplex is what a table of all of them says."""

from __future__ import annotations

import numpy as np
import pytest

from workbench.core.measure import Measure
from workbench.core.mesh import Mesh, TextureCoordinates
from workbench.core.quality import simplex_table
from workbench.core.registry import registry
from workbench.core.samples import make_sample
from workbench.core.seams import seam_edges
from workbench.core.simplex_reading import read_simplex


@pytest.mark.parametrize("id", ["bumpy-disc", "gingerbread", "bar-3d"])
def test_a_reading_is_a_row_of_the_table(id: str) -> None:
    mesh = make_sample(id)
    random = np.random.default_rng(3)
    n = mesh.dimension
    positions = mesh.vertices[:, :n] + random.normal(0, 0.02 if n == 2 else 0.1, (mesh.vertex_count, n))
    table = simplex_table(mesh, positions)
    ids = sorted(registry().distortions)
    measures = {id: Measure(id).prepare(n) for id in ids}
    inverted = np.flatnonzero(table["inverted"])
    rows = [*random.integers(0, mesh.simplex_count, 12).tolist(), *inverted[:3].tolist()]
    assert len(inverted), "a test of signs needs inverted simplices"
    for row in rows:
        reading = read_simplex(mesh, positions, row, measures)
        assert reading.vertices == tuple(mesh.simplices[row])
        for i, value in enumerate(reading.sigma):
            assert value == pytest.approx(table[f"sigma_{i + 1}"][row], rel=1e-9, abs=1e-12)
        assert reading.det == pytest.approx(table["det"][row], rel=1e-9, abs=1e-12)
        assert reading.rest_measure == pytest.approx(table["area" if n == 2 else "source_volume"][row], rel=1e-12)
        assert reading.measure == pytest.approx(reading.det * reading.rest_measure, rel=1e-12)
        for id in ids:
            assert reading.values[id] == pytest.approx(table[id][row], rel=1e-7), id


def test_seams_are_edges_between_triangles_whose_texture_jumps() -> None:
    simplices = np.array([[0, 1, 2], [2, 1, 3]])
    vertices = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    mesh = Mesh(vertices, simplices)
    whole = TextureCoordinates(vertices, simplices)
    assert not len(seam_edges(whole, mesh.simplices))
    parted = TextureCoordinates(np.vstack([vertices, vertices + 5.0]), np.array([[0, 1, 2], [6, 5, 7]]))
    assert {frozenset(edge) for edge in seam_edges(parted, mesh.simplices).tolist()} == {frozenset({1, 2})}
