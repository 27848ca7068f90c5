"""Quasi-conformal dilatation."""

from workbench.api import Distortion

distortion = Distortion(
    id="qc-dilatation",
    label="Quasi-conformal dilatation",
    short="K",
    formula="max(prod(sigma)/min(sigma)^n, max(sigma)^n/prod(sigma))",
    citation="(30); Väisälä 1971 [V71]",
    description="Conformal: the larger one of the inner and the outer dilatation; 1 at every similarity.",
)
