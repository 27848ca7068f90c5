"""Fig. 12 and Fig. 19: what inversions do to energies, against values worked out by other means."""

from __future__ import annotations

import numpy as np
import pytest

from workbench.core.analysis import analyse
from workbench.core.analysis.barrier_terms import without_barrier
from workbench.core.analysis.density import Density
from workbench.core.analysis.paths import mirror_path, pulled_vertex, regular_simplex
from workbench.core.distortion import Distortion
from workbench.core.errors import WorkbenchError
from workbench.core.mesh import Mesh
from workbench.core.problem import Problem
from workbench.core.registry import registry

IDS = sorted(registry().distortions)


@pytest.mark.parametrize("id", IDS)
def test_the_pulled_vertex_has_the_energies_of_its_maps(id: str) -> None:
    distortion = registry().distortions[id]
    path = pulled_vertex(distortion, count=23)
    source = Mesh(path.positions[0], path.triangles)
    plain = Distortion("plain", "plain", distortion.formula, distortion.parameters, distortion.values, distortion.barrier)
    problem = Problem.create(source, "plane", plain, allow_inversions=True)
    for x, energy, filtered, inverted in zip(path.positions, path.energies, path.filtered_energies, path.inverted, strict=True):
        expected = problem.energy(x)
        assert energy == pytest.approx(expected, rel=1e-9, abs=1e-12)
        assert np.isfinite(filtered)
        if not inverted.any():
            assert filtered == energy
    counts = path.inverted.sum(axis=1)
    assert counts[0] == 0 and counts[-1] >= 2 and (np.diff(counts) >= 0).all()


@pytest.mark.parametrize("id", ["symmetric-dirichlet", "symmetric-dirichlet-filtered"])
def test_the_filter_leaves_the_dirichlet_energy_on_inverted_triangles(id: str) -> None:
    path = pulled_vertex(registry().distortions[id], sides=5, reach=1.5, count=31)
    k = len(path.offsets) - 1
    total = 0.0
    for triangle, inverted in zip(path.triangles, path.inverted[k], strict=True):
        rest, now = (positions[triangle][1:] - positions[triangle][0] for positions in (path.positions[0], path.positions[k]))
        jacobian = np.linalg.solve(rest, now)
        area = 0.5 * abs(np.linalg.det(rest))
        assert (np.linalg.det(jacobian) <= 0) == inverted
        total += area * (np.sum(jacobian**2) + (0.0 if inverted else np.sum(np.linalg.inv(jacobian) ** 2)))
    assert path.inverted[k].any() and np.isinf(path.energies[k])
    assert path.filtered_energies[k] == pytest.approx(total, rel=1e-12)


def test_without_a_barrier_nothing_is_filtered() -> None:
    path = pulled_vertex(registry().distortions["arap"])
    assert np.array_equal(path.energies, path.filtered_energies) and path.inverted.any()


@pytest.mark.parametrize(
    ("text", "left"),
    [
        ("sum(sigma^2 + 1/sigma^2)", "sum(sigma^2)"),
        ("max(sigma)/min(sigma)", "max(sigma)"),
        ("max(det, 1/det)", "det"),
        ("2*sum(sigma^2)/det - 3*sigma1", "2*sum(sigma^2) - 3*sigma1"),
        ("exp(sum(sigma) + 1/det)", "exp(sum(sigma))"),
        ("sum((sigma - 1)^2)", "sum((sigma - 1)^2)"),
    ],
)
def test_what_is_left_without_the_barrier(text: str, left: str) -> None:
    sigma = np.array([[2.0, 1.5], [1.0, 0.2], [3.0, 1e-9]])
    bare = without_barrier(Density.of(Distortion.from_formula(text), 2))
    assert np.allclose(bare(sigma), Density.of(Distortion.from_formula(left), 2)(sigma), rtol=1e-14)


@pytest.mark.parametrize("id", IDS)
@pytest.mark.parametrize("n", [2, 3])
def test_the_mirror_path_agrees_with_the_badge(id: str, n: int) -> None:
    """Theorem 8.2: a chord through the mirror image refutes every isometric or conformal distortion, and no convex one."""
    distortion = registry().distortions[id]
    path = mirror_path(distortion, n, count=41)
    badge = analyse(distortion, n).convex.holds
    assert badge is not None and path.violates != badge
    assert path.energies[-1] == pytest.approx(path.energies[0], rel=1e-9, abs=1e-15)
    assert np.allclose(path.chord, path.energies[0])
    assert np.isinf(path.energies[20]) == (distortion.has_barrier(n) and id != "arap-barrier")
    assert abs(np.linalg.det(path.positions[20][1:] - path.positions[20][0])) < 1e-15


def test_the_longer_segment_shows_that_it_is_not_concave_either() -> None:
    path = mirror_path(registry().distortions["arap"], 2, t0=-1.0, t1=2.0, count=61)
    assert not path.violates and path.energies[20] < path.chord[20]


def test_the_mirror_path_of_a_given_simplex() -> None:
    corners = np.array([[0.0, 0.0], [2.0, 0.5], [0.5, 1.0]])
    path = mirror_path(registry().distortions["dirichlet"], 2, corners, count=5)
    area = 0.5 * abs(2.0 * 1.0 - 0.5 * 0.5)
    assert np.allclose(path.energies, area * (1.0 + (1.0 - 2.0 * path.t) ** 2))
    assert np.allclose(path.positions[0], corners) and np.allclose(path.positions[-1], corners * [-1.0, 1.0])


def test_regular_simplices_are_regular() -> None:
    for n in (2, 3):
        corners = regular_simplex(n)
        lengths = [np.linalg.norm(corners[i] - corners[j]) for i in range(n + 1) for j in range(i)]
        assert np.allclose(lengths, 1.0) and np.linalg.det(corners[1:] - corners[0]) > 0
        assert np.allclose(corners.mean(axis=0), 0.0)


def test_what_is_no_path_is_refused() -> None:
    distortion = registry().distortions["dirichlet"]
    for call in (
        lambda: pulled_vertex(distortion, sides=2),
        lambda: pulled_vertex(distortion, reach=np.inf),
        lambda: mirror_path(distortion, 3, regular_simplex(2)),
        lambda: mirror_path(distortion, 2, np.zeros((3, 2))),
        lambda: mirror_path(distortion, 2, t1=np.nan),
    ):
        with pytest.raises(WorkbenchError):
            call()
