"""All properties of a distortion in one dimension."""

from __future__ import annotations

import numpy as np

from workbench.core.analysis.barriers import bottom_barrier, top_barrier
from workbench.core.analysis.convexity import convexity
from workbench.core.analysis.density import Density
from workbench.core.analysis.normalisation import normalisation
from workbench.core.analysis.properties import Analysis, Property
from workbench.core.analysis.smoothness import smoothness
from workbench.core.analysis.symmetry import symmetry
from workbench.core.distortion import Distortion


def analyse(distortion: Distortion, dimension: int) -> Analysis:
    """Properties of Corollary 2.1 and Theorem 8.3, deterministic.

    Parameters
    ----------
    distortion : Distortion     with its parameter values
    dimension : int             n, 2 or 3

    Raises `FormulaError` where the formula means nothing in this dimension.
    """
    density = Density.of(distortion, dimension)
    with np.errstate(all="ignore"):  # what runs over or is undefined is part of the answer
        parts = {
            "normalised": normalisation(density),
            "symmetric": symmetry(density),
            "bottom_barrier": bottom_barrier(density),
            "top_barrier": top_barrier(density),
            "smooth_almost_everywhere": smoothness(density, distortion.compiled(dimension).is_kinked_at_ties),
        }
        convex = convexity(density, distortion.has_barrier(dimension))
    return Analysis(
        formula=distortion.formula,
        dimension=dimension,
        **parts,
        regular=_regular(parts),
        convex=convex,
    )


LACKS = {
    "normalised": "not normalised",
    "symmetric": "not symmetric",
    "bottom_barrier": "no bottom barrier",
    "top_barrier": "no top barrier",
    "smooth_almost_everywhere": "not smooth almost everywhere",
}
"""What a distortion that is not regular lacks, in words."""


def _regular(parts: dict[str, Property]) -> Property:
    """The conjunction, with D >= 0 as the corollary presupposes."""
    failing = [words for name, words in LACKS.items() if parts[name].holds is False]
    least = parts["normalised"].value
    if parts["normalised"].holds and least is not None and least < 0.0:
        failing.append(f"its minimum {least:.6g} is negative")
    if failing:
        return Property(False, "", f"Not regular: {', '.join(failing)}.", {"lacks": failing})
    if all(part.holds for part in parts.values()):
        return Property(True, "", "All five properties of Corollary 2.1 hold.")
    undecided = [name.replace("_", " ") for name, part in parts.items() if part.holds is None]
    return Property(None, "", f"Not decided, as it is open whether the distortion is or has: {', '.join(undecided)}.")
