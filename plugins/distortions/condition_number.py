"""Condition number."""

from workbench.api import Distortion

distortion = Distortion(
    id="condition-number",
    label="Condition number",
    short="cond",
    formula="max(sigma)/min(sigma)",
    citation="(29); Freitag & Knupp 2002 [FK02]",
    description="Conformal: 1 at every similarity; smooth only where the extreme singular values are simple.",
)
