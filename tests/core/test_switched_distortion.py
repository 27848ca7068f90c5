"""A problem that was switched to another distortion is the same as one that began with it."""

from __future__ import annotations

import numpy as np
import pytest

from workbench.core.arrays import Floats
from workbench.core.distortion import Distortion
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.registry import registry
from workbench.core.samples import make_sample

FORMULAS = ("max(sigma)", "3*sum(sigma) + 5", "sum((sigma - 2)^2) + 7*max(sigma)", "exp(sum(sigma)/9)")
"""Some with constants, one without any register of its own: what stands there is theirs alone."""


def stretched(mesh: Mesh) -> Floats:
    """A map (n, d) of a figure, upright but in a few simplices."""
    positions = mesh.vertices * (1.2, 0.9, 1.1)[: mesh.dimension]
    inner = int(np.argmin(np.linalg.norm(positions - positions.mean(axis=0), axis=1)))
    positions[inner] += 0.4
    return np.ascontiguousarray(positions)


@pytest.mark.parametrize("sample", ["gingerbread", "bar-3d"])
def test_nothing_of_the_distortion_before_stays(sample: str) -> None:
    """One looks at the start, and keeps a flag a simplex: a register that is another's constant, or nobody's."""
    mesh = make_sample(sample)
    kind, positions = "plane" if mesh.dimension == 2 else "volume", stretched(mesh)
    looking = [item for item in registry().distortions.values() if item.looks_at_start]
    assert looking, "or there is nothing to leave behind"
    others = [*registry().distortions.values(), *map(Distortion.resolve, FORMULAS)]
    for first in looking:
        begun = Problem.create(mesh, kind, first).from_start(positions)
        assert len(begun.density.kept) == mesh.simplex_count and not begun.density.kept.all()
        for other in others:
            if other.looks_at_start:
                continue
            switched, fresh = begun.with_distortion(other), Problem.create(mesh, kind, other)
            for order in (0, 1, 2):
                if order:
                    one, two = switched.evaluate(positions, order), fresh.evaluate(positions, order)
                    np.testing.assert_array_equal(one.gradient, two.gradient, err_msg=other.formula)
                    np.testing.assert_array_equal(one.hessian_values, two.hessian_values, err_msg=other.formula)
                assert switched.energy(positions) == fresh.energy(positions), other.formula
            back = switched.with_distortion(first).from_start(positions)
            assert back.energy(positions) == begun.energy(positions), "it looks anew"
