"""Symmetric Dirichlet with a filtered barrier."""

from workbench.api import Distortion

distortion = Distortion(
    id="symmetric-dirichlet-filtered",
    label="Symmetric Dirichlet, filtered barrier",
    short="SD-f",
    formula="sum(sigma^2 + 1/sigma^2)",
    formula_on_inverted="sum(sigma^2)",
    citation="(32), Fig. 12; Naitsat, Naitzat, Zeevi 2020 [NZZ20]",
    description="Symmetric Dirichlet without its barrier on the simplices that are inverted at the start, which may unfold.",
)
