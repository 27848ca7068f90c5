"""How good a map is: measures a simplex, histograms, counts and verdicts."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from workbench.core.arrays import Floats, Integers
from workbench.core.histogram import bin_edges, bin_of, weight_in_bins
from workbench.core.jacobians import build_elements
from workbench.core.measure import Measure, SingularValues
from workbench.core.mesh import Mesh
from workbench.core.surface_jacobians import determinants_of_any, is_into_space, singular_values_of_any

HISTOGRAM_BINS = 64
DEGENERATE = 1e-12
"""A simplex is degenerate where |det J| is at most this part of sigma_1^n."""

NO_SIDES = {
    "local": None, "global": None, "reason": "Triangles in space have no orientation of their own, so there is no verdict.",
}  # fmt: skip
"""Verdicts on a map of a surface into space."""


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


def _values_of(sigma: SingularValues, others: Iterable[Measure] = ()) -> dict[str, Floats]:
    """What is measured of each simplex of a map: every registered distortion by id, and `others` by theirs, each (m,)."""
    from workbench.core.registry import registry

    measures = [*(Measure(id) for id in sorted(registry().distortions)), *others]
    return {measure.id: measure.prepare(sigma.dimension)(sigma) for measure in measures}


def simplex_table(mesh: Mesh, positions: Floats, others: Iterable[Measure] = ()) -> dict[str, Floats]:
    """Columns of a table of simplices, each (m,).

    sigma_1 .. sigma_n (signed), det, inverted (0 or 1), each measure, and `area` or `source_volume` of the source.
    Triangles in space have no orientation: their det is the factor of area.
    """
    elements = build_elements(mesh)
    sigma = singular_values_of_any(elements, positions)
    columns = {f"sigma_{i + 1}": sigma[:, i] for i in range(elements.dimension)}
    columns["det"] = determinants_of_any(elements, positions)
    columns["inverted"] = np.where(columns["det"] > 0, 0.0, 1.0)
    columns |= _values_of(SingularValues(sigma), others)
    # the distortion (31) has the name `volume`
    return columns | {"area" if elements.dimension == 2 else "source_volume": elements.rest_measures}


def measure_map(mesh: Mesh, positions: Floats, others: Iterable[Measure] = ()) -> dict[str, Any]:
    """Every measure of a map, as DESIGN's `measure --json` gives it.

    Parameters
    ----------
    mesh : Mesh                    the source
    positions : (n, d) float64     the map; of triangles also into space, where nothing is upright or inverted
    others : Measure ...           measured beside every registered distortion

    Returns
    -------
    dict     measures {id: {mean, max, min, p50, p95, area_weighted_mean}} of every registered distortion and of (78),
             inverted, degenerate, min_det, injective {local, global, reason}, histogram78 {edges, counts}

    Raises `WorkbenchError` for one of `others` that is no measure in this dimension.
    """
    elements = build_elements(mesh)
    positions = np.ascontiguousarray(positions, dtype=np.float64)
    sigma = singular_values_of_any(elements, positions)
    det = determinants_of_any(elements, positions)
    values = _values_of(SingularValues(sigma), others)
    measures = {id: statistics(of_each, elements.rest_measures) for id, of_each in values.items()}
    edges, counts = average_histogram(np.abs(sigma).mean(axis=1))
    into_space = is_into_space(elements, positions)
    return {
        "measures": measures,
        "inverted": 0 if into_space else int(np.count_nonzero(~(det > 0))),
        "degenerate": int(np.count_nonzero(np.abs(sigma[:, -1]) <= DEGENERATE * np.abs(sigma[:, 0]))),
        "min_det": float(det.min()),
        "injective": dict(NO_SIDES) if into_space else _verdicts(mesh, positions),
        "histogram78": {"edges": edges.tolist(), "counts": counts.tolist()},
    }


def _verdicts(mesh: Mesh, positions: Floats) -> dict[str, Any]:
    from workbench.core.injectivity import global_injectivity, local_injectivity

    local, whole = local_injectivity(mesh, positions), global_injectivity(mesh, positions)
    return {"local": local.holds, "global": whole.holds, "reason": whole.reason if local.holds else local.reason}


def statistics(values: Floats, weights: Floats) -> dict[str, float]:
    """Mean, extremes, percentiles and area-weighted mean of values (m,), of weights (m,); infinities stay infinite."""
    with np.errstate(invalid="ignore"):
        return {
            "mean": float(values.mean()),
            "max": float(values.max()),
            "min": float(values.min()),
            "p50": float(np.percentile(values, 50, method="lower")),
            "p95": float(np.percentile(values, 95, method="lower")),
            "area_weighted_mean": float(weights @ values / weights.sum()),
        }
