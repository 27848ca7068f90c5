"""Shortest paths along edges: laws that any shortest path keeps."""

from __future__ import annotations

import numpy as np
import pytest

from workbench.core.edge_graph import EdgeGraph
from workbench.core.mesh import Mesh
from workbench.core.samples import make_sample


@pytest.fixture(params=["gingerbread", "bumpy-disc", "bar-3d"])
def mesh(request: pytest.FixtureRequest) -> Mesh:
    return make_sample(request.param, 400)


def test_every_edge_stands_once_with_its_length(mesh: Mesh) -> None:
    graph = EdgeGraph(mesh.vertices, mesh.simplices)
    corners = mesh.simplices.shape[1]
    expected = {tuple(sorted((s[i], s[j]))) for s in mesh.simplices.tolist() for i in range(corners) for j in range(i)}
    assert sorted(map(tuple, graph.edges.tolist())) == sorted(expected)
    a, b = graph.edges.T
    np.testing.assert_allclose(graph.lengths, np.sqrt(((mesh.vertices[a] - mesh.vertices[b]) ** 2).sum(axis=1)))


def test_no_edge_shortens_a_distance_and_paths_are_as_long_as_they_say(mesh: Mesh) -> None:
    graph = EdgeGraph(mesh.vertices, mesh.simplices)
    starts = np.array([3, 40, 77])
    away = graph.distances(starts)
    assert (away[starts] == 0.0).all() and (np.delete(away, starts) > 0.0).all()
    a, b = graph.edges.T
    assert (np.abs(away[a] - away[b]) <= graph.lengths * (1 + 1e-12)).all()
    straight = np.linalg.norm(mesh.vertices[:, None] - mesh.vertices[starts], axis=2).min(axis=1)
    assert (away >= straight * (1 - 1e-12)).all()
    nearest = graph.nearest(starts)
    assert set(nearest) <= set(starts.tolist())
    edges = set(map(tuple, graph.edges.tolist()))
    for start in starts.tolist():
        tree, distances = graph.paths_from(start), graph.distances(np.array([start]))
        assert (distances[nearest == start] <= away[nearest == start] * (1 + 1e-12)).all()
        for end in range(0, mesh.vertex_count, 29):
            path = tree.to(end)
            assert (path[0], path[-1]) == (start, end)
            assert all((min(pair), max(pair)) in edges for pair in zip(path[:-1].tolist(), path[1:].tolist(), strict=True))
            steps = np.linalg.norm(np.diff(mesh.vertices[path], axis=0), axis=1)
            assert steps.sum() == pytest.approx(distances[end])


def test_nothing_leads_to_another_component() -> None:
    vertices = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [5.0, 5.0], [6.0, 5.0], [5.0, 6.0]])
    graph = EdgeGraph(vertices, np.array([[0, 1, 2], [3, 4, 5]]))
    assert np.isinf(graph.distances(np.array([0]))[3:]).all()
    assert graph.nearest(np.array([0])).tolist() == [0, 0, 0, -1, -1, -1]
    assert not len(graph.paths_from(0).to(4)) and graph.paths_from(0).to(0).tolist() == [0]
