"""The sides of a plane figure: stretches of its boundary between sharp corners."""

from __future__ import annotations

import numpy as np
import scipy

from workbench.core.arrays import Floats, Integers
from workbench.core.facets import facet_table
from workbench.core.surface_patch import SHARP


def boundary_edges(triangles: Integers) -> Integers:
    """Edges (b, 2) that belong to one triangle (m, 3) only, each in the sense of its triangle."""
    table = facet_table(triangles)
    return table.sides[table.first[table.counts == 1]]


def boundary_sides(positions: Floats, edges: Integers, sharp: float = SHARP) -> Integers:
    """Label (b,) of the side that each boundary edge belongs to.

    Parameters
    ----------
    positions : (n, 2) float64
    edges : (b, 2) int64      see `boundary_edges`
    sharp : float             degrees of a corner between two edges from which on it ends a side

    A vertex at which the boundary meets itself ends sides, too.
    """
    steps = positions[edges[:, 1]] - positions[edges[:, 0]]
    with np.errstate(invalid="ignore", divide="ignore"):
        steps = steps / np.linalg.norm(steps, axis=1, keepdims=True)
    count = len(positions)
    starts, ends = np.bincount(edges[:, 0], minlength=count), np.bincount(edges[:, 1], minlength=count)
    leaving = np.full(count, -1, dtype=np.int64)
    leaving[edges[:, 0]] = np.arange(len(edges))
    following = leaving[edges[:, 1]]
    is_plain = (starts[edges[:, 1]] == 1) & (ends[edges[:, 1]] == 1)
    cosines = np.einsum("ij,ij->i", steps, steps[following])
    joined = np.flatnonzero(is_plain & (cosines > np.cos(np.radians(sharp))))
    links = scipy.sparse.coo_array((np.ones(len(joined)), (joined, following[joined])), shape=(len(edges), len(edges)))
    labels: Integers = scipy.sparse.csgraph.connected_components(links, directed=False)[1].astype(np.int64)
    return labels
