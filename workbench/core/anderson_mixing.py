"""Anderson's mixture of the last iterates of a fixed-point iteration."""

from __future__ import annotations

import numpy as np

from workbench.core.arrays import Floats

SMALLEST = 1e-10
"""Part of the largest singular value of the differences below which one counts as zero."""


def anderson_step(iterates: tuple[tuple[Floats, Floats], ...]) -> Floats:
    """The step from the newest of the last iterates of x -> x + step(x).

    Parameters
    ----------
    iterates : tuple of (x, step)      (N, d) each, oldest first, at least one

    Returns
    -------
    (N, d) float64      step - sum t_j (dx_j + dstep_j), with the t that make step - sum t_j dstep_j the shortest

    Source: Anderson 1965; Peng et al. 2018, algorithm 1. Cost: O(N k^2) for k iterates.
    """
    _, step = iterates[-1]
    if len(iterates) == 1:
        return step
    maps, steps = (np.stack([pair[part].reshape(-1) for pair in iterates]) for part in (0, 1))
    moves, changes = np.diff(maps, axis=0), np.diff(steps, axis=0)
    # Differences shrink as the iteration converges: with columns of length 1 none is lost to the rounding of another.
    lengths = np.linalg.norm(changes, axis=1)
    used = lengths > 0.0
    moves, changes = moves[used] / lengths[used, None], changes[used] / lengths[used, None]
    mixture = np.linalg.lstsq(changes.T, step.reshape(-1), rcond=SMALLEST)[0]
    result: Floats = step - (mixture @ (moves + changes)).reshape(step.shape)
    return result
