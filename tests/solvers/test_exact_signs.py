"""Where no barrier holds them off, simplices collapse until rounding decides their sign: even so no map has one inverted."""

from __future__ import annotations

import numpy as np
import pytest

from tests.conftest import tetrahedral_grid
from workbench.core.arrays import Floats
from workbench.core.constraints import Anchors
from workbench.core.energy import Energy
from workbench.core.jacobians import build_elements, determinants
from workbench.core.mesh import Mesh
from workbench.core.predicates import orientation, orientation_3d
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.run import run

BLOCK = tetrahedral_grid(2)
BAR = Mesh(BLOCK.vertices * [6.0, 1.0, 1.0], BLOCK.simplices)


def signs(mesh: Mesh, positions: Floats) -> set[int]:
    corners = positions[mesh.simplices].transpose(1, 0, 2)
    return set((orientation(*corners) if mesh.dimension == 2 else orientation_3d(*corners)).tolist())


@pytest.mark.parametrize("id", ["average-singular-value", "ky-fan", "dirichlet"])
@pytest.mark.parametrize("solver", ["projected-newton", "aqp", "block-gradient-descent"])
def test_a_twisted_bar_of_a_norm_stays_upright_to_the_last_bit(id: str, solver: str) -> None:
    x = BAR.vertices[:, 0]
    ends = np.flatnonzero((x == 0.0) | (x == 6.0))
    targets = BAR.vertices[ends].copy()
    targets[x[ends] == 6.0, 1:] = 1.0 - targets[x[ends] == 6.0, 1:] + 0.05
    problem = Problem.create(BAR, "volume", registry().distortions[id], Anchors(ends, targets))
    seen: set[int] = set()
    run(
        registry().solver(solver)(),
        problem,
        BAR.vertices,
        iterations=60,
        on_state=lambda s: seen.update(signs(BAR, s.positions)),
    )
    assert seen == {1}


@pytest.mark.parametrize("id", ["average-singular-value", "arap-barrier"])
def test_a_collapse_that_rounding_hides_is_counted(id: str) -> None:
    """The corners are on a line, exactly; the edges from the first one, rounded, are not."""
    mesh = Mesh(np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), np.array([[0, 1, 2]]))
    elements = build_elements(mesh)
    flat = next(
        found
        for found in (
            np.array([[a, a], [b, b], [c, c]]) * [1.0, 3.0] for a, b, c in np.random.default_rng(0).random((10_000, 3))
        )
        if determinants(elements, found)[0] > 0.0 and signs(mesh, found) <= {0, -1}
    )
    energy = Energy(elements, registry().distortions[id])
    for result in (energy.value(flat), (energy.gradient(flat).energy, energy.gradient(flat).inverted)):
        assert result[1] == 1
        assert np.isinf(result[0]) == (id == "arap-barrier")
    assert Energy(elements, registry().distortions["average-singular-value"], allow_inversions=True).value(flat)[1] == 0
