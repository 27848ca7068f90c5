"""Principal stretches of chosen simplices: how much a map stretches, along which lines of the source, onto which of the map."""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np

from workbench.core.arrays import Booleans, Floats, Integers
from workbench.core.jacobians import rest_edges
from workbench.core.mesh import Mesh
from workbench.core.simplex_kernels import frames_of, jacobian_of


@dataclass(frozen=True, eq=False)
class PrincipalStretches:
    """The singular value decompositions J = U diag(sigma) V^T of k simplices.

    `values` (k, n): sigma, descending by size, the last with the sign of det J;  `source` (k, n, 2|3): lines of the source,
    row i the unit vector that is stretched by sigma_i;  `target` (k, n, n): row i the unit vector onto which it goes
    """

    values: Floats
    source: Floats
    target: Floats

    @property
    def inverted(self) -> Booleans:
        """(k,)"""
        return np.asarray(~(self.values[:, -1] > 0))


class StretchProbe:
    """Chosen simplices of a source, made ready to be asked about many maps.

    Parameters
    ----------
    mesh : Mesh                 the source: triangles in the plane or in space, or tetrahedra
    simplices : (k,) int64      numbers of the simplices

    Degenerate ones have no stretches: their values are not finite.
    """

    def __init__(self, mesh: Mesh, simplices: Integers) -> None:
        self._corners = np.ascontiguousarray(mesh.simplices[simplices])
        part = Mesh(mesh.vertices, self._corners) if len(simplices) else mesh
        edges = rest_edges(part)[: len(simplices)]
        regular = np.abs(np.linalg.det(edges)) > 0.0
        self._inverse_rest = np.full_like(edges, np.nan)
        self._inverse_rest[regular] = np.linalg.inv(edges[regular])
        self._axes = _own_axes(mesh, self._corners)

    def at(self, positions: Floats) -> PrincipalStretches:
        """The stretches under a map (n, d) of the whole mesh. Cost: O(k), beside a compilation, once."""
        count, n = len(self._corners), self._corners.shape[1] - 1
        values, lines, images = np.empty((count, n)), np.empty((count, n, n)), np.empty((count, n, n))
        _decompose(np.ascontiguousarray(positions, dtype=np.float64), self._corners, self._inverse_rest, values, lines, images)
        return PrincipalStretches(values, lines if self._axes is None else lines @ self._axes, images)


def _own_axes(mesh: Mesh, corners: Integers) -> Floats | None:
    """The frames (k, 2, 3) of triangles in space in which their rest edges are given; None where that is the mesh's own."""
    if mesh.vertices.shape[1] == mesh.dimension:
        return None
    points = mesh.vertices[corners]
    first, second = points[:, 1] - points[:, 0], points[:, 2] - points[:, 0]
    with np.errstate(invalid="ignore", divide="ignore"):
        along = first / np.linalg.norm(first, axis=1, keepdims=True)
        across = second - np.einsum("ij,ij->i", second, along)[:, None] * along
        across /= np.linalg.norm(across, axis=1, keepdims=True)
    return np.stack([along, across], axis=1)


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _decompose(x, simplices, inverse_rest, values, lines, images):  # type: ignore[no-untyped-def]
    """Write singular values (k, n), and as rows their lines in the source and in the map (k, n, n)."""
    n = x.shape[1]
    D, J, U, V, s = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3)), np.empty(3)
    for e in range(len(simplices)):
        det = jacobian_of(x, simplices, inverse_rest, e, D, J)
        if not np.isfinite(det):
            values[e, :], lines[e, :, :], images[e, :, :] = np.nan, np.nan, np.nan
            continue
        frames_of(J, det, n, U, s, V)
        for i in range(n):
            values[e, i] = s[i]
            for j in range(n):
                lines[e, i, j], images[e, i, j] = V[j, i], U[j, i]
