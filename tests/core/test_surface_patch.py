"""A patch reaches up to sharp edges and no further."""

from __future__ import annotations

import numpy as np
import pytest

from workbench.core.boundary_sides import boundary_edges, boundary_sides
from workbench.core.facets import facet_table
from workbench.core.samples import make_sample
from workbench.core.surface_patch import surface_patches


def test_a_solid_bar_has_six_faces() -> None:
    mesh = make_sample("bar-3d", 400)
    table = facet_table(mesh.simplices)
    triangles = table.sides[table.first[table.counts == 1]]
    labels = surface_patches(mesh.vertices, triangles)
    assert labels.max() == 5
    for label in range(6):
        patch = mesh.vertices[np.unique(triangles[labels == label])]
        assert sum(np.ptp(patch[:, axis]) == 0.0 for axis in range(3)) == 1, "all of a face lies in one plane"


@pytest.mark.parametrize(("sharp", "count"), [(1.0, 4), (50.0, 1)])
def test_what_is_sharp_can_be_said(sharp: float, count: int) -> None:
    """A strip that bends by 20 degrees three times, its first triangle without an area."""
    angles = np.radians([0.0, 0.0, 20.0, 40.0, 60.0])
    steps = np.c_[np.cos(angles), np.sin(angles)]
    profile = np.concatenate([[[0.0, 0.0]], np.cumsum(steps, axis=0)])
    points = np.concatenate([np.c_[profile, np.full(len(profile), y)] for y in (0.0, 1.0)])
    k = len(profile)
    first = np.arange(k - 1)
    triangles = np.concatenate([np.c_[first, first + 1, first + 1 + k], np.c_[first, first + 1 + k, first + k]])
    assert surface_patches(points, triangles, sharp).max() + 1 == count
    points[0] = points[1]
    labels = surface_patches(points, triangles, sharp)
    assert (labels == labels[0]).sum() == 1, "a triangle without an area stands alone"


def test_a_bar_has_four_sides_and_a_disc_has_one() -> None:
    for sample, count in (("bar", 4), ("bumpy-disc", 1)):
        mesh = make_sample(sample, 600)
        edges = boundary_edges(mesh.simplices)
        sides = boundary_sides(mesh.vertices[:, :2], edges)
        assert sides.max() + 1 == count
        assert np.bincount(edges.ravel()).max() == 2
    ends = make_sample("bar", 600)
    edges = boundary_edges(ends.simplices)
    sides = boundary_sides(ends.vertices, edges)
    lengths = [np.ptp(ends.vertices[edges[sides == side]].reshape(-1, 2), axis=0) for side in range(4)]
    assert sorted(tuple(np.round(length, 12)) for length in lengths) == [(0.0, 1.0), (0.0, 1.0), (4.0, 0.0), (4.0, 0.0)]
