"""Most isometric parameterization (conformal)."""

from workbench.api import Distortion

distortion = Distortion(
    id="mips",
    label="Most isometric parameterization (conformal)",
    short="MIPS",
    formula="sum(sigma^2)/prod(sigma)^(2/n)",
    citation="(26)-(28); Hormann & Greiner 2000 [HG00]",
    description="Conformal: n at every similarity, whatever its scale.",
)
