"""Symmetric as-rigid-as-possible."""

from workbench.api import Distortion

distortion = Distortion(
    id="symmetric-arap",
    label="Symmetric as-rigid-as-possible",
    short="SARAP",
    formula="(max(sigma) - 1)^2 + (1/min(sigma) - 1)^2",
    citation="(35); Shtengel et al. 2017 [SPSH*17]",
    description="Isometric, 0 at an isometry; looks at the largest stretch and the largest shrinkage only.",
)
