"""Advanced most isometric parameterization (smooth)."""

from workbench.api import Distortion, Parameter

distortion = Distortion(
    id="amips-smooth",
    label="Advanced most isometric parameterization (smooth)",
    short="AMIPS-s",
    formula="exp(alpha*(sum(sigma^2)/prod(sigma)^(2/n) + (prod(sigma) + 1/prod(sigma))/2))",
    parameters=(Parameter("alpha", float, 1.0, "factor in the exponent; less than 1 is gentler", minimum=1e-3, maximum=100.0),),
    citation="(36) with the mean instead of the maximum; Fu, Liu, Guo 2015 [FLG15]",
    description="Isometric, weighs the worst simplices most; while it overflows, solvers lessen its logarithm.",
)
