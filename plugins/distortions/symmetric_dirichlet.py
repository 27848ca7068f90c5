"""Symmetric Dirichlet."""

from workbench.api import Distortion

distortion = Distortion(
    id="symmetric-dirichlet",
    label="Symmetric Dirichlet",
    short="SD",
    formula="sum(sigma^2 + 1/sigma^2)",
    citation="(32); Smith & Schaefer 2015 [SS15]",
    description="Isometric: 2n at an isometry, infinite at a collapse and at an infinite stretch.",
)
