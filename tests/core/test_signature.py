"""Shape signatures: laws of the histograms and of their distances."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from workbench.core.errors import WorkbenchError
from workbench.core.histogram import bin_edges, bin_of, weight_in_bins
from workbench.core.mesh import Mesh
from workbench.core.signature import (
    Signature,
    common_edges,
    densities,
    distances,
    heights_on_axis,
    l1_distance,
    masses,
    signature,
    wasserstein_distance,
)


def random_signature(seed: int, count: int = 400) -> Signature:
    random = np.random.default_rng(seed)
    values = np.exp(random.normal(0.1 * seed, 0.4, count))
    values[: count // 8] = values[0]  # ties
    weights = random.uniform(0.0, 1.0, count)
    return Signature(f"map {seed}", values, weights / weights.sum())


@pytest.mark.parametrize("seed", range(5))
def test_wasserstein_is_that_of_scipy(seed: int) -> None:
    first, second = random_signature(seed), random_signature(seed + 1, 173)
    expected = stats.wasserstein_distance(first.values, second.values, first.weights, second.weights)
    assert wasserstein_distance(first, second) == pytest.approx(expected, rel=1e-10)


def test_distances_are_metrics() -> None:
    items = [random_signature(seed) for seed in range(4)]
    edges = common_edges(items)
    found = distances(items, edges)
    for table in (found.l1, found.wasserstein):
        np.testing.assert_array_equal(table, table.T)
        assert (np.diag(table) == 0).all() and (table[~np.eye(4, dtype=bool)] > 0).all()
        assert (table[:, :, None] <= table[:, None, :] + table.T[None, :, :] + 1e-12).all(), "triangle inequality"
    assert (found.l1 <= 2.0).all()
    assert len(found.pairs()) == 6 and found.pairs()[0][:2] == ("map 0", "map 1")


def test_a_shift_costs_its_length_and_disjoint_ones_are_two_apart() -> None:
    item = random_signature(1)
    shifted = Signature("shifted", item.values + 0.37, item.weights)
    far = Signature("far", item.values + 1000.0, item.weights)
    assert wasserstein_distance(item, shifted) == pytest.approx(0.37)
    assert l1_distance(item, far, common_edges([item, far])) == pytest.approx(2.0)


@pytest.mark.parametrize("logarithmic", [False, True])
def test_histograms_have_the_integral_one(logarithmic: bool) -> None:
    items = [random_signature(seed) for seed in range(3)]
    edges = common_edges(items, logarithmic=logarithmic)
    for item in items:
        assert densities(item, edges) @ np.diff(edges) == pytest.approx(1.0)
        inside = (item.values >= edges[10]) & (item.values < edges[11])
        assert masses(item, edges)[10] == pytest.approx(item.weights[inside].sum(), abs=1e-12)


@pytest.mark.parametrize("logarithmic", [False, True])
def test_bars_of_equal_width_are_as_high_as_their_parts_are_large(logarithmic: bool) -> None:
    items = [random_signature(seed) for seed in range(2)]
    edges = common_edges(items, logarithmic=logarithmic)
    widths = np.diff(np.log10(edges) if logarithmic else edges)
    assert widths == pytest.approx(widths[0])
    for item in items:
        heights = heights_on_axis(item, edges, logarithmic=logarithmic)
        assert heights @ widths == pytest.approx(1.0)
        assert heights / heights.max() == pytest.approx(masses(item, edges) / masses(item, edges).max())


def test_a_signature_is_that_of_the_map(square: Mesh, cube: Mesh) -> None:
    stretched = signature(square, square.vertices * [3.0, 0.5], "stretched")
    np.testing.assert_allclose(stretched.values, 1.75)
    assert stretched.weights.sum() == pytest.approx(1.0) and stretched.mean == pytest.approx(1.75)
    np.testing.assert_allclose(signature(cube, cube.vertices * [1.0, 2.0, 6.0]).values, 3.0)
    rotated = square.vertices @ np.array([[0.0, 1.0], [-1.0, 0.0]])
    assert wasserstein_distance(signature(square, rotated), signature(square, square.vertices)) == pytest.approx(0.0, abs=1e-12)


def test_normalised_signatures_forget_the_scale(square: Mesh) -> None:
    x, y = square.vertices.T
    bent = np.column_stack([x + 0.2 * y**2, y + 0.1 * x * y])
    small, large = (signature(square, scale * bent).normalised() for scale in (0.01, 100.0))
    np.testing.assert_allclose(small.values, large.values, rtol=1e-12)
    assert small.mean == pytest.approx(1.0)
    # the mesh's own scale is forgotten too, and so is how finely equal values are divided
    scaled = Mesh(7.0 * square.vertices, square.simplices)
    np.testing.assert_allclose(signature(scaled, bent).normalised().values, small.values, rtol=1e-12)
    with pytest.raises(WorkbenchError, match="no scale"):
        signature(square, np.zeros_like(bent)).normalised()


def test_bins_hold_every_value_once() -> None:
    values = np.array([-np.inf, -1.0, 0.0, 0.5, 0.999, 1.01, 7.0, np.inf, np.nan])
    assert bin_of(values, 0.0, 1.0, 4).tolist() == [0, 0, 0, 2, 3, 3, 3, 3, -1]
    assert bin_of(values, 0.1, 10.0, 2, logarithmic=True).tolist() == [0, 0, 0, 0, 0, 1, 1, 1, -1]
    assert weight_in_bins(bin_of(values, 0.0, 1.0, 4), 4).sum() == 8
    random = np.random.default_rng(0).lognormal(size=1000)
    for logarithmic in (False, True):
        edges = bin_edges(0.2, 3.0, 16, logarithmic=logarithmic)
        inside = random[(random > 0.2) & (random < 3.0)]
        counts = weight_in_bins(bin_of(inside, 0.2, 3.0, 16, logarithmic=logarithmic), 16)
        np.testing.assert_array_equal(counts, np.histogram(inside, edges)[0])


def test_values_that_are_all_alike_have_bins_too() -> None:
    item = Signature("flat", np.ones(5), np.full(5, 0.2))
    edges = common_edges([item])
    assert (np.diff(edges) > 0).all() and densities(item, edges) @ np.diff(edges) == pytest.approx(1.0)


@pytest.mark.parametrize("value", [1.0, 0.3, 7e-5, 2e9])
@pytest.mark.parametrize("logarithmic", [False, True])
def test_values_that_differ_by_rounding_lie_in_one_bin(value: float, logarithmic: bool) -> None:
    noise = 1.0 + np.random.default_rng(1).uniform(-1e-12, 1e-12, 200)
    item = Signature("rest", value * noise, np.full(200, 1 / 200))
    edges = common_edges([item], logarithmic=logarithmic)
    assert np.count_nonzero(masses(item, edges)) == 1
