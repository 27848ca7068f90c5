"""Parameterizations where programs that draw textures look for them."""

from __future__ import annotations

from workbench.core.arrays import Floats


def into_unit_square(positions: Floats) -> Floats:
    """A map (n, 2), shifted and scaled alike in u and v until its longer side goes from 0 to 1 and the other starts at 0.

    Lengths keep their ratios, so that every measure of shape stays. A map without any size stays at 0.
    """
    shifted = positions - positions.min(axis=0)
    longest = float(shifted.max())
    return shifted / longest if longest > 0 else shifted
