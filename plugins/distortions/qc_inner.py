"""Inner quasi-conformal dilatation."""

from workbench.api import Distortion

distortion = Distortion(
    id="qc-inner",
    label="Inner quasi-conformal dilatation",
    short="K_I",
    formula="prod(sigma)/min(sigma)^n",
    citation="(30); Väisälä 1971 [V71]",
    description="Conformal: 1 at every similarity. The condition number in the plane; not symmetric in space.",
)
