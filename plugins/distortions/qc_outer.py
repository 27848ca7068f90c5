"""Outer quasi-conformal dilatation."""

from workbench.api import Distortion

distortion = Distortion(
    id="qc-outer",
    label="Outer quasi-conformal dilatation",
    short="K_O",
    formula="max(sigma)^n/prod(sigma)",
    citation="(30); Väisälä 1971 [V71]",
    description="Conformal: 1 at every similarity. The condition number in the plane; not symmetric in space.",
)
