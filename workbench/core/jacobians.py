"""Reference frames of the source, Jacobians of a map and their signed singular values."""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np

from workbench.core.arrays import Floats, Integers, frozen
from workbench.core.errors import MeshError
from workbench.core.mesh import Mesh
from workbench.core.singular_value_lanes import load_jacobians, values_of_block
from workbench.core.singular_values import determinant_3x3, signed_svd_2x2
from workbench.core.tape import LANES
from workbench.core.tetrahedron_edges import target_edges_3d


@dataclass(frozen=True, eq=False)
class Elements:
    """What every energy on a source needs, once a mesh.

    Parameters
    ----------
    simplices : (m, n+1) int64
    inverse_rest : (m, n, n) float64    inverse of the matrix of rest edges (columns x_j - x_0) in the simplex's own frame
    rest_measures : (m,) float64        areas or volumes, positive
    vertex_count : int
    """

    simplices: Integers
    inverse_rest: Floats
    rest_measures: Floats
    vertex_count: int

    @property
    def dimension(self) -> int:
        return int(self.simplices.shape[1]) - 1

    @property
    def hat_gradients(self) -> Floats:
        """(m, n+1, n) gradients of the hat functions, so that J = sum_j x_j (grad h_j)^T (52)."""
        first = -self.inverse_rest.sum(axis=1, keepdims=True)
        return np.concatenate([first, self.inverse_rest], axis=1)


def rest_edges(mesh: Mesh) -> Floats:
    """Edges of each simplex from its first vertex, in an orthonormal frame of its own (46).

    Returns
    -------
    (m, n, n) float64     columns are x_1 - x_0, ..., x_n - x_0; triangles in space get a positive orientation
    """
    points = mesh.vertices[mesh.simplices]
    edges = np.swapaxes(points[:, 1:] - points[:, :1], 1, 2)
    if mesh.dimension == mesh.vertices.shape[1]:
        return np.ascontiguousarray(edges)
    first, second = edges[:, :, 0], edges[:, :, 1]
    length = np.linalg.norm(first, axis=1)
    divisor = np.where(length > 0.0, length, 1.0)  # of a triangle without a first edge nothing is left but zeros
    along = np.einsum("ij,ij->i", first, second) / divisor
    across = np.linalg.norm(np.cross(first, second), axis=1) / divisor
    flat = np.zeros((mesh.simplex_count, 2, 2))
    flat[:, 0, 0], flat[:, 0, 1], flat[:, 1, 1] = length, along, across
    return flat


def simplex_measures(mesh: Mesh) -> Floats:
    """Areas or volumes (m,) of the simplices, 0 where they are degenerate."""
    return np.abs(np.linalg.det(rest_edges(mesh))) / (2.0 if mesh.dimension == 2 else 6.0)


def build_elements(mesh: Mesh) -> Elements:
    """Frames and measures of a source. Raises `MeshError` naming the first degenerate simplex."""
    edges = rest_edges(mesh)
    n = mesh.dimension
    det = np.linalg.det(edges) if n == 3 else edges[:, 0, 0] * edges[:, 1, 1] - edges[:, 0, 1] * edges[:, 1, 0]
    bad = ~(np.abs(det) > 0.0) | ~np.isfinite(det)
    if bad.any():
        k = int(np.flatnonzero(bad)[0])
        noun = "triangle" if n == 2 else "tetrahedron"
        raise MeshError(
            f"{int(bad.sum())} simplices of the source are degenerate (no area or volume), the first is {noun} {k} (from 0) "
            f"with vertices {mesh.simplices[k].tolist()}; remove or repair them in the file."
        )
    with np.errstate(over="ignore", invalid="ignore"):
        inverse = np.linalg.inv(edges)
    if not np.isfinite(inverse).all():
        k = int(np.flatnonzero(~np.isfinite(inverse).all(axis=(1, 2)))[0])
        raise MeshError(f"Simplex {k} (from 0) is so small that its frame overflows; scale the mesh.")
    factor = 2.0 if n == 2 else 6.0
    return Elements(mesh.simplices, frozen(inverse), frozen(np.abs(det) / factor), mesh.vertex_count)


def jacobians(elements: Elements, positions: Floats) -> Floats:
    """(n_vertices, n) positions -> (m, n, n) Jacobians of the simplices (52)."""
    points = np.asarray(positions)[elements.simplices]
    edges = np.swapaxes(points[:, 1:] - points[:, :1], 1, 2)
    result: Floats = edges @ elements.inverse_rest
    return result


def signed_singular_values(elements: Elements, positions: Floats) -> Floats:
    """(n_vertices, n) positions -> (m, n), descending, the last with the sign of det J."""
    out = np.empty((len(elements.simplices), elements.dimension))
    kernel = _singular_values_2d if elements.dimension == 2 else _singular_values_3d
    kernel(np.ascontiguousarray(positions, dtype=np.float64), elements.simplices, elements.inverse_rest, out)
    return out


def determinants(elements: Elements, positions: Floats) -> Floats:
    """(n_vertices, n) positions -> (m,) det J, from the edges of the target: its sign is the orientation as drawn."""
    out = np.empty(len(elements.simplices))
    kernel = _determinants_2d if elements.dimension == 2 else _determinants_3d
    kernel(np.ascontiguousarray(positions, dtype=np.float64), elements.simplices, elements.inverse_rest, out)
    return out


@numba.njit(nogil=True, cache=True, error_model="numpy", inline="always")
def jacobian_2d(x, simplices, inverse_rest, e):  # type: ignore[no-untyped-def]
    """Rows (a, b) and (c, d) of the Jacobian of triangle e, and its determinant from the edges of the target."""
    i, j, k = simplices[e, 0], simplices[e, 1], simplices[e, 2]
    p0, p1 = x[j, 0] - x[i, 0], x[j, 1] - x[i, 1]
    q0, q1 = x[k, 0] - x[i, 0], x[k, 1] - x[i, 1]
    m00, m01 = inverse_rest[e, 0, 0], inverse_rest[e, 0, 1]
    m10, m11 = inverse_rest[e, 1, 0], inverse_rest[e, 1, 1]
    det = (p0 * q1 - p1 * q0) * (m00 * m11 - m01 * m10)
    a, b = p0 * m00 + q0 * m10, p0 * m01 + q0 * m11
    c, d = p1 * m00 + q1 * m10, p1 * m01 + q1 * m11
    return a, b, c, d, det


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _singular_values_2d(x, simplices, inverse_rest, out):  # type: ignore[no-untyped-def]
    for e in range(simplices.shape[0]):
        a, b, c, d, det = jacobian_2d(x, simplices, inverse_rest, e)
        s1, s2, _, _, _, _ = signed_svd_2x2(a, b, c, d, det)
        out[e, 0], out[e, 1] = s1, s2


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _determinants_2d(x, simplices, inverse_rest, out):  # type: ignore[no-untyped-def]
    for e in range(simplices.shape[0]):
        i, j, k = simplices[e, 0], simplices[e, 1], simplices[e, 2]
        area = (x[j, 0] - x[i, 0]) * (x[k, 1] - x[i, 1]) - (x[j, 1] - x[i, 1]) * (x[k, 0] - x[i, 0])
        out[e] = area * (inverse_rest[e, 0, 0] * inverse_rest[e, 1, 1] - inverse_rest[e, 0, 1] * inverse_rest[e, 1, 0])


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _determinants_3d(x, simplices, inverse_rest, out):  # type: ignore[no-untyped-def]
    D = np.empty((3, 3))
    for e in range(simplices.shape[0]):
        out[e] = target_edges_3d(x, simplices, e, D) * determinant_3x3(inverse_rest[e])


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _singular_values_3d(x, simplices, inverse_rest, out):  # type: ignore[no-untyped-def]
    columns, turns = np.zeros(9 * LANES), np.zeros(11 * LANES)
    units, dets, values = np.empty(LANES), np.empty(LANES), np.empty((3, LANES))
    for block in range(0, simplices.shape[0], LANES):
        count = min(LANES, simplices.shape[0] - block)
        load_jacobians(x, simplices, inverse_rest, block, count, columns, units, dets)
        values_of_block(columns, turns, units, count, values)
        for lane in range(count):
            out[block + lane, 0], out[block + lane, 1] = values[0, lane], values[1, lane]
            # One sign everywhere: that of the determinant as the line search sees it.
            out[block + lane, 2] = values[2, lane] if dets[lane] > 0.0 else -values[2, lane]
