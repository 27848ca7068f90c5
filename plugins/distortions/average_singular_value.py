"""Average singular value."""

from workbench.api import Distortion

distortion = Distortion(
    id="average-singular-value",
    label="Average singular value",
    short="avg",
    formula="sum(sigma)/n",
    citation="(78); Ben-Chen & Gotsman 2008 [BCG08]",
    description="A descriptor: the approximate conformal factor of a simplex. Convex, so its minimisation shrinks the map.",
)
