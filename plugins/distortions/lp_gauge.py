"""Lp gauge of the singular values."""

from workbench.api import Distortion, Parameter

distortion = Distortion(
    id="lp-gauge",
    label="Lp gauge of the singular values",
    short="Lp",
    formula="sum(sigma^p)^(1/p)",
    parameters=(Parameter("p", float, 2.0, "exponent: 2 is the Frobenius norm", minimum=1.0, maximum=50.0),),
    citation="(84)",
    description="A Schatten norm of the Jacobian: convex in the map, so a local minimum is the global one; it shrinks the map.",
)
