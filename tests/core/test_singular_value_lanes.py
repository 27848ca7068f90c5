"""Decompositions by blocks: what the fused kernels of tetrahedra use says the same as a decomposition alone."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from workbench.core.jacobians import build_elements, determinants, jacobians
from workbench.core.mesh import Mesh
from workbench.core.singular_value_lanes import FLAT, decompose_block, load_jacobians, values_of_block
from workbench.core.tape import LANES


def hard_matrices(rng: np.random.Generator) -> np.ndarray:
    """(k, 3, 3): needles, ties, collapsed and mirrored ones, at very different scales, in every order."""
    sizes = np.array(
        [
            [1.0, 1.0, 1.0], [2.0, 2.0, 1.0], [1.0, 0.5, 0.5], [1.0, 1.0 + 1e-15, 1e-9], [1e9, 1.0, 1e-9], [1.0, 1e-8, 1e-12],
            [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 1.0, -1.0], [3.0, 0.1, -0.01], [1.0, 1e-15, -1e-15],
        ]
    )  # fmt: skip
    scales = 10.0 ** rng.choice([-80.0, -30.0, 0.0, 0.0, 30.0, 80.0], size=20 * len(sizes))
    count = len(scales)
    left, right = Rotation.random(count, rng).as_matrix(), Rotation.random(count, rng).as_matrix()
    matrices = (left * np.tile(sizes, (20, 1))[:, None]) @ right.transpose(0, 2, 1) * scales[:, None, None]
    return np.concatenate([matrices, rng.normal(size=(LANES, 3, 3)), rng.integers(-1, 2, size=(LANES, 3, 3)).astype(float)])


@pytest.mark.parametrize("seed", range(3))
def test_every_lane_is_decomposed(seed: int) -> None:
    rng = np.random.default_rng(seed)
    J = rng.permutation(hard_matrices(rng))
    tets = np.arange(4 * len(J)).reshape(-1, 4)
    rest = np.tile(np.vstack([np.zeros(3), np.eye(3)]), (len(J), 1))
    elements = build_elements(Mesh(rest, tets))
    x = (rest.reshape(-1, 4, 3) @ J.transpose(0, 2, 1)).reshape(-1, 3)
    assert np.array_equal(jacobians(elements, x), J)  # the rest frame is the identity
    det = determinants(elements, x)
    columns, turns, units, dets = np.zeros(9 * LANES), np.zeros(11 * LANES), np.empty(LANES), np.empty(LANES)
    U, s, V = np.empty((LANES, 3, 3)), np.empty((LANES, 3)), np.empty((LANES, 3, 3))
    values = np.empty((3, LANES))
    for first in range(0, len(J), LANES):
        count = min(LANES, len(J) - first)
        own = slice(first, first + count)
        load_jacobians(x, tets, elements.inverse_rest, first, count, columns, units, dets)
        assert np.array_equal(dets[:count], det[own])
        kept = columns.copy()
        decompose_block(columns, turns, units, dets, count, U, s, V)
        values_of_block(kept, turns, units, count, values)
        size = np.abs(J[own]).max(axis=(1, 2))
        size[size == 0.0] = 1.0
        rebuilt = (U[:count] * (s[:count] / size[:, None])[:, None]) @ V[:count].transpose(0, 2, 1)
        assert np.abs(rebuilt - J[own] / size[:, None, None]).max() <= 1e-13
        for turn in (U[:count], V[:count]):
            assert np.abs(turn.transpose(0, 2, 1) @ turn - np.eye(3)).max() <= 1e-14
            assert (np.linalg.det(turn) > 0.9).all()
        assert (s[:count, 0] >= s[:count, 1]).all() and (s[:count, 1] >= np.abs(s[:count, 2])).all()
        flat = np.abs(s[:count, 2]) < FLAT * s[:count, 0]
        assert flat.any() and ((s[:count, 2] >= 0) == (det[own] >= 0))[flat & (s[:count, 2] != 0)].all()
        assert np.abs(values[:, :count].T - np.abs(s[:count])).max(axis=1).max() <= 4e-15 * size.max()
        assert (np.abs(values[:, :count].T - np.abs(s[:count])) <= 4e-15 * s[:count, :1]).all()
