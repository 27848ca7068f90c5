"""Exponential of a blend of symmetric Dirichlet and condition number."""

from workbench.api import Distortion, Parameter

distortion = Distortion(
    id="exp-blend",
    label="Exponential of a blend",
    short="exp blend",
    formula="exp(lam*symmetric_dirichlet + (1 - lam)*condition_number)",
    parameters=(Parameter("lam", float, 1e-3, "weight of symmetric Dirichlet", minimum=0.0, maximum=1.0),),
    barrier=True,
    citation="exp of (38)",
    description="A stronger barrier than the blend: the worst simplices weigh most.",
)
