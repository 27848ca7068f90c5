"""Convexity in the target coordinates (Theorem 8.3): D(|q| sorted) must be convex in q."""

from __future__ import annotations

from workbench.core.analysis.chords import violating_chord
from workbench.core.analysis.density import Density
from workbench.core.analysis.properties import Property, point_text


def convexity(density: Density) -> Property:
    """Whether the energy is convex in x; a chord of matrices that lies below D is the witness where it is not."""
    chord, tried = violating_chord(density)
    if chord is not None:
        start, middle, end = chord.points
        sentence = (
            f"D at diag{point_text(middle)} is {chord.values[1]:.6g}, above the chord from diag{point_text(start)} to "
            f"diag{point_text(end)}, which is {chord.height:.6g} there."
        )
        return Property(False, "numeric", sentence, chord.witness())
    return Property(None, "numeric", f"No counterexample among {tried} chords, and no proof by the rules.")
