"""Ky Fan norm."""

from workbench.api import Distortion, Parameter

distortion = Distortion(
    id="ky-fan",
    label="Ky Fan norm",
    short="KF",
    formula="sum(largest(k))",
    parameters=(Parameter("k", int, 2, "how many of the largest singular values count", minimum=1, maximum=3),),
    citation="(84)",
    description="Sum of the k largest singular values. Convex in the map; smooth where the last that counts is simple.",
)
