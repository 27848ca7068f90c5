"""As-rigid-as-possible with a barrier."""

from workbench.api import Distortion

distortion = Distortion(
    id="arap-barrier",
    label="As-rigid-as-possible with a barrier",
    short="ARAP+B",
    formula="sum((sigma - 1)^2)",
    barrier=True,
    citation="(33) with (34); Sorkine & Alexa 2007 [SA07]",
    description="Isometric, 0 at an isometry, infinite at det <= 0: a jump, from which the step bound keeps off.",
)
