"""Whether simplices agree on their orientation, and which to turn over so that they do."""

from __future__ import annotations

import numpy as np
import scipy

from workbench.core.arrays import Booleans, Integers
from workbench.core.facets import FacetTable


def orientation_sheets(table: FacetTable, simplex_count: int) -> tuple[bool, bool, Integers]:
    """Orientation by the double cover: each simplex stands there twice, as it is and turned over.

    Neighbours are joined so that they agree across their facet. A component is orientable iff the two copies of its
    simplices fall into two sheets. Facets of more than two simplices say nothing on the orientation.

    Returns
    -------
    is_orientable, is_consistent : bool
    sheets : (2, m) int64       sheet of each simplex as it is (row 0) and turned over (row 1)
    """
    inner = table.pair_counts == 2
    left, right = table.pair_simplices[inner].T
    signs = table.signs[table.pairs[inner]]
    agree = signs[:, 0] != signs[:, 1]  # the two sides of one facet run against each other
    is_consistent = bool(agree.all())
    turned = np.where(agree, 0, simplex_count)
    tails = np.concatenate([left, left + simplex_count])
    heads = np.concatenate([right + turned, right + (simplex_count - turned)])
    graph = scipy.sparse.coo_array((np.ones(len(tails), np.int8), (tails, heads)), shape=(2 * simplex_count, 2 * simplex_count))
    _, labels = scipy.sparse.csgraph.connected_components(graph.tocsr(), directed=False)
    sheets = labels.astype(np.int64).reshape(2, simplex_count)
    return not bool((sheets[0] == sheets[1]).any()), is_consistent, sheets


def simplices_to_flip(sheets: Integers) -> Booleans:
    """Which simplices to turn over so that all neighbours agree, (m,) bool: the fewer of each component.

    Components that are not orientable are left as they are.
    """
    upright = np.bincount(sheets[0], minlength=int(sheets.max()) + 1)
    as_is, turned = upright[sheets[0]], upright[sheets[1]]
    # On a tie the sheet of the component's first simplex stays: it has the lower number.
    return (turned > as_is) | ((turned == as_is) & (sheets[1] < sheets[0]))
