"""What the comparison of shape signatures shows, worked out away from the window's thread."""

from __future__ import annotations

from dataclasses import dataclass

from workbench.core.arrays import Floats
from workbench.core.signature import Distances, Signature, common_edges, distances, heights_on_axis


@dataclass(frozen=True)
class ComparisonChoices:
    """How signatures are compared: each at the scale where its mean is 1, bins of equal factors, how many bins."""

    is_normalised: bool = False
    is_logarithmic: bool = False
    bins: int = 64


@dataclass(frozen=True, eq=False)
class Comparison:
    """Signatures as they were compared, with the common `edges` (k + 1,), `heights` (k,) for each, and the distances."""

    signatures: tuple[Signature, ...]
    edges: Floats
    heights: tuple[Floats, ...]
    distances: Distances
    choices: ComparisonChoices


def compare(signatures: tuple[Signature, ...], choices: ComparisonChoices) -> Comparison:
    """Histograms over common bins and distances of at least one signature. Raises `WorkbenchError` for one without scale."""
    shown = tuple(item.normalised() if choices.is_normalised else item for item in signatures)
    edges = common_edges(shown, choices.bins, logarithmic=choices.is_logarithmic)
    heights = tuple(heights_on_axis(item, edges, logarithmic=choices.is_logarithmic) for item in shown)
    return Comparison(shown, edges, heights, distances(shown, edges), choices)
