"""Convex combination maps of a disc: boundary on a convex curve, inner vertices at weighted means of their neighbours.

With positive weights no triangle is inverted (Tutte 1963, Floater 2003), but only in exact arithmetic: what is thin
and long, such as a finger, shrinks exponentially in its length and falls below rounding. Then the weights are changed,
still positive, so that what has shrunk takes up more room.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import scipy

from workbench.core.arrays import Floats, Integers
from workbench.core.definite_solve import solve_with_fixed
from workbench.core.disc_boundary import BoundaryShape, convex_outline, disc_boundary
from workbench.core.errors import WorkbenchError
from workbench.core.jacobians import Elements, build_elements, signed_singular_values
from workbench.core.mesh import Mesh

COLLAPSED = 1e6
"""Mean symmetric Dirichlet density above which a start is taken as collapsed and repaired."""

_ROUNDS = 16
_SMALLEST_STRETCH = 1e-18


def laplacian(simplices: Integers, weights: Floats, vertex_count: int) -> scipy.sparse.csr_matrix:
    """Matrix of sum_ij w_ij |x_i - x_j|^2.

    Parameters
    ----------
    simplices : (m, 3) int64
    weights : (m, 3) float64     part of each triangle in the weight of the edge opposite each corner

    Returns
    -------
    (n, n) sparse, symmetric; rows sum to 0
    """
    tails, heads = simplices[:, [1, 2, 0]].ravel(), simplices[:, [2, 0, 1]].ravel()
    ones = weights.ravel()
    shape = (vertex_count, vertex_count)
    adjacency = scipy.sparse.coo_matrix((ones, (tails, heads)), shape=shape).tocsr()
    adjacency = adjacency + adjacency.T
    degrees = np.asarray(adjacency.sum(axis=1)).ravel()
    return scipy.sparse.csr_matrix(scipy.sparse.diags(degrees) - adjacency)


def uniform_weights(mesh: Mesh) -> Floats:
    """(m, 3): one for each edge, halved between its triangles."""
    return np.full((mesh.simplex_count, 3), 0.5)


def cotangent_weights(mesh: Mesh) -> Floats:
    """(m, 3): half the cotangent of each corner, negative for obtuse ones.

    Their Laplacian is the matrix of the discrete Dirichlet energy.
    """
    points = mesh.vertices[mesh.simplices]
    weights = np.empty((mesh.simplex_count, 3))
    for corner in range(3):
        first = points[:, (corner + 1) % 3] - points[:, corner]
        second = points[:, (corner + 2) % 3] - points[:, corner]
        dot = np.einsum("ij,ij->i", first, second)
        squares = np.einsum("ij,ij->i", first, first) * np.einsum("ij,ij->i", second, second)
        weights[:, corner] = 0.5 * dot / np.sqrt(np.maximum(squares - dot**2, 1e-24 * squares))
    return weights


def map_disc(mesh: Mesh, weights: Floats, shape: BoundaryShape, repair: bool) -> Floats:
    """Convex combination map of a disc.

    Parameters
    ----------
    weights : (m, 3) float64     as in `laplacian`; may be negative, but then triangles may come out inverted
    repair : bool                change the weights where triangles come out inverted, or so small that rounding decides

    Returns
    -------
    (n, 2) float64, positively oriented wherever the weights are positive

    Raises `MeshError` where the mesh is no disc.
    """
    loop = disc_boundary(mesh)
    outline = convex_outline(mesh, loop, shape)
    if not repair:
        return _solved(mesh, weights, loop, outline)
    elements = build_elements(mesh)
    best, positions = np.inf, np.zeros((mesh.vertex_count, 2))
    for trial in _attempts(mesh, weights):
        previous = np.inf
        for _ in range(_ROUNDS):
            try:
                current = _solved(mesh, trial, loop, outline)
            except WorkbenchError:  # not definite: negative weights won
                break
            value = mean_symmetric_dirichlet(elements, current)
            if value < best or not positions.any():
                best, positions = value, current
            if best < COLLAPSED:
                return positions
            without_effect = 0.95 < value / previous < 1.05  # what is left is not for the weights to mend
            if without_effect or (trial < 0).any():
                break
            previous = value
            trial = _spread(elements, current, trial)
    return positions


def _solved(mesh: Mesh, weights: Floats, loop: Integers, outline: Floats) -> Floats:
    matrix = laplacian(mesh.simplices, weights, mesh.vertex_count)
    return solve_with_fixed(matrix, loop, outline, mesh.elimination_order)


def _attempts(mesh: Mesh, weights: Floats) -> Iterator[Floats]:
    """Weights to begin with: as they are; where some are negative made positive, then uniform."""
    yield weights
    if (weights < 0).any():
        yield np.maximum(weights, 0.05 * np.median(np.abs(weights)))
        yield uniform_weights(mesh)


def mean_symmetric_dirichlet(elements: Elements, positions: Floats) -> float:
    """Area-weighted mean of (32) after scaling to the area of the source; inf where a simplex is inverted."""
    sigma = signed_singular_values(elements, positions)
    total = elements.rest_measures.sum()
    if not (sigma[:, -1] > 0).all():
        return float("inf")
    with np.errstate(over="ignore"):
        squares = sigma**2
        scale = total / (elements.rest_measures @ sigma.prod(axis=1))
        density = scale * squares.sum(axis=1) + (1.0 / (scale * squares)).sum(axis=1)
        return float(elements.rest_measures @ density / total)


def _spread(elements: Elements, positions: Floats, weights: Floats) -> Floats:
    """Weights lowered where the map shrinks: by the L2 stretch from target to source (after Yoshizawa et al. 2004)."""
    sigma = np.abs(signed_singular_values(elements, positions))
    floor = _SMALLEST_STRETCH * max(float(sigma.max()), 1e-300)
    stretch = np.sqrt(0.5 * (np.maximum(sigma, floor) ** -2.0).sum(axis=1))
    lowered = weights / stretch[:, None]
    result: Floats = lowered / lowered.max()
    return np.maximum(result, 1e-140)
