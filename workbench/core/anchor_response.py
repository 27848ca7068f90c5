"""How the map follows its anchors: kept for a few shapes of displacement, whatever the number of anchors.

A rigid or affine motion of a group is made of as many shapes as there are dimensions, and one: so that an end face of a
thousand anchors costs no more than four single ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from workbench.core.arrays import Floats, Integers

SINGLE = 4
"""Anchors that may move at once with a shape for each."""
MOST = 12
"""Shapes that are kept at most; each costs a solve for every coordinate."""
LEFT_OVER = 1e-6
"""Part of a displacement that shapes may miss and still be said to hold it."""


@dataclass(frozen=True, eq=False)
class AnchorResponse:
    """Displacements of all vertices for unit displacements of the hard anchors.

    `shapes` : (k, r) float64      orthonormal columns over the k hard anchors
    `matrix` : (r d, N d) float64  the answer of the map to each shape in each coordinate, see `NewtonSystem.response`
    """

    shapes: Floats
    matrix: Floats

    def parts(self, displacement: Floats) -> Floats | None:
        """(r, d) how much of each shape a displacement of the anchors (k, d) holds; None where it holds anything else."""
        if len(displacement) != len(self.shapes):
            return None
        parts: Floats = self.shapes.T @ displacement
        missed = np.abs(displacement - self.shapes @ parts).max(initial=0.0)
        return parts if missed <= LEFT_OVER * np.abs(displacement).max(initial=0.0) else None

    def to(self, displacement: Floats) -> Floats | None:
        """(N, d) displacement of the map for one of the anchors (k, d); None where the shapes do not hold it."""
        parts = self.parts(displacement)
        return None if parts is None else (parts.reshape(-1) @ self.matrix).reshape(-1, displacement.shape[1])


def displacement_shapes(displacement: Floats, places: Floats, moved: Integers, groups: Sequence[Integers]) -> Floats:
    """Shapes that hold this displacement of the anchors, and those that are likely to follow it.

    Parameters
    ----------
    displacement, places : (k, d) float64     of the anchors, and where they are now
    moved : (j,) int64                        rows that are displaced at all
    groups : sequence of (g,) int64           rows that move together

    Returns
    -------
    (k, r) float64      orthonormal columns, r <= `MOST`; a unit for each of a few anchors, affine functions of the place for
    each group that moves, and what those leave over
    """
    if len(moved) <= SINGLE:
        shapes = np.zeros((len(displacement), len(moved)))
        shapes[moved, np.arange(len(moved))] = 1.0
        return shapes
    is_moved = np.zeros(len(displacement), dtype=bool)
    is_moved[moved] = True
    columns = []
    for rows in groups:
        going = rows[is_moved[rows]]
        if len(going):
            columns += _affine(places, rows if len(going) > len(rows) // 2 else going)
    shapes = _orthonormal(np.stack(columns, axis=1)) if len(columns) <= MOST else np.zeros((len(displacement), 0))
    left = displacement - shapes @ (shapes.T @ displacement)
    if np.abs(left).max() > LEFT_OVER * np.abs(displacement).max():
        shapes = _orthonormal(np.concatenate([left, shapes], axis=1))
    return shapes


def _affine(places: Floats, rows: Integers) -> list[Floats]:
    """One and each coordinate as functions on all anchors that vanish off `rows`, each (k,)."""
    body = places[rows] - places[rows].mean(axis=0)
    functions = []
    for values in (np.ones(len(rows)), *body.T):
        function = np.zeros(len(places))
        function[rows] = values
        functions.append(function)
    return functions


def _orthonormal(columns: Floats) -> Floats:
    """(k, r) an orthonormal basis of the space of `columns` (k, c), directions that hardly count left out."""
    lengths = np.linalg.norm(columns, axis=0)
    largest = lengths.max(initial=0.0)
    if not largest > 0.0:
        return columns[:, :0]
    u, s, _ = np.linalg.svd(columns[:, lengths > 1e-12 * largest] / lengths[lengths > 1e-12 * largest], full_matrices=False)
    result: Floats = u[:, s > 1e-7]
    return result
