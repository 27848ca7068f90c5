"""Blend of symmetric Dirichlet and condition number."""

from workbench.api import Distortion, Parameter

distortion = Distortion(
    id="blend",
    label="Blend of symmetric Dirichlet and condition number",
    short="blend",
    formula="lam*symmetric_dirichlet + (1 - lam)*condition_number",
    parameters=(Parameter("lam", float, 1e-3, "weight of symmetric Dirichlet", minimum=0.0, maximum=1.0),),
    barrier=True,
    citation="(38), Fig. 4",
    description="Nearly conformal for a small weight, and yet it keeps sizes; edit the formula to blend others.",
)
