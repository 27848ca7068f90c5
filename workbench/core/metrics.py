"""Quadratic metrics that change with the map, on the fixed pattern of the Hessian: what SLIM and AKVF minimise by."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from workbench.core.arrays import Floats
from workbench.core.distortion import Distortion
from workbench.core.metric_kernels import killing_metric, reweighted_metric
from workbench.core.threads import over_ranges

if TYPE_CHECKING:
    from workbench.core.problem import Problem

OWN_MEAN = -1.0
"""Stands for: each simplex's nearest minimiser is the similarity of its own size."""


def reweighted_laplacian(problem: Problem, positions: Floats) -> Floats:
    """Hessian of SLIM's proxy sum w |W (J - R)|^2, whose gradient at the map is that of the energy.

    W = U diag(sqrt(k / 2)) U^T with k_i = D_i / (sigma_i - s_i): s is the singular value of the nearest minimiser of the
    density (see `nearest_minimiser`). Where that is no positive number the limit D_ii stands in, and where this is none
    either a small part of the other weights: the gradient decides, the proxy stays definite.

    Returns
    -------
    (nnz,) float64 on the pattern, soft anchors included, positive semi-definite

    Source: Rabinovich et al. 2017, section 3 and table 1.
    """
    e, pattern = problem.elements, problem.density.pattern
    tape = problem.distortion.compiled(e.dimension).hessian
    centre = nearest_minimiser(problem.distortion, e.dimension)
    kept = problem.density.kept
    if problem.distortion.looks_at_start and not len(kept):
        kept = np.ones(len(e.simplices))

    def add(start: int, stop: int, values: Floats) -> None:
        reweighted_metric(
            positions, e.simplices, e.inverse_rest, e.rest_measures, kept, tape.code, tape.outputs,
            tape.registers(), centre, pattern.slots, start, stop, values,
        )  # fmt: skip

    return _summed(problem, add)


def killing_energy(problem: Problem, positions: Floats) -> Floats:
    """Hessian of sum w |grad v + (grad v)^T|^2 over fields v on the current map: motions that are no isometry cost.

    Returns
    -------
    (nnz,) float64 on the pattern, soft anchors included, positive semi-definite; rigid motions are its kernel

    Source: Claici et al. 2017, section 4, with the rest measures as weights as there.
    """
    e, pattern = problem.elements, problem.density.pattern

    def add(start: int, stop: int, values: Floats) -> None:
        killing_metric(
            positions, e.simplices, e.inverse_rest, e.rest_measures, pattern.slots, start, stop, values
        )  # fmt: skip

    return _summed(problem, add)


def _summed(problem: Problem, add: Callable[[int, int, Floats], None]) -> Floats:
    with problem.workspace.timed("assemble"):

        def work(part: int, start: int, stop: int) -> Floats:
            values = np.zeros(problem.density.pattern.entry_count)
            add(start, stop, values)
            return values

        values, *others = over_ranges(work, len(problem.elements.simplices))
        for other in others:
            values += other
        problem.add_soft_anchors(values)
        return values


def nearest_minimiser(distortion: Distortion, n: int) -> float:
    """Singular value s of the similarities at which the density is least; `OWN_MEAN` where all of them are alike.

    1 for isometric densities, `OWN_MEAN` for conformal ones, 0 for those that shrink.
    """
    sizes = np.geomspace(1e-3, 1e3, 241)
    with np.errstate(all="ignore"):
        values = distortion.value(np.repeat(sizes[:, None], n, axis=1))
    finite = np.isfinite(values)
    if not finite.any():
        return 1.0
    least, most = values[finite].min(), values[finite].max()
    if most - least <= 1e-9 * max(abs(most), 1.0):
        return OWN_MEAN
    best = int(np.argmin(np.where(finite, values, np.inf)))
    if best == 0:
        return 0.0
    if abs(sizes[best] - 1.0) < 1e-9 or best == len(sizes) - 1:
        return 1.0
    return float(sizes[best])
