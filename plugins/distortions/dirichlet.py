"""Dirichlet energy."""

from workbench.api import Distortion

distortion = Distortion(
    id="dirichlet",
    label="Dirichlet energy",
    short="D",
    formula="sum(sigma^2)",
    citation="(25); Pinkall & Polthier 1993 [PP93]",
    description="Squared stretch. Convex; its minimum is 0, so a map without anchors shrinks to a point.",
)
