"""Spectral norm."""

from workbench.api import Distortion

distortion = Distortion(
    id="spectral",
    label="Spectral norm",
    short="spec",
    formula="max(sigma)",
    citation="(84)",
    description="The largest stretch. Convex in the map; smooth only where it is simple.",
)
