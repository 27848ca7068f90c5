"""Quadratic energies of maps, and frames: the pieces of linear initializers beside convex combination maps."""

from __future__ import annotations

import numpy as np
import scipy

from workbench.core.arrays import Floats, Integers
from workbench.core.convex_map import cotangent_weights, laplacian
from workbench.core.definite_solve import solve_with_fixed
from workbench.core.jacobians import build_elements
from workbench.core.mesh import Mesh


def signed_areas(positions: Floats, simplices: Integers) -> Floats:
    """(m,) signed areas of triangles in the plane."""
    corners = positions[simplices]
    first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    areas: Floats = 0.5 * (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
    return areas


def dirichlet_matrix(mesh: Mesh) -> scipy.sparse.csr_matrix:
    """(n, n) matrix of the Dirichlet energy (25) of one coordinate, weighted with rest areas or volumes."""
    if mesh.dimension == 2:
        return laplacian(mesh.simplices, cotangent_weights(mesh), mesh.vertex_count)
    elements = build_elements(mesh)
    hats = elements.hat_gradients
    blocks = np.einsum("m,mia,mja->mij", elements.rest_measures, hats, hats)
    width = mesh.simplices.shape[1]
    rows = np.repeat(mesh.simplices, width, axis=1).ravel()
    columns = np.tile(mesh.simplices, (1, width)).ravel()
    shape = (mesh.vertex_count, mesh.vertex_count)
    return scipy.sparse.coo_matrix((blocks.ravel(), (rows, columns)), shape=shape).tocsr()


def harmonic_extension(mesh: Mesh, fixed: Integers) -> Floats:
    """Minimiser (n, d) of the Dirichlet energy with the vertices `fixed` (k,) where they are in the source."""
    return solve_with_fixed(dirichlet_matrix(mesh), fixed, mesh.vertices[fixed], mesh.elimination_order)


def conformal_energy(mesh: Mesh) -> scipy.sparse.csr_matrix:
    """Matrix of the conformal energy of a map of a surface to the plane: Dirichlet energy less twice the area.

    Returns
    -------
    (2 n, 2 n) sparse, symmetric, positive semi-definite; rows 2 v and 2 v + 1 are the coordinates of vertex v

    Source: Levy et al. 2002, in the form of Mullen et al. 2008.
    """
    dirichlet = scipy.sparse.coo_matrix(dirichlet_matrix(mesh))
    size = 2 * mesh.vertex_count
    edges = mesh.topology.boundary_facets
    tails, heads = 2 * edges[:, 0], 2 * edges[:, 1]
    half = np.full(len(edges), 0.5)
    # twice the area is the sum of x_tail y_head - y_tail x_head over the boundary edges
    rows = np.concatenate([2 * dirichlet.row, 2 * dirichlet.row + 1, tails, heads + 1, tails + 1, heads])
    columns = np.concatenate([2 * dirichlet.col, 2 * dirichlet.col + 1, heads + 1, tails, heads, tails + 1])
    values = np.concatenate([dirichlet.data, dirichlet.data, -half, -half, half, half])
    return scipy.sparse.coo_matrix((values, (rows, columns)), shape=(size, size)).tocsr()


def upright(mesh: Mesh) -> Mesh:
    """A mesh in the plane with every triangle counter-clockwise; a surface in space as it is."""
    if mesh.vertices.shape[1] == 3:
        return mesh
    clockwise = signed_areas(mesh.vertices, mesh.simplices) < 0
    if not clockwise.any():
        return mesh
    return Mesh(mesh.vertices, np.where(clockwise[:, None], mesh.simplices[:, ::-1], mesh.simplices), mesh.name)


def match_source_frame(mesh: Mesh, positions: Floats) -> Floats:
    """`positions` (n, 2) turned to lie best on a source in the plane; as they are for a surface in space."""
    if mesh.vertices.shape[1] == 3:
        return positions
    rest = mesh.vertices - mesh.vertices.mean(axis=0)
    centre = positions.mean(axis=0)
    z = np.vdot((positions - centre) @ [1.0, 1j], rest @ [1.0, 1j])
    if abs(z) == 0.0:
        return positions
    z /= abs(z)
    turn = np.array([[z.real, z.imag], [-z.imag, z.real]])
    turned: Floats = positions @ turn
    return turned
