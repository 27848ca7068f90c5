"""Advanced most isometric parameterization."""

from workbench.api import Distortion, Parameter

distortion = Distortion(
    id="amips",
    label="Advanced most isometric parameterization",
    short="AMIPS",
    formula="exp(alpha*(sum(sigma^2)/prod(sigma)^(2/n) + max(prod(sigma), 1/prod(sigma))/2))",
    parameters=(Parameter("alpha", float, 1.0, "factor in the exponent; less than 1 is gentler", minimum=1e-3, maximum=100.0),),
    citation="(36); Fu, Liu, Guo 2015 [FLG15]",
    description="Isometric, weighs the worst simplices most; while it overflows, solvers lessen its logarithm.",
)
