"""A tree of boxes over simplices, for questions of place: which are near a point."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from workbench.core.arrays import Floats, Integers, frozen

LEAF = 4
"""Simplices in a leaf."""
BITS = 20
"""Bits a coordinate on the curve that simplices are sorted along."""


@dataclass(frozen=True, eq=False)
class BoxTree:
    """A complete binary tree: node k has the children 2k and 2k + 1, the root is 1, the leaves are the last half.

    Parameters
    ----------
    low, high : (2 leaves, d) float64     corners of the boxes; those of empty leaves are inside out
    order : (LEAF leaves,) int64          simplices, LEAF a leaf; -1 where there are no more
    """

    low: Floats
    high: Floats
    order: Integers


def build_box_tree(vertices: Floats, simplices: Integers) -> BoxTree:
    """The tree of boxes of simplices that are sorted along a Morton curve. Cost: O(m log m).

    Parameters
    ----------
    vertices : (n, d) float64
    simplices : (m, k) int64
    """
    corners = vertices[simplices]
    low, high = corners.min(axis=1), corners.max(axis=1)
    leaves = 1 << int(np.ceil(np.log2(max(1.0, len(simplices) / LEAF))))
    order = np.full(LEAF * leaves, -1, dtype=np.int64)
    order[: len(simplices)] = np.argsort(_morton_codes(0.5 * (low + high)), kind="stable")
    is_used = (order >= 0)[:, None]
    columns = vertices.shape[1]
    node_low, node_high = np.full((2 * leaves, columns), np.inf), np.full((2 * leaves, columns), -np.inf)
    node_low[leaves:] = np.where(is_used, low[order], np.inf).reshape(leaves, LEAF, columns).min(axis=1)
    node_high[leaves:] = np.where(is_used, high[order], -np.inf).reshape(leaves, LEAF, columns).max(axis=1)
    first = leaves // 2
    while first:
        children = slice(2 * first, 4 * first)
        node_low[first : 2 * first] = node_low[children].reshape(first, 2, columns).min(axis=1)
        node_high[first : 2 * first] = node_high[children].reshape(first, 2, columns).max(axis=1)
        first //= 2
    return BoxTree(frozen(node_low), frozen(node_high), frozen(order, np.int64))


def _morton_codes(points: Floats) -> Integers:
    """Place of each point on a curve that fills their box, (n,) int64."""
    low = points.min(axis=0)
    extent = float(np.ptp(points, axis=0).max()) or 1.0
    cells = ((points - low) * ((2**BITS - 1) / extent)).astype(np.int64)
    codes = np.zeros(len(points), dtype=np.int64)
    columns = points.shape[1]
    for bit in range(BITS):
        for axis in range(columns):
            codes |= ((cells[:, axis] >> bit) & 1) << (columns * bit + axis)
    return codes
