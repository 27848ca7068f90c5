"""Shape signatures as CSV: their distances, their histograms."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.signature import Distances, Signature, densities
from workbench.io.write import csv_line


def distances_text(apart: Distances) -> str:
    """A row a pair: names, L1 and Wasserstein-1 distance."""
    rows = [csv_line((a, b, f"{l1:.17g}", f"{wasserstein:.17g}")) for a, b, l1, wasserstein in apart.pairs()]
    return csv_line(("a", "b", "l1", "wasserstein1")) + "".join(rows)


def histograms_text(items: Sequence[Signature], edges: Floats) -> str:
    """A row a bin: its ends and the density of each map, which has the integral 1."""
    table = np.column_stack([edges[:-1], edges[1:], *(densities(item, edges) for item in items)])
    rows = [csv_line(f"{value:.17g}" for value in row) for row in table.tolist()]
    return csv_line(("low", "high", *(item.name for item in items))) + "".join(rows)
