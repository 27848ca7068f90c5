"""How good a map is: measures a simplex, histograms, counts and verdicts."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.histogram import bin_edges, bin_of, weight_in_bins
from workbench.core.jacobians import Elements, build_elements, determinants, signed_singular_values
from workbench.core.measure import Measure, SingularValues
from workbench.core.mesh import Mesh
from workbench.core.surface_jacobians import surface_singular_values

HISTOGRAM_BINS = 64
DEGENERATE = 1e-12
"""A simplex is degenerate where |det J| is at most this part of sigma_1^n."""


def average_histogram(averages: Floats) -> tuple[Floats, Integers]:
    """Histogram of average singular values (78): (edges, counts), over the 0.1 to 99.9 percentiles; the ends take the rest."""
    finite = averages[np.isfinite(averages)]
    if not len(finite):
        return np.linspace(0.0, 1.0, HISTOGRAM_BINS + 1), np.zeros(HISTOGRAM_BINS, dtype=np.int64)
    ranks = (int(0.001 * (len(finite) - 1)), int(np.ceil(0.999 * (len(finite) - 1))))
    low, high = np.partition(finite, ranks)[list(ranks)]
    if high - low <= 1e-9 * max(abs(high), 1e-300):
        low, high = low - 0.5 * max(abs(low), 1e-12), high + 0.5 * max(abs(high), 1e-12)
    places = bin_of(finite, float(low), float(high), HISTOGRAM_BINS)
    counts = weight_in_bins(places, HISTOGRAM_BINS)
    return bin_edges(float(low), float(high), HISTOGRAM_BINS), counts.astype(np.int64)


def simplex_measures_of(mesh: Mesh, positions: Floats, others: Iterable[Measure] = ()) -> dict[str, Floats]:
    """What is measured of each simplex of a map: every registered distortion by id, and `others` by theirs, each (m,)."""
    sigma = SingularValues(_singular_values(build_elements(mesh), positions))
    return _values_of(sigma, others)


def _values_of(sigma: SingularValues, others: Iterable[Measure] = ()) -> dict[str, Floats]:
    from workbench.core.registry import registry

    measures = [*(Measure(id) for id in sorted(registry().distortions)), *others]
    return {measure.id: measure.prepare(sigma.dimension)(sigma) for measure in measures}


def simplex_table(mesh: Mesh, positions: Floats, others: Iterable[Measure] = ()) -> dict[str, Floats]:
    """Columns of a table of simplices, each (m,): sigma_1 .. sigma_n (signed), det, inverted (0 or 1), each measure, and the
    area or volume in the source. Of a surface in space, which has no orientation, det is the factor of area."""
    elements = build_elements(mesh)
    sigma = _singular_values(elements, positions)
    columns = {f"sigma_{i + 1}": sigma[:, i] for i in range(elements.dimension)}
    is_surface = positions.shape[1] > elements.dimension
    columns["det"] = sigma.prod(axis=1) if is_surface else determinants(elements, positions)
    columns["inverted"] = np.where(columns["det"] > 0, 0.0, 1.0)
    columns |= _values_of(SingularValues(sigma), others)
    return columns | {"area" if elements.dimension == 2 else "volume": elements.rest_measures}


def _singular_values(elements: Elements, positions: Floats) -> Floats:
    of_surface = positions.shape[1] > elements.dimension
    return surface_singular_values(elements, positions) if of_surface else signed_singular_values(elements, positions)


def measure_surface(mesh: Mesh, positions: Floats) -> dict[str, Any]:
    """Measures of a map of a surface into space, from `mesh` to `positions` (n, 3), as `measure_map` has those of others."""
    elements = build_elements(mesh)
    sigma = surface_singular_values(elements, positions)
    values = _values_of(SingularValues(sigma))
    return {
        "measures": {id: statistics(of_each, elements.rest_measures) for id, of_each in values.items()},
        "degenerate": int(np.count_nonzero(sigma[:, 1] <= DEGENERATE * sigma[:, 0])),
        "area": {"source": float(elements.rest_measures.sum()), "target": float(elements.rest_measures @ sigma.prod(axis=1))},
    }


def measure_map(mesh: Mesh, positions: Floats, others: Iterable[Measure] = ()) -> dict[str, Any]:
    """Every measure of a map, as DESIGN's `measure --json` gives it.

    Parameters
    ----------
    mesh : Mesh                    the source
    positions : (n, d) float64     the map
    others : Measure ...           measured beside every registered distortion

    Returns
    -------
    dict     measures {id: {mean, max, min, p50, p95, area_weighted_mean}} of every registered distortion and of (78),
             inverted, degenerate, min_det, injective {local, global, reason}, histogram78 {edges, counts}

    Raises `WorkbenchError` for one of `others` that is no measure in this dimension.
    """
    from workbench.core.injectivity import global_injectivity, local_injectivity

    elements = build_elements(mesh)
    positions = np.ascontiguousarray(positions, dtype=np.float64)
    sigma = signed_singular_values(elements, positions)
    det = determinants(elements, positions)
    values = simplex_measures_of(mesh, positions, others)
    measures = {id: statistics(of_each, elements.rest_measures) for id, of_each in values.items()}
    edges, counts = average_histogram(np.abs(sigma).mean(axis=1))
    local = local_injectivity(mesh, positions)
    whole = global_injectivity(mesh, positions)
    return {
        "measures": measures,
        "inverted": int(np.count_nonzero(~(det > 0))),
        "degenerate": int(np.count_nonzero(np.abs(sigma[:, -1]) <= DEGENERATE * np.abs(sigma[:, 0]))),
        "min_det": float(det.min()),
        "injective": {
            "local": local.holds,
            "global": whole.holds,
            "reason": whole.reason if local.holds else local.reason,
        },
        "histogram78": {"edges": edges.tolist(), "counts": counts.tolist()},
    }


def statistics(values: Floats, weights: Floats) -> dict[str, float]:
    """Mean, extremes, percentiles and area-weighted mean of values a simplex; infinities stay infinite."""
    with np.errstate(invalid="ignore"):
        return {
            "mean": float(values.mean()),
            "max": float(values.max()),
            "min": float(values.min()),
            "p50": float(np.percentile(values, 50, method="lower")),
            "p95": float(np.percentile(values, 95, method="lower")),
            "area_weighted_mean": float(weights @ values / weights.sum()),
        }
