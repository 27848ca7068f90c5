"""Volume distortion."""

from workbench.api import Distortion

distortion = Distortion(
    id="volume",
    label="Volume distortion",
    short="vol",
    formula="max(prod(sigma), 1/prod(sigma))",
    citation="(31)",
    description="1 where areas or volumes are kept. No barrier along shears and needles: not to be minimised alone.",
)
