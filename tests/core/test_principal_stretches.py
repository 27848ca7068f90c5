"""Principal stretches of chosen simplices against their definition: J v_i = sigma_i u_i, and the singular values of NumPy."""

from __future__ import annotations

import numpy as np
import pytest

from workbench.core.jacobians import build_elements, jacobians
from workbench.core.mesh import Mesh
from workbench.core.principal_stretches import PrincipalStretches, StretchProbe

CHOSEN = np.array([0, 7, 3, 31])


def bent(mesh: Mesh, *, mirrored: bool = False) -> np.ndarray:
    """A map of a mesh that is no similarity anywhere."""
    random, n = np.random.default_rng(3), mesh.dimension
    turn = np.linalg.qr(random.normal(size=(3, 3)))[0][:, :n]
    flat = mesh.vertices if mesh.vertices.shape[1] == n else mesh.vertices @ turn
    moved = flat @ (np.eye(n) + 0.3 * random.normal(size=(n, n))) + 0.02 * random.normal(size=flat.shape)
    return moved * ([-1.0] + [1.0] * (n - 1)) if mirrored else moved


def check(found: PrincipalStretches, J: np.ndarray) -> None:
    n = J.shape[-1]
    reference = np.linalg.svd(J, compute_uv=False)
    np.testing.assert_allclose(np.abs(found.values), reference, rtol=1e-11)
    np.testing.assert_array_equal(found.inverted, np.linalg.det(J) <= 0)
    for rows in (found.source, found.target):
        np.testing.assert_allclose(rows @ rows.transpose(0, 2, 1), np.broadcast_to(np.eye(n), J.shape), atol=1e-12)


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("name", ["square", "cube"])
def test_lines_of_the_source_go_onto_lines_of_the_map(name: str, mirrored: bool, request: pytest.FixtureRequest) -> None:
    mesh: Mesh = request.getfixturevalue(name)
    positions = bent(mesh, mirrored=mirrored)
    J = jacobians(build_elements(mesh), positions)[CHOSEN]
    assert ((np.linalg.det(J) < 0) == mirrored).all()
    found = StretchProbe(mesh, CHOSEN).at(positions)
    check(found, J)
    np.testing.assert_allclose(np.einsum("kij,klj->kli", J, found.source), found.values[..., None] * found.target, atol=1e-12)


def test_on_a_surface_the_lines_lie_in_the_triangles(dome: Mesh) -> None:
    positions = bent(dome)
    found = StretchProbe(dome, CHOSEN).at(positions)
    check(found, jacobians(build_elements(dome), positions)[CHOSEN])
    corners, images = dome.vertices[dome.simplices[CHOSEN]], positions[dome.simplices[CHOSEN]]
    edges, moved = corners[:, 1:] - corners[:, :1], images[:, 1:] - images[:, :1]
    for k in range(len(CHOSEN)):
        for i in range(2):
            shares, *_ = np.linalg.lstsq(edges[k].T, found.source[k, i], rcond=None)
            np.testing.assert_allclose(edges[k].T @ shares, found.source[k, i], atol=1e-12)
            np.testing.assert_allclose(moved[k].T @ shares, found.values[k, i] * found.target[k, i], atol=1e-12)


def test_none_chosen_and_none_regular() -> None:
    flat = Mesh(np.array([[0.0, 0], [1, 0], [2, 0], [0, 1]]), np.array([[0, 1, 2], [0, 1, 3]]))
    assert len(StretchProbe(flat, np.empty(0, np.int64)).at(flat.vertices).values) == 0
    found = StretchProbe(flat, np.array([0, 1])).at(2.0 * flat.vertices)
    assert np.isnan(found.values[0]).all()
    np.testing.assert_allclose(found.values[1], 2.0)
    assert not found.inverted[1]
