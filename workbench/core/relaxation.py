"""Simplices that came out inverted, relaxed away: vertices near them move to the middle of their neighbours."""

from __future__ import annotations

from collections.abc import Callable
from itertools import permutations

import numpy as np
import scipy

from workbench.core.arrays import Floats, Integers

_GROWTH = 4
"""Every so many rounds the vertices that move are joined by their neighbours, until there is room."""


def relaxed(
    simplices: Integers,
    positions: Floats,
    inverted: Callable[[Floats], Integers],
    middle: Callable[[Floats], Floats] = lambda means: means,
    held: Integers | None = None,
    rounds: int = 400,
) -> Floats:
    """The map with the fewest inverted simplices of so many rounds; it ends early where none is left.

    Parameters
    ----------
    simplices : (m, n+1) int64
    positions : (n, 3) float64
    inverted : positions -> (k,) int64     simplices to be mended
    middle : (n, 3) -> (n, 3)              from means of neighbours to places, for maps to a sphere
    held : (h,) int64                      vertices that stay
    """
    found = inverted(positions)
    if not len(found):
        return positions
    size = len(positions)
    pairs = np.concatenate([simplices[:, list(pair)] for pair in permutations(range(simplices.shape[1]), 2)])
    links = scipy.sparse.coo_matrix((np.ones(len(pairs)), pairs.T), shape=(size, size)).tocsr()
    links.data[:] = 1.0
    degrees = np.maximum(np.asarray(links.sum(axis=1)), 1.0)
    may_move = np.ones(size, dtype=bool)
    if held is not None:
        may_move[held] = False
    best, fewest = positions, len(found)
    moves = np.zeros(size, dtype=bool)
    for step in range(rounds):
        moves[simplices[found]] = True
        if step % _GROWTH == _GROWTH - 1:
            moves |= links @ moves.astype(np.float64) > 0.0
        positions = np.where((moves & may_move)[:, None], middle(links @ positions / degrees), positions)
        found = inverted(positions)
        if len(found) < fewest:
            best, fewest = positions, len(found)
        if not fewest:
            break
    return best
