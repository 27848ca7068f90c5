"""Bottom barrier (23) and top barrier (24): D -> inf as a simplex collapses, and as it stretches without bound."""

from __future__ import annotations

import numpy as np

from workbench.core.analysis.density import Density
from workbench.core.analysis.growth import tends_to_infinity
from workbench.core.analysis.limits import Paths, Side, bottom_paths, bounded_valley, grows, top_paths, values_along
from workbench.core.analysis.properties import Method, Property, point_text
from workbench.core.arrays import Floats

WORDS: dict[Side, str] = {"bottom": "sigma_n -> 0", "top": "sigma_1 -> inf"}


def bottom_barrier(density: Density) -> Property:
    """Whether D -> inf as sigma_n -> 0 while sigma_1 stays above a bound (it may grow)."""
    return _barrier(density, bottom_paths(density.dimension), "bottom")


def top_barrier(density: Density) -> Property:
    """Whether D -> inf as sigma_1 -> inf while sigma_n stays below a bound (it may vanish)."""
    return _barrier(density, top_paths(density.dimension), "top")


def _barrier(density: Density, paths: Paths, which: Side) -> Property:
    told = np.array([np.nan if verdict is None else float(verdict) for verdict in tends_to_infinity(density, paths.distinct())])
    verdict = grows(values_along(density, paths))
    # Leading terms know better than numbers, which see no more than a part of the way.
    verdict[: len(told)] = np.where(np.isnan(told), verdict[: len(told)], told)
    failing = np.flatnonzero(verdict == 0.0)
    if len(failing):
        k = int(failing[0])
        return _violation(density, paths.exponents[k], paths.factors[k], k < len(told) and not np.isnan(told[k]))
    valley = bounded_valley(density, paths, which)
    if valley is not None:
        return _bounded(density, valley, f"a sequence that ends at {point_text(valley[-1])}", "numeric")
    known = int((verdict == 1.0).sum())
    if known < len(verdict) / 2:
        return Property(None, "", f"The numbers give up on most paths with {WORDS[which]}.")
    sentence = f"D grows without bound as {WORDS[which]}, along {known} families of paths and in the deepest valley found."
    return Property(True, "numeric" if np.isnan(told).any() else "both", sentence)


def _violation(density: Density, exponents: Floats, factors: Floats, told: bool) -> Property:
    """A sequence of points on a path along which D stays bounded."""
    depths = np.log(10.0) * np.array([0.0, 1.0, 2.0, 4.0, 6.0, 8.0, 10.0])
    points = factors * np.exp(depths[:, None] * exponents)
    return _bounded(density, points, path_text(exponents, factors), "both" if told else "numeric")


def _bounded(density: Density, points: Floats, where: str, method: Method) -> Property:
    values = density(points)
    witness = {"sigma": points.tolist(), "values": [float(v) for v in values]}
    highest = np.nanmax(values) if not np.isnan(values).all() else np.nan
    return Property(False, method, f"D stays at most {highest:.6g} along {where}.", witness)


def path_text(exponents: Floats, factors: Floats) -> str:
    """sigma = (t, 1/t), as people write it."""
    terms = []
    for exponent, factor in zip(exponents, factors, strict=True):
        power = {0.0: "", 1.0: "t", -1.0: "1/t"}.get(float(exponent), f"t^{exponent:.6g}")
        if factor == 1.0:
            terms.append(power or "1")
        else:
            terms.append(f"{factor:.6g}" + (f" {power}" if power else ""))
    return f"sigma = ({', '.join(terms)}), t -> inf"
