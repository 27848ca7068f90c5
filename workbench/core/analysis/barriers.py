"""Bottom barrier (23) and top barrier (24): D -> inf as a simplex collapses, and as it stretches without bound."""

from __future__ import annotations

import numpy as np

from workbench.core.analysis.density import Density
from workbench.core.analysis.limits import Paths, bottom_paths, grows, top_paths, values_along
from workbench.core.analysis.properties import Property

WORDS = {"bottom": "sigma_n -> 0", "top": "sigma_1 -> inf"}


def bottom_barrier(density: Density) -> Property:
    """Whether D -> inf as sigma_n -> 0 while sigma_1 stays above a bound (it may grow)."""
    return _barrier(density, bottom_paths(density.dimension), "bottom")


def top_barrier(density: Density) -> Property:
    """Whether D -> inf as sigma_1 -> inf while sigma_n stays below a bound (it may vanish)."""
    return _barrier(density, top_paths(density.dimension), "top")


def _barrier(density: Density, paths: Paths, which: str) -> Property:
    values = values_along(density, paths)
    verdict = grows(values)
    failing = np.flatnonzero(verdict == 0.0)
    if len(failing):
        return _violation(density, paths, int(failing[0]), which)
    told = int((verdict == 1.0).sum())
    if told < len(verdict) / 2:
        return Property(None, "", f"The numbers give up on most paths with {WORDS[which]}.")
    return Property(True, "numeric", f"D grows without bound as {WORDS[which]}, along {told} families of paths.")


def _violation(density: Density, paths: Paths, k: int, which: str) -> Property:
    """A sequence of points on path `k` along which D stays bounded."""
    depths = np.log(10.0) * np.array([0.0, 1.0, 2.0, 4.0, 6.0, 8.0, 10.0])
    points = np.array([paths.points(depth)[k] for depth in depths])
    values = density(points)
    sentence = f"D stays at most {np.nanmax(values):.6g} along {path_text(paths.exponents[k], paths.factors[k])}."
    witness = {
        "exponents": paths.exponents[k].tolist(),
        "factors": paths.factors[k].tolist(),
        "sigma": points.tolist(),
        "values": [float(v) for v in values],
    }
    return Property(False, "numeric", sentence, witness)


def path_text(exponents: np.ndarray, factors: np.ndarray) -> str:
    """sigma = (t, 1/t), as people write it."""
    terms = []
    for exponent, factor in zip(exponents, factors, strict=True):
        power = {0.0: "", 1.0: "t", -1.0: "1/t"}.get(float(exponent), f"t^{exponent:.6g}")
        if factor == 1.0:
            terms.append(power or "1")
        else:
            terms.append(f"{factor:.6g}" + (f" {power}" if power else ""))
    return f"sigma = ({', '.join(terms)}), t -> inf"
