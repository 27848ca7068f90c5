"""As-rigid-as-possible maps by rotations and linear solves in turn: the classic start."""

from __future__ import annotations

import numba
import numpy as np

from workbench.core.arrays import Floats
from workbench.core.constraints import Anchors
from workbench.core.jacobians import Elements
from workbench.core.problem import Problem
from workbench.core.singular_values import signed_svd_3x3


def rigid_map(problem: Problem, positions: Floats, rounds: int, tolerance: float = 1e-5) -> Floats:
    """`positions` (N, n) after up to `rounds` rounds: the rotation nearest to each Jacobian, then the map nearest to those.

    Each round is one solve with the Laplacian of the source, factored once. It ends early where no vertex moves by more than
    `tolerance` of the extent. Hard anchors of the problem are put to their targets at once. No step bound: simplices may
    come out inverted, and inverted ones may be mended, as the rotations are proper.

    Source: Sorkine & Alexa 2007; Liu et al. 2008, section 3.
    """
    elements, laplacian = problem.elements, problem.workspace.laplacian
    anchors: Anchors = problem.anchors
    laplacian.serve(anchors)
    current = positions.copy()
    current[anchors.hard_vertices] = anchors.hard_targets
    soft, targets, weights = anchors.soft
    for _ in range(rounds):
        rhs = _rotated(elements, current)
        rhs[soft] += 2.0 * weights[:, None] * targets
        following = laplacian.minimise(rhs, current)
        if not len(anchors.vertices):
            following += current.mean(axis=0) - following.mean(axis=0)
        moved = float(np.abs(following - current).max())
        current = following
        if moved <= tolerance * float(np.ptp(current, axis=0).max()):
            break
    return current


def _rotated(elements: Elements, positions: Floats) -> Floats:
    """K t, (N, n), for the (discontinuous) map t that rotates each simplex as `positions` does: 2 sum w R grad h."""
    n = elements.dimension
    rotations = np.empty((len(elements.simplices), n, n))
    _nearest_rotations(positions, elements.simplices, elements.inverse_rest, rotations)
    pull = 2.0 * elements.rest_measures[:, None, None] * (elements.hat_gradients @ rotations.transpose(0, 2, 1))
    rows = elements.simplices.ravel()
    columns = [np.bincount(rows, pull[:, :, axis].ravel(), elements.vertex_count) for axis in range(n)]
    return np.stack(columns, axis=1)


@numba.njit(nogil=True, cache=True, error_model="numpy")
def _nearest_rotations(x, simplices, inverse_rest, out):  # type: ignore[no-untyped-def]
    """The rotation nearest to each Jacobian: U V^T of its signed singular value decomposition."""
    n = x.shape[1]
    J, U, s, V = np.zeros((3, 3)), np.empty((3, 3)), np.empty(3), np.empty((3, 3))
    for m in range(len(simplices)):
        for i in range(n):
            for j in range(n):
                J[i, j] = 0.0
                for k in range(n):
                    J[i, j] += (x[simplices[m, k + 1], i] - x[simplices[m, 0], i]) * inverse_rest[m, k, j]
        if n == 2:
            # the similarity part of a 2 x 2 matrix, to unit length
            real, imaginary = J[0, 0] + J[1, 1], J[1, 0] - J[0, 1]
            length = np.sqrt(real * real + imaginary * imaginary)
            if length > 0.0:
                real, imaginary = real / length, imaginary / length
            else:
                real, imaginary = 1.0, 0.0
            out[m, 0, 0] = out[m, 1, 1] = real
            out[m, 1, 0], out[m, 0, 1] = imaginary, -imaginary
        else:
            signed_svd_3x3(J, U, s, V)
            for i in range(3):
                for j in range(3):
                    out[m, i, j] = U[i, 0] * V[j, 0] + U[i, 1] * V[j, 1] + U[i, 2] * V[j, 2]
