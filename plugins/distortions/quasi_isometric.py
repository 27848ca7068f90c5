"""Quasi-isometric dilatation."""

from workbench.api import Distortion

distortion = Distortion(
    id="quasi-isometric",
    label="Quasi-isometric dilatation",
    short="QI",
    formula="max(max(sigma), 1/min(sigma))",
    citation="(37)",
    description="Isometric: 1 at an isometry, else the largest stretch or shrinkage.",
)
