"""As-rigid-as-possible."""

from workbench.api import Distortion

distortion = Distortion(
    id="arap",
    label="As-rigid-as-possible",
    short="ARAP",
    formula="sum((sigma - 1)^2)",
    citation="(33); Sorkine & Alexa 2007 [SA07]",
    description="Isometric, 0 at an isometry; no barrier against inversions of its own.",
)
