"""Shape signatures: the distribution of the average singular value (78) of a map, and how far two of them are apart."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from workbench.core.arrays import Floats, frozen
from workbench.core.errors import WorkbenchError
from workbench.core.histogram import bin_edges, weight_in_bins
from workbench.core.jacobians import build_elements
from workbench.core.mesh import Mesh
from workbench.core.surface_jacobians import singular_values_of_any

BINS = 64
TAIL = 0.001
"""Part of the weight beyond each end of the common bins; it belongs to the bins at the ends."""


@dataclass(frozen=True, eq=False)
class Signature:
    """The average singular values (78) of one map, each with the part of the source that has it.

    A map onto a common domain is described by it, as Fig. 1 of the survey does; it knows nothing of where on the mesh
    a value stands.

    Parameters
    ----------
    name : str
    values : (m,) float64      approximate conformal factors; they grow with the scale of the map
    weights : (m,) float64     parts of the total area or volume of the source: they sum to 1
    """

    name: str
    values: Floats
    weights: Floats

    def __post_init__(self) -> None:
        object.__setattr__(self, "values", frozen(self.values))
        object.__setattr__(self, "weights", frozen(self.weights))

    @property
    def mean(self) -> float:
        """Mean over the area of the source."""
        return float(self.weights @ self.values)

    def normalised(self) -> Signature:
        """The same at the scale where the mean is 1: maps that differ in the scale of source or target alone agree.

        Raises `WorkbenchError` for a map whose values all vanish.
        """
        if not self.mean > 0:
            raise WorkbenchError(f"{self.name}: the map is a single point, which has no scale.")
        return replace(self, values=self.values / self.mean)

    def named(self, name: str) -> Signature:
        return replace(self, name=name)


def signature(mesh: Mesh, positions: Floats, name: str = "") -> Signature:
    """The signature of a map.

    Parameters
    ----------
    mesh : Mesh                    the source
    positions : (n, d) float64     the map

    Raises `MeshError` where the source is degenerate. Source: (78), Ben-Chen & Gotsman 2008.
    """
    elements = build_elements(mesh)
    sizes = np.abs(singular_values_of_any(elements, positions))
    areas = elements.rest_measures
    return Signature(name or mesh.name, sizes.mean(axis=1), areas / areas.sum())


def common_edges(signatures: Sequence[Signature], count: int = BINS, *, logarithmic: bool = False) -> Floats:
    """Edges (count + 1,) of bins that hold all but the tails of every signature, so that their histograms compare.

    `logarithmic` bins have equal factors: half and double are then equally far from 1.
    """
    ends = [_between_tails(item) for item in signatures]
    low, high = min(end[0] for end in ends), max(end[1] for end in ends)
    if logarithmic:
        low = max(low, 1e-12 * max(high, 1e-300))
    if high - low <= 1e-9 * max(abs(high), 1e-300):  # values that differ by rounding lie in the middle of one bin
        low, high = 0.5 * low, max((1.5 + 1.0 / count) * high, 1e-12)
    return bin_edges(low, high, count, logarithmic=logarithmic)


def _between_tails(item: Signature) -> tuple[float, float]:
    order = np.argsort(item.values)
    reached = np.cumsum(item.weights[order])
    first, last = np.searchsorted(reached, (TAIL, 1.0 - TAIL))
    return float(item.values[order[first]]), float(item.values[order[min(last, len(order) - 1)]])


def masses(item: Signature, edges: Floats) -> Floats:
    """Part of the source in each bin (k,); they sum to 1, what lies beyond the ends belongs to the bins there."""
    count = len(edges) - 1
    bins = np.clip(np.searchsorted(edges, item.values, side="right") - 1, 0, count - 1)
    return weight_in_bins(bins, count, item.weights)


def densities(item: Signature, edges: Floats) -> Floats:
    """Normalised histogram (k,): its integral over the bins is 1."""
    return masses(item, edges) / np.diff(edges)


def heights_on_axis(item: Signature, edges: Floats, *, logarithmic: bool) -> Floats:
    """Heights (k,) of bars whose areas as drawn are parts of the source: on a logarithmic axis the unit is a decade.

    A density over the values themselves would raise the small ones there, as their bins are narrow, and hide the large.
    """
    return masses(item, edges) / np.diff(np.log10(edges)) if logarithmic else densities(item, edges)


def l1_distance(first: Signature, second: Signature, edges: Floats) -> float:
    """Integral of the difference of two normalised histograms, in [0, 2]; it depends on the bins, with ends (b + 1,)."""
    return float(np.abs(masses(first, edges) - masses(second, edges)).sum())


def wasserstein_distance(first: Signature, second: Signature) -> float:
    """Wasserstein-1: how far the values of one must be moved, on average over the area, to become those of the other.

    In units of the values; it needs no bins. The area between the two cumulative distributions.
    """
    places = np.concatenate([first.values, second.values])
    order = np.argsort(places, kind="stable")
    steps = np.concatenate([first.weights, -second.weights])[order]
    return float(np.abs(np.cumsum(steps)[:-1]) @ np.diff(places[order]))


@dataclass(frozen=True, eq=False)
class Distances:
    """Between every two of k signatures: `l1` (k, k) over the common `edges`, `wasserstein` (k, k)."""

    names: tuple[str, ...]
    edges: Floats
    l1: Floats
    wasserstein: Floats

    def pairs(self) -> list[tuple[str, str, float, float]]:
        """Each pair once: its names, L1, Wasserstein-1."""
        return [
            (self.names[i], self.names[j], float(self.l1[i, j]), float(self.wasserstein[i, j]))
            for i in range(len(self.names))
            for j in range(i + 1, len(self.names))
        ]


def distances(signatures: Sequence[Signature], edges: Floats) -> Distances:
    """How far every two of k signatures are apart, histograms with bins between edges (b + 1,). Cost: O(k^2 m log m)."""
    count = len(signatures)
    l1, wasserstein = np.zeros((count, count)), np.zeros((count, count))
    for i in range(count):
        for j in range(i):
            l1[i, j] = l1[j, i] = l1_distance(signatures[i], signatures[j], edges)
            wasserstein[i, j] = wasserstein[j, i] = wasserstein_distance(signatures[i], signatures[j])
    return Distances(tuple(item.name for item in signatures), edges, l1, wasserstein)
