"""Convexity in the target coordinates (Theorem 8.3): D(|q| sorted) must be convex in q."""

from __future__ import annotations

import numpy as np

from workbench.core.analysis.chords import Chord, violating_chord
from workbench.core.analysis.density import Density
from workbench.core.analysis.properties import Property, point_text
from workbench.core.analysis.rules import is_proved_convex


def convexity(density: Density, barrier: bool = False) -> Property:
    """Whether the energy is convex in x; a chord of matrices that lies below D is the witness where it is not.

    Parameters
    ----------
    barrier : bool     D counts as +inf on det <= 0
    """
    chord, tried = violating_chord(density)
    if chord is not None:
        start, middle, end = chord.points
        sentence = (
            f"D at diag{point_text(middle)} is {chord.values[1]:.6g}, above the chord from diag{point_text(start)} to "
            f"diag{point_text(end)}, which is {chord.height:.6g} there."
        )
        return Property(False, "numeric", sentence, chord.witness())
    if barrier:
        return _through_the_collapse(density)
    if is_proved_convex(density):
        return Property(True, "both", f"Convex in x: proved by rules, and no counterexample among {tried} chords.")
    return Property(None, "numeric", f"No counterexample among {tried} chords, and no proof by the rules.")


def _through_the_collapse(density: Density) -> Property:
    """A jump to +inf at det = 0 is never convex: half a turn goes through it."""
    n = density.dimension
    start, end = np.ones(n), np.r_[-1.0, -1.0, np.ones(n - 2)]
    middle = 0.5 * (start + end)
    chord = Chord(np.array([start, middle, end]), 0.5, np.r_[density(start[None]), np.inf, density(start[None])])
    sentence = f"D is infinite at diag{point_text(middle)}, halfway between diag{point_text(start)} and diag{point_text(end)}."
    return Property(False, "symbolic", sentence, chord.witness())
